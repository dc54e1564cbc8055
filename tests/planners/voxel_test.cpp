#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "planning.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/planning/cell_circuits.hpp"
#include "routebench/planning/cell_strokes.hpp"

namespace routebench {
namespace {

using test::context_for;
using test::kSpacing;
using test::kWidth;
using test::layer_of;
using test::length_mm;
using test::word;

Route plan(const Layer& layer, const PlanContext& context, const ParamSet& params = {}) {
  return test::plan("voxel", layer, context, params);
}

Layer square(int index = 0) { return layer_of({{test::rectangle(0, 0, 10, 10), {}}}, index); }

/// The cells of a region's inside.
struct Cells {
  explicit Cells(const Polygon& region)
      : map(map_cells(anchored_cells(bounding_box(region), kSpacing), region)), edges({region}) {
    for (std::uint32_t cell = 0; cell < map.grid.size(); ++cell)
      inner.push_back(map.is_inner(cell));
  }
  [[nodiscard]] bool clear(std::uint32_t a, std::uint32_t b) const {
    return edges.covers(map.grid.centre(a), map.grid.centre(b));
  }

  CellMap map;
  EdgeGrid edges;
  std::vector<bool> inner;
};

std::vector<Polygon> regions() {
  std::vector<Polygon> all;
  for (const Layer& layer : test::trial_layers())
    all.insert(all.end(), layer.polygons.begin(), layer.polygons.end());
  return all;
}

TEST(Voxel, DenseSquareIsARimAndOneZigzag) {
  // Centre lines fill 9.5 mm, which is 21.7 spacings: 22 cells of 9.5 / 22 mm.
  const double cell_mm = 9.5 / 22;
  const Route route = plan(square(), context_for(0, 1));
  ASSERT_EQ(route.strokes.size(), 2U);
  const auto [rows, rim] = route.strokes[0].points.size() > 6
                               ? std::pair(route.strokes[0], route.strokes[1])
                               : std::pair(route.strokes[1], route.strokes[0]);
  EXPECT_NEAR(routebench::length_mm(rim.points), 38, 1e-9);
  EXPECT_EQ(rim.points.front(), rim.points.back());
  ASSERT_EQ(rows.points.size(), 42U);
  EXPECT_NEAR(routebench::length_mm(rows.points), 21 * (9.5 - 2 * cell_mm) + 20 * cell_mm, 1e-4);
  for (const Point2 p : rows.points) EXPECT_NEAR(std::abs(p.x - 5), 4.75 - cell_mm, 1e-5);
}

TEST(Voxel, SparseRowsAreWhereTheyMustBeAndEndAtTheWall) {
  const Route route = plan(square(), context_for(0, 0.25));
  ASSERT_EQ(route.strokes.size(), 1U);
  // Every fourth row of cells from the origin; the joints run along the wall.
  std::vector<Point2> expected;
  bool right = false;
  for (const double y : {1.75, 3.5, 5.25, 7.0, 8.75}) {
    expected.push_back({right ? 9.75 : 0.25, y});
    expected.push_back({right ? 0.25 : 9.75, y});
    right = !right;
  }
  EXPECT_EQ(route.strokes[0].points, expected);
}

TEST(Voxel, OddLayersAreTurned) {
  const PlanContext context = context_for(0, 0.25);
  Route odd = plan(square(1), context);
  for (Stroke& stroke : odd.strokes)
    for (Point2& p : stroke.points) std::swap(p.x, p.y);
  EXPECT_EQ(odd, plan(square(0), context));
  EXPECT_EQ(plan(square(1), context, {{"alternate", false}}), plan(square(0), context));
}

TEST(Voxel, EveryInnerCellLiesOnExactlyOneRow) {
  for (const Polygon& region : regions()) {
    const Cells cells(region);
    const CellGrid& grid = cells.map.grid;
    std::vector<int> laid(grid.size(), 0);
    RowRule rule;
    rule.max_link_mm = 3 * kSpacing;
    for (const auto& points : row_lines(cells.map, cells.inner, cells.edges, rule, {}))
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0) {
          ASSERT_TRUE(cells.edges.covers(points[i - 1], points[i]));
        }
        const bool level = i + 1 < points.size() && points[i].y == points[i + 1].y;
        if (!level && i > 0 && points[i - 1].y == points[i].y) continue;
        const double left = level ? std::min(points[i].x, points[i + 1].x) : points[i].x;
        const double right = level ? std::max(points[i].x, points[i + 1].x) : points[i].x;
        for (std::uint32_t cell = 0; cell < grid.size(); ++cell) {
          const Point2 centre = grid.centre(cell);
          if (centre.y == points[i].y && left <= centre.x && centre.x <= right) ++laid[cell];
        }
      }
    for (std::uint32_t cell = 0; cell < grid.size(); ++cell)
      ASSERT_EQ(laid[cell], cells.inner[cell] ? 1 : 0);
  }
}

