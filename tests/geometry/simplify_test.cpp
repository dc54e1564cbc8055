#include "routebench/geometry/simplify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "polygons.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

std::vector<Point2> random_walk(std::uint64_t seed, int points) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> step(0, 0.01);
  std::vector<Point2> walk{{0, 0}};
  for (int i = 1; i < points; ++i) walk.push_back(walk.back() + Point2{step(random), step(random)});
  return walk;
}

/// How far points are from the nearest place of a line.
double farthest_mm(const std::vector<Point2>& points, const std::vector<Point2>& line) {
  double farthest = 0;
  for (const Point2 p : points) {
    double nearest = distance(p, line.front());
    for (std::size_t i = 1; i < line.size(); ++i)
      nearest = std::min(nearest, distance(p, nearest_on_segment(p, line[i - 1], line[i])));
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

bool is_part_of(const std::vector<Point2>& few, const std::vector<Point2>& all) {
  auto at = all.begin();
  return std::all_of(few.begin(), few.end(), [&](Point2 p) {
    at = std::find(at, all.end(), p);
    return at != all.end();
  });
}

TEST(Simplify, WhatIsLeftIsOfTheLineAndNearAllOfIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double tolerance_mm : {0.0, 0.005, 0.05}) {
      const std::vector<Point2> all = random_walk(seed, 400);
      const std::vector<Point2> few = simplified(all, tolerance_mm);
      EXPECT_EQ(few.front(), all.front());
      EXPECT_EQ(few.back(), all.back());
      EXPECT_TRUE(is_part_of(few, all));
      EXPECT_LE(farthest_mm(all, few), tolerance_mm + 1e-12);
      if (tolerance_mm > 0.01) {
        EXPECT_LT(few.size(), all.size() / 4);
      }
    }
}

TEST(Simplify, ShortAndStraightLines) {
  EXPECT_TRUE(simplified({}, 1).empty());
  const std::vector<Point2> two{{0, 0}, {1, 0}};
  EXPECT_EQ(simplified(two, 5), two);
  EXPECT_EQ(simplified({{0, 0}, {0.25, 0}, {0.5, 0}, {1, 0}}, 0), two);
  // A spike back along the line is no noise.
  const std::vector<Point2> spike{{0, 0}, {3, 0}, {1, 0}};
  EXPECT_EQ(simplified(spike, 0.1), spike);
}

using RingSimplifier = Ring (*)(Ring, double);

class SimplifyRing : public ::testing::TestWithParam<RingSimplifier> {};

INSTANTIATE_TEST_SUITE_P(Both, SimplifyRing,
                         ::testing::Values(
                             &simplified_ring, +[](Ring ring, double tolerance_mm) {
                               return straightened_ring(ring, tolerance_mm);
                             }));

TEST_P(SimplifyRing, DoesNotDependOnWhereTheRingBegins) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (const Polygon& polygon : test::random_polygons(seed)) {
      const Ring few = GetParam()(polygon.outer, 0.1);
      for (std::size_t shift = 1; shift < polygon.outer.size(); shift += 7) {
        Ring turned = polygon.outer;
        std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(shift),
                    turned.end());
        EXPECT_EQ(GetParam()(turned, 0.1), few);
      }
      EXPECT_TRUE(std::all_of(few.begin(), few.end(), [&](Point2 p) {
        return std::find(polygon.outer.begin(), polygon.outer.end(), p) != polygon.outer.end();
      }));
      Ring closed = few;
      closed.push_back(few.front());
      EXPECT_LE(farthest_mm(polygon.outer, closed), 0.1 + 1e-12);
    }
}

TEST_P(SimplifyRing, ACircleKeepsThePointsThatItsRoundnessNeeds) {
  // Chords of a circle of radius r whose middles are t inside it span an angle of
  // 2 acos(1 - t / r). Neither way takes chords shorter than half of that.
  const double radius = 5, tolerance = 0.005;
  const double most = 2 * std::numbers::pi / (2 * std::acos(1 - tolerance / radius));
  for (const int points : {500, 4000, 20000}) {
    const auto kept =
        static_cast<double>(GetParam()(test::circle({0, 0}, radius, points), tolerance).size());
    EXPECT_GE(kept, most);
    EXPECT_LE(kept, 2 * most + 2);
  }
}

TEST_P(SimplifyRing, ARingNarrowerThanTheToleranceLosesItsArea) {
  EXPECT_LT(GetParam()(test::rectangle(0, 0, 10, 0.01), 0.02).size(), 3U);
  EXPECT_LT(GetParam()({{0, 0}, {1, 0}}, 0.02).size(), 3U);
  const Ring square = test::rectangle(0, 0, 10, 10);
  const Ring kept = GetParam()(square, 0.02);
  EXPECT_TRUE(std::is_permutation(kept.begin(), kept.end(), square.begin(), square.end()));
}

/// The cut of a flat facet's diagonal lies somewhere on a straight side, but for rounding: where,
/// must not show.
TEST(Simplify, StraightenedRingsForgetWhereSidesWereCut) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (const Polygon& polygon : test::random_polygons(seed)) {
      std::mt19937_64 random(seed);
      std::uniform_real_distribution<double> step(0.2, 0.8), noise(-1e-7, 1e-7);
      Ring cut;
      for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
        const Point2 a = polygon.outer[i], b = polygon.outer[(i + 1) % polygon.outer.size()];
        cut.push_back(a);
        double share = 0;
        while ((share += step(random)) < 1)
          cut.push_back(lerp(a, b, share) + Point2{noise(random), noise(random)});
      }
      ASSERT_GT(cut.size(), polygon.outer.size());
      EXPECT_EQ(straightened_ring(cut, 1e-6), straightened_ring(polygon.outer, 1e-6));
    }
}

}  // namespace
}  // namespace routebench
