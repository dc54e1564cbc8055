#include "routebench/geometry/edge_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "random_polygons.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using test::random_polygons;
using test::rectangle;

/// All edges, for slow and obvious answers.
using Edges = std::vector<std::pair<Point2, Point2>>;

Edges edges_of(const Polygons& polygons) {
  Edges edges;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
  };
  for (const Polygon& polygon : polygons) {
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
  }
  return edges;
}

bool slow_contains(const Edges& edges, Point2 p) {
  bool inside = false;
  for (const auto& [a, b] : edges)
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
      inside = !inside;
  return inside;
}

double slow_distance(const Edges& edges, Point2 p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b] : edges)
    nearest = std::min(nearest, distance(p, nearest_on_segment(p, a, b)));
  return nearest;
}

TEST(EdgeGrid, AgreesWithSlowAnswersOnRandomPolygons) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> place(-15, 45);
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Polygons polygons = random_polygons(seed);
    const Edges edges = edges_of(polygons);
    const EdgeGrid grid(polygons);
    for (int i = 0; i < 100; ++i) {
      const Point2 a{place(random), place(random)}, b{place(random), place(random)};
      const double to_edge = slow_distance(edges, a);
      if (to_edge > 1e-4) {
        EXPECT_EQ(grid.contains(a), slow_contains(edges, a));
      }
      const auto near = grid.distance_to_edge_mm(a, 5);
      EXPECT_EQ(near.has_value(), to_edge <= 5);
      if (near) {
        EXPECT_DOUBLE_EQ(*near, to_edge);
      }

      // Length outside by dense sampling; crossings by sign changes of both sides.
      constexpr int kSamples = 500;
      int outside = 0;
      for (int k = 0; k < kSamples; ++k)
        if (!slow_contains(edges, lerp(a, b, (k + 0.5) / kSamples))) ++outside;
      const double length = distance(a, b);
      EXPECT_NEAR(grid.outside_length_mm(a, b), length * outside / kSamples,
                  24 * length / kSamples);
      std::size_t proper = 0;
      for (const auto& [p, q] : edges)
        if ((cross(b - a, p - a) > 0) != (cross(b - a, q - a) > 0) &&
            (cross(q - p, a - p) > 0) != (cross(q - p, b - p) > 0))
          ++proper;
      EXPECT_EQ(grid.crossings(a, b).size(), proper);
      EXPECT_TRUE(grid.meets(a, b) || proper == 0);
      const Point2 c = lerp(a, b, 0.02);
      if (slow_distance(edges, a) > 2 * distance(a, c)) {
        EXPECT_FALSE(grid.meets(a, c));
      }
    }
  }
}

TEST(EdgeGrid, BoundaryBelongsToThePolygons) {
  const EdgeGrid grid({{rectangle(0, 0, 10, 10), {}}});
  for (const Point2 p : {Point2{0, 0}, Point2{10, 10}, Point2{5, 0}, Point2{10, 3}, Point2{0, 10}})
    EXPECT_TRUE(grid.contains(p));
  for (const Point2 p : {Point2{5, 10}, Point2{10, 3}, Point2{0, 0}}) {
    EXPECT_TRUE(grid.meets({5, 5}, p)) << "an end on the boundary";
    EXPECT_TRUE(grid.meets(p, p));
  }
  EXPECT_TRUE(grid.meets({2, 10}, {8, 10})) << "along it";
  EXPECT_FALSE(grid.meets({2, 9.999}, {8, 9.999}));
  EXPECT_FALSE(grid.contains({10.001, 3}));
  EXPECT_FALSE(grid.contains({5, -0.001}));
  EXPECT_TRUE(grid.covers({0, 0}, {10, 0}));
  EXPECT_TRUE(grid.covers({0, 0}, {10, 10}));
  EXPECT_FALSE(grid.covers({0, 0}, {11, 0}));
  EXPECT_DOUBLE_EQ(grid.outside_length_mm({0, 0}, {10, 0}), 0);
  EXPECT_NEAR(grid.outside_length_mm({-3, 5}, {14, 5}), 7, 1e-5);
}

TEST(EdgeGrid, CrossingsAreSortedSharesEachOnce) {
  const EdgeGrid grid({{rectangle(0, 0, 10, 10), {}}, {rectangle(20, 0, 30, 10), {}}});
  const auto across = grid.crossings({-10, 5}, {40, 5});
  ASSERT_EQ(across.size(), 4u);
  EXPECT_NEAR(across[0], 0.2, 1e-6);
  EXPECT_NEAR(across[3], 0.8, 1e-6);
  EXPECT_EQ(grid.crossings({-5, -5}, {15, 15}).size(), 2u) << "a corner is one place";
  EXPECT_TRUE(grid.crossings({2, 2}, {8, 8}).empty());
  EXPECT_TRUE(grid.crossings({2, 2}, {2, 2}).empty());
}

TEST(EdgeGrid, HoleIsOutside) {
  const Polygons ring =
      polygons_from_rings({rectangle(0, 0, 10, 10), rectangle(4, 4, 6, 6)}, FillRule::kEvenOdd);
  const EdgeGrid grid(ring);
  EXPECT_FALSE(grid.contains({5, 5}));
  EXPECT_TRUE(grid.contains({4, 5}));
  EXPECT_NEAR(grid.outside_length_mm({0, 5}, {10, 5}), 2, 1e-5);
  EXPECT_FALSE(grid.covers({1, 5}, {9, 5}));
}

TEST(EdgeGrid, NothingContainsNothing) {
  const EdgeGrid grid({});
  EXPECT_FALSE(grid.contains({0, 0}));
  EXPECT_TRUE(grid.crossings({0, 0}, {1, 1}).empty());
  EXPECT_DOUBLE_EQ(grid.outside_length_mm({0, 0}, {3, 4}), 5);
  EXPECT_FALSE(grid.distance_to_edge_mm({0, 0}, 10).has_value());
}

TEST(EdgeGrid, LongThinPolygonsStaySmall) {
  const EdgeGrid grid({{rectangle(0, 0, 1000, 0.001), {}}});
  EXPECT_TRUE(grid.contains({500, 0.0005}));
  EXPECT_NEAR(grid.outside_length_mm({500, -1}, {500, 1}), 1.999, 1e-4);
}

}  // namespace
}  // namespace routebench