TEST(Voxel, CircuitsVisitCellsOnceAndStayInside) {
  for (const Polygon& region : regions()) {
    const Cells cells(region);
    const CellGrid& grid = cells.map.grid;
    std::vector<bool> left = cells.inner;
    std::vector<int> visits(grid.size(), 0);
    const auto clear = [&](std::uint32_t a, std::uint32_t b) { return cells.clear(a, b); };
    for (const auto& circuit : cell_circuits(cells.map, left, clear)) {
      ASSERT_GE(circuit.size(), 4U);
      for (std::size_t i = 0; i < circuit.size(); ++i) {
        ++visits[circuit[i]];
        const Point2 here = grid.centre(circuit[i]);
        const Point2 next = grid.centre(circuit[(i + 1) % circuit.size()]);
        ASSERT_LE(std::max(std::abs(here.x - next.x), std::abs(here.y - next.y)), 1.01 * kSpacing);
        ASSERT_TRUE(cells.edges.covers(here, next));
      }
    }
    for (std::uint32_t cell = 0; cell < grid.size(); ++cell) {
      ASSERT_EQ(visits[cell] + (left[cell] ? 1 : 0), cells.inner[cell] ? 1 : 0);
      // No block is left, and nothing that a circuit could take in by a detour.
      const bool block = left[cell] && (cells.map.flags[cell] & kEastLink) != 0 &&
                         (cells.map.flags[cell] & kNorthLink) != 0 && left[cell + 1] &&
                         left[cell + grid.columns] && left[cell + grid.columns + 1];
      ASSERT_FALSE(block);
    }
  }
}

TEST(Voxel, OneCircuitFillsWhatHangsTogether) {
  const auto circuits_of = [](const Polygon& region, std::size_t& left_out) {
    const Cells cells(region);
    std::vector<bool> left = cells.inner;
    const auto clear = [&](std::uint32_t a, std::uint32_t b) { return cells.clear(a, b); };
    const auto circuits = cell_circuits(cells.map, left, clear);
    left_out = static_cast<std::size_t>(std::count(left.begin(), left.end(), true));
    return circuits.size();
  };
  std::size_t left_out = 0;
  for (int cells = 2; cells < 9; ++cells) {
    // So many cells each way lie within a rim that runs through centres.
    const double side = (cells + 1) * kSpacing;
    EXPECT_EQ(circuits_of({test::rectangle(0, 0, side, side), {}}, left_out), 1U);
    EXPECT_EQ(left_out, 0U) << cells;
  }
  EXPECT_EQ(
      circuits_of({test::circle({10, 10}, 10, 64), {test::reversed(test::circle({10, 10}, 6, 64))}},
                  left_out),
      1U);
  EXPECT_EQ(left_out, 0U);
}

TEST(Voxel, EulerLaysASquareInTwoClosedStrokes) {
  const Route route = plan(square(), context_for(0, 1), {{"inside", word("euler")}});
  ASSERT_EQ(route.strokes.size(), 2U);
  for (const Stroke& stroke : route.strokes) EXPECT_EQ(stroke.points.front(), stroke.points.back());
}

TEST(Voxel, DenseFillCoversAndLaysNoMoreThanItShould) {
  for (const char* inside : {"rows", "euler"})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const Layer layer = layer_of(test::random_polygons(seed));
      const Route route = plan(layer, context_for(0, 1), {{"inside", word(inside)}});
      EXPECT_GE(test::share_under_beads(layer.polygons, route), 0.95);
      EXPECT_NEAR(length_mm(route) * kSpacing / area_mm2(layer.polygons), 1, 0.1);
    }
}

TEST(Voxel, NarrowPlacesAreLaidOnce) {
  // Centre lines have 0.1 mm: the way back lies in the same cells.
  const Layer layer = layer_of({{test::rectangle(0, 0, 20, kWidth + 0.1), {}}});
  const Route route = plan(layer, context_for(0, 1));
  EXPECT_GT(length_mm(route), 19);
  EXPECT_LT(length_mm(route), 22);
}

TEST(Voxel, PublishedFormIsARimOfCentresThatLeavesThePolygons) {
  const ParamSet published{{"variant", word("published")}};
  const Layer layer = square();
  const PlanContext context = context_for(0, 1);
  const Route route = plan(layer, context, published);
  // 10 mm is 22.9 cells: the last one's centre lies outside.
  const EdgeGrid edges(layer.polygons);
  bool outside = false;
  for (const Stroke& stroke : route.strokes)
    for (const Point2 p : stroke.points) {
      outside = outside || !edges.contains(p);
      EXPECT_NEAR(p.x / kSpacing, std::round(p.x / kSpacing), 1e-5);
      EXPECT_NEAR(p.y / kSpacing, std::round(p.y / kSpacing), 1e-5);
    }
  EXPECT_TRUE(outside);
  EXPECT_EQ(plan(layer, context, {{"rim", word("published")}}), route);
  EXPECT_EQ(plan(layer, context, {{"variant", word("published")}, {"inside", word("euler")}}),
            route);
}

}  // namespace
}  // namespace routebench
