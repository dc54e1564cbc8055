#include "routebench/planning/inside_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "random_polygons.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

double length_mm(const std::vector<Point2>& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += distance(path[i - 1], path[i]);
  return sum;
}

/// Shortest length over all vertices that see each other, slowly; infinite if there is no way.
double shortest_length(const Polygons& polygons, Point2 a, Point2 b) {
  const EdgeGrid edges(polygons);
  std::vector<Point2> nodes{a, b};
  for (const Polygon& polygon : polygons) {
    nodes.insert(nodes.end(), polygon.outer.begin(), polygon.outer.end());
    for (const Ring& hole : polygon.holes) nodes.insert(nodes.end(), hole.begin(), hole.end());
  }
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> length(nodes.size(), kFar);
  std::vector<bool> done(nodes.size());
  length[0] = 0;
  while (true) {
    std::size_t node = nodes.size();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!done[i] && length[i] < kFar && (node == nodes.size() || length[i] < length[node]))
        node = i;
    if (node == nodes.size() || node == 1) return length[1];
    done[node] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double longer = length[node] + distance(nodes[node], nodes[i]);
      if (!done[i] && longer < length[i] && edges.covers(nodes[node], nodes[i])) length[i] = longer;
    }
  }
}

TEST(InsidePaths, StraightWhereNothingIsInTheWay) {
  const InsidePaths paths({{test::rectangle(0, 0, 10, 10), {}}});
  EXPECT_EQ(paths.shortest({1, 1}, {9, 3}), (std::vector<Point2>{{1, 1}, {9, 3}}));
  EXPECT_EQ(paths.shortest({0, 0}, {10, 0}), (std::vector<Point2>{{0, 0}, {10, 0}}));
}

TEST(InsidePaths, RoundAHoleByItsCorners) {
  Ring hole = test::rectangle(4, 2, 6, 10);
  std::reverse(hole.begin(), hole.end());
  const InsidePaths paths({{test::rectangle(0, 0, 10, 20), {hole}}});
  EXPECT_EQ(paths.shortest({1, 3}, {9, 3}), (std::vector<Point2>{{1, 3}, {4, 2}, {6, 2}, {9, 3}}));
  EXPECT_EQ(paths.shortest({1, 9}, {9, 9}),
            (std::vector<Point2>{{1, 9}, {4, 10}, {6, 10}, {9, 9}}));
}

TEST(InsidePaths, NoneBetweenPolygonsOrFromOutside) {
  const InsidePaths paths({{test::rectangle(0, 0, 4, 4), {}}, {test::rectangle(6, 0, 9, 4), {}}});
  EXPECT_FALSE(paths.shortest({1, 1}, {7, 1}).has_value());
  EXPECT_FALSE(paths.shortest({5, 1}, {7, 1}).has_value());
  EXPECT_FALSE(paths.shortest({1, 1}, {20, 1}).has_value());
  EXPECT_FALSE(InsidePaths({}).shortest({0, 0}, {1, 1}).has_value());
}

TEST(InsidePaths, AreAsShortAsTheSlowWayFindsAndStayInside) {
  int detours = 0, apart = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    // Cut out of a jagged disc, then shrunk, so that nothing touches in a single point.
    const Polygons disc = {{test::star(seed, 24, {15, 15}, 8, 16), {}}};
    const Polygons polygons = offset(subtract(disc, test::random_polygons(seed, 4)), -0.02);
    const InsidePaths paths(polygons);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> coordinate(0, 30);
    for (int i = 0; i < 60; ++i) {
      const Point2 a = snap(Point2{coordinate(random), coordinate(random)});
      const Point2 b = snap(Point2{coordinate(random), coordinate(random)});
      const auto path = paths.shortest(a, b);
      const auto room = std::find_if(polygons.begin(), polygons.end(), [&](const Polygon& p) {
        const EdgeGrid edges({p});
        return edges.contains(a) && edges.contains(b);
      });
      ASSERT_EQ(path.has_value(), room != polygons.end());
      if (!path) {
        ++apart;
        continue;
      }
      ASSERT_GE(path->size(), 2U);
      EXPECT_EQ(path->front(), a);
      EXPECT_EQ(path->back(), b);
      EXPECT_NEAR(length_mm(*path), shortest_length({*room}, a, b), 1e-5);
      EXPECT_NEAR(length_mm(*path), length_mm(paths.shortest(b, a).value()), 1e-9);
      const EdgeGrid edges({*room});
      for (std::size_t j = 1; j < path->size(); ++j)
        EXPECT_TRUE(edges.covers((*path)[j - 1], (*path)[j]));
      if (path->size() > 2) ++detours;
    }
  }
  EXPECT_GT(detours, 10);
  EXPECT_GT(apart, 10);
}

TEST(InsidePaths, ThroughAMaze) {
  // Walls with gaps at alternating ends: the way is many times as long as the straight line.
  std::vector<Ring> rings{test::rectangle(0, 0, 40, 10)};
  for (int i = 1; i < 20; ++i) {
    const double x = 2 * i, y = i % 2 == 0 ? 0 : 1;
    Ring wall = test::rectangle(x - 0.5, y, x + 0.5, y + 9);
    std::reverse(wall.begin(), wall.end());
    rings.push_back(wall);
  }
  const Polygons maze = polygons_from_rings(rings, FillRule::kPositive);
  ASSERT_EQ(maze.size(), 1U);
  const auto path = InsidePaths(maze).shortest({0.5, 5}, {39.5, 5});
  ASSERT_TRUE(path.has_value());
  EXPECT_NEAR(length_mm(*path), shortest_length(maze, {0.5, 5}, {39.5, 5}), 1e-5);
  EXPECT_GT(length_mm(*path), 140);
}

}  // namespace
}  // namespace routebench
