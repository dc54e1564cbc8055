#include "routebench/planning/nearest_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

/// The obvious answer.
std::optional<std::uint32_t> nearest_of(const std::vector<Point2>& points, const NearestGrid& grid,
                                        Point2 from) {
  std::optional<std::uint32_t> best;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!grid.has(i)) continue;
    if (!best || squared_distance(points[i], from) < squared_distance(points[*best], from))
      best = i;
  }
  return best;
}

/// Takes all points away in random order and asks from in- and outside before each.
void expect_right(const std::vector<Point2>& points, std::uint64_t seed) {
  NearestGrid grid(points);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-20, 40);
  std::vector<std::uint32_t> order(points.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  for (const std::uint32_t victim : order) {
    for (const Point2 from : {Point2{place(random), place(random)}, points[victim]})
      ASSERT_EQ(grid.nearest(from), nearest_of(points, grid, from));
    grid.remove(victim);
    grid.remove(victim);
    ASSERT_FALSE(grid.has(victim));
  }
  EXPECT_EQ(grid.size(), 0U);
  EXPECT_EQ(grid.nearest({0, 0}), std::nullopt);
}

TEST(NearestGrid, AgreesWithLookingAtAllPoints) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(0, 20);
  std::vector<Point2> points(300);
  for (Point2& p : points) p = {place(random), place(random)};
  expect_right(points, 1);
}

TEST(NearestGrid, EquallyNearPointsGoByNumber) {
  std::vector<Point2> lattice;
  for (int i = 0; i < 200; ++i)
    lattice.push_back({static_cast<double>(i % 10), static_cast<double>(i / 10 % 5)});
  expect_right(lattice, 2);
}

TEST(NearestGrid, HandlesPointsOnALineInOnePlaceAndInClusters) {
  std::vector<Point2> line, heap, clusters;
  std::mt19937_64 random(5);
  std::normal_distribution<double> near(0, 1e-3);
  for (int i = 0; i < 100; ++i) {
    line.push_back({i * 0.1, 7});
    heap.push_back({3, 3});
    clusters.push_back({(i % 3) * 15 + near(random), (i % 2) * 15 + near(random)});
  }
  expect_right(line, 1);
  expect_right(heap, 2);
  expect_right(clusters, 3);
}

TEST(NearestGrid, NothingIsNearestOfNothing) {
  EXPECT_EQ(NearestGrid({}).nearest({1, 1}), std::nullopt);
}

}  // namespace
}  // namespace routebench
