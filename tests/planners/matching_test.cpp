#include "routebench/planning/matching.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

// What rounding of the distances to the grid may cost.
double slack(const std::vector<Point2>& points) {
  return static_cast<double>(points.size()) / kGridUnitsPerMm;
}

std::vector<Point2> random_points(std::uint64_t seed, std::size_t count, double size_mm = 100) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(0, size_mm);
  std::vector<Point2> points;
  while (points.size() < count)
    points.push_back(snap(Point2{coordinate(random), coordinate(random)}));
  return points;
}

/// Points in dense heaps of odd size, far from each other: near neighbours alone cannot pair them.
std::vector<Point2> odd_clusters(std::uint64_t seed, std::size_t clusters, std::size_t size) {
  std::vector<Point2> points;
  const std::vector<Point2> centres = random_points(seed, clusters);
  for (std::size_t c = 0; c < clusters; ++c)
    for (const Point2 p : random_points(seed * 1000 + c, size, 0.5))
      points.push_back(centres[c] + p);
  return points;
}

void expect_perfect(const Matching& matching, std::size_t count) {
  ASSERT_EQ(matching.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) {
    ASSERT_LT(matching[i], count);
    EXPECT_NE(matching[i], i);
    EXPECT_EQ(matching[matching[i]], i);
  }
}

/// The shortest way to pair the points that are not in `paired`, by trying all.
double shortest(const std::vector<Point2>& points, std::uint32_t paired,
                std::vector<double>& known) {
  if (paired == (1U << points.size()) - 1) return 0;
  double& best = known[paired];
  if (best >= 0) return best;
  best = std::numeric_limits<double>::infinity();
  std::uint32_t first = 0;
  while ((paired >> first & 1U) != 0) ++first;
  for (std::uint32_t other = first + 1; other < points.size(); ++other) {
    if ((paired >> other & 1U) != 0) continue;
    best = std::min(best, distance(points[first], points[other]) +
                              shortest(points, paired | 1U << first | 1U << other, known));
  }
  return best;
}

double shortest(const std::vector<Point2>& points) {
  std::vector<double> known(std::size_t{1} << points.size(), -1);
  return shortest(points, 0, known);
}

TEST(Matching, MinimumIsWhatTryingAllPairingsFinds) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::vector<Point2> points = random_points(seed, 2 + 2 * (seed % 7));
    const Matching matching = minimum_matching(points);
    expect_perfect(matching, points.size());
    EXPECT_NEAR(length_mm(points, matching), shortest(points), slack(points));
  }
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<Point2> points = odd_clusters(seed, 4, 1 + 2 * (seed % 2));
    EXPECT_NEAR(length_mm(points, minimum_matching(points)), shortest(points), slack(points));
  }
}

TEST(Matching, MinimumLooksBeyondNearNeighbours) {
  // Each heap holds more points than neighbours are tried at first, and one of each is left over.
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const std::vector<Point2> points = odd_clusters(seed, 4, 21);
    std::vector<Point2> centres;
    for (std::size_t c = 0; c < 4; ++c) centres.push_back(points[21 * c]);
    const Matching matching = minimum_matching(points);
    expect_perfect(matching, points.size());
    // What crosses from heap to heap is the best pairing of the heaps, but for their own size.
    double crossing = 0;
    int crossings = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (i / 21 == matching[i] / 21 || matching[i] < i) continue;
      crossing += distance(points[i], points[matching[i]]);
      ++crossings;
    }
    EXPECT_EQ(crossings, 2);
    EXPECT_NEAR(crossing, shortest(centres), 2 * crossings * 0.5 * std::numbers::sqrt2);
  }
}

TEST(Matching, MinimumIsNeverLongerThanGreedyAndShorterOnAverage) {
  double greedy_sum = 0, minimum_sum = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Point2> points = random_points(seed, 20 * seed);
    const Matching greedy = greedy_matching(points);
    const Matching minimum = minimum_matching(points);
    expect_perfect(greedy, points.size());
    expect_perfect(minimum, points.size());
    const double greedy_mm = length_mm(points, greedy), minimum_mm = length_mm(points, minimum);
    EXPECT_LE(minimum_mm, greedy_mm + slack(points));
    greedy_sum += greedy_mm;
    minimum_sum += minimum_mm;
  }
  EXPECT_LT(minimum_sum, 0.85 * greedy_sum);
}

TEST(Matching, GreedyTakesTheNearestThatIsFree) {
  const std::vector<Point2> points = {{0, 0}, {3, 0}, {1, 0}, {10, 0}};
  EXPECT_EQ(greedy_matching(points), (Matching{2, 3, 0, 1}));
  // Of equally near ones the first: a plain scan over all the points says the same.
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::vector<Point2> coarse = random_points(seed, 60, 8);
    for (Point2& p : coarse) p = {std::round(p.x), std::round(p.y)};
    Matching scanned(coarse.size(), ~0U);
    for (std::uint32_t i = 0; i < coarse.size(); ++i) {
      if (scanned[i] != ~0U) continue;
      std::uint32_t nearest = ~0U;
      for (std::uint32_t j = i + 1; j < coarse.size(); ++j) {
        if (scanned[j] != ~0U) continue;
        if (nearest == ~0U ||
            squared_distance(coarse[i], coarse[j]) < squared_distance(coarse[i], coarse[nearest]))
          nearest = j;
      }
      scanned[i] = nearest;
      scanned[nearest] = i;
    }
    EXPECT_EQ(greedy_matching(coarse), scanned);
  }
}

TEST(Matching, PointsMayRepeat) {
  const std::vector<Point2> heap(14, Point2{1, 2});
  const Matching matching = minimum_matching(heap);
  expect_perfect(matching, heap.size());
  EXPECT_EQ(length_mm(heap, matching), 0);
  EXPECT_TRUE(minimum_matching({}).empty());
  EXPECT_TRUE(greedy_matching({}).empty());
}

TEST(Matching, AnOddNumberIsRefused) {
  const std::vector<Point2> three(3);
  EXPECT_THROW(static_cast<void>(minimum_matching(three)), Error);
  EXPECT_THROW(static_cast<void>(greedy_matching(three)), Error);
}

}  // namespace
}  // namespace routebench
