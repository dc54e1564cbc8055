#include "routebench/planning/cell_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "planning.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/planning/line_crossings.hpp"

namespace routebench {
namespace {

constexpr double kPitch = 0.4375;

/// Regions of every kind: nasty ones and random ones.
std::vector<Polygon> regions() {
  std::vector<Polygon> all;
  for (const Layer& layer : test::trial_layers())
    all.insert(all.end(), layer.polygons.begin(), layer.polygons.end());
  return all;
}

CellGrid grid_over(const Polygon& region) { return anchored_cells(bounding_box(region), kPitch); }

std::int64_t steps_between(const CellGrid& grid, std::uint32_t a, std::uint32_t b) {
  const auto apart = [](std::uint32_t i, std::uint32_t k) {
    return std::abs(static_cast<std::int64_t>(i) - static_cast<std::int64_t>(k));
  };
  return std::max(apart(grid.column(a), grid.column(b)), apart(grid.row(a), grid.row(b)));
}

/// The line's cells after its first one, by the integer error of J. Bresenham.
std::vector<std::uint32_t> bresenham(const CellGrid& grid, int x0, int y0, int x1, int y1) {
  const int dx = std::abs(x1 - x0), dy = -std::abs(y1 - y0);
  const int step_x = x0 < x1 ? 1 : -1, step_y = y0 < y1 ? 1 : -1;
  std::vector<std::uint32_t> cells;
  for (int error = dx + dy; x0 != x1 || y0 != y1;) {
    const int twice = 2 * error;
    if (twice >= dy) {
      error += dy;
      x0 += step_x;
    }
    if (twice <= dx) {
      error += dx;
      y0 += step_y;
    }
    cells.push_back(grid.cell(static_cast<std::uint32_t>(x0), static_cast<std::uint32_t>(y0)));
  }
  return cells;
}

TEST(CellGrid, TheRimIsWhatBresenhamVisits) {
  const CellGrid grid{{0, 0}, {0.5, 0.5}, 64, 64};
  std::mt19937_64 random(5);
  std::uniform_int_distribution<int> place(0, 63);
  int compared = 0;
  for (int trial = 0; trial < 400; ++trial) {
    // Where an edge runs midway between two cells either will do: such rings are left out.
    int x[3], y[3];
    bool tie = false;
    for (int i = 0; i < 3; ++i) {
      x[i] = place(random);
      y[i] = place(random);
    }
    Ring ring;
    std::vector<std::uint32_t> expected;
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3;
      const int longer = std::max(std::abs(x[k] - x[i]), std::abs(y[k] - y[i]));
      const int shorter = std::min(std::abs(x[k] - x[i]), std::abs(y[k] - y[i]));
      for (int step = 1; step < longer; ++step)
        tie = tie || 2 * (shorter * step % longer) == longer;
      tie = tie || longer == 0;
      ring.push_back({x[i] / 2.0, y[i] / 2.0});
      for (const std::uint32_t cell : bresenham(grid, x[i], y[i], x[k], y[k]))
        expected.push_back(cell);
    }
    if (tie) continue;
    ++compared;
    std::vector<std::uint32_t> found;
    for (const CellStep& step : cells_of_ring(grid, ring)) found.push_back(step.cell);
    // The ring's first cell is the last one of its last edge.
    std::rotate(expected.begin(), expected.end() - 1, expected.end());
    ASSERT_EQ(found, expected) << "trial " << trial;
  }
  EXPECT_GT(compared, 50);
}

TEST(CellGrid, EveryRingIsAClosedChainOfTouchingCells) {
  for (const Polygon& region : regions()) {
    const CellMap map = map_cells(grid_over(region), region);
    ASSERT_EQ(map.steps.size(), 1 + region.holes.size());
    for (const std::vector<CellStep>& steps : map.steps) {
      ASSERT_FALSE(steps.empty());
      for (std::size_t i = 0; i < steps.size(); ++i) {
        ASSERT_TRUE((map.flags[steps[i].cell] & kRimCell) != 0);
        const std::uint32_t next = steps[(i + 1) % steps.size()].cell;
        if (steps.size() > 1) {
          ASSERT_EQ(steps_between(map.grid, steps[i].cell, next), 1);
        }
      }
    }
  }
}

TEST(CellGrid, TheRingEntersEachCellNearIt) {
  for (const Polygon& region : regions()) {
    const CellMap map = map_cells(grid_over(region), region);
    for (const std::vector<CellStep>& steps : map.steps)
      for (const CellStep& step : steps) {
        const Point2 away = step.enter.point - map.grid.centre(step.cell);
        ASSERT_LE(std::max(std::abs(away.x), std::abs(away.y)), 1.01 * kPitch);
      }
  }
}

TEST(CellGrid, NoCrossingOfARowOrColumnIsNearerToAnotherCell) {
  for (const Polygon& region : regions()) {
    const CellMap map = map_cells(grid_over(region), region);
    const CellGrid& grid = map.grid;
    const auto rim_near = [&](double x, double y) {
      for (std::uint32_t cell = 0; cell < grid.size(); ++cell)
        if ((map.flags[cell] & kRimCell) != 0 &&
            std::abs(grid.centre(cell).x - x) <= 0.501 * kPitch &&
            std::abs(grid.centre(cell).y - y) <= 0.501 * kPitch)
          return true;
      return false;
    };
    if (grid.size() > 2000) continue;  // each is looked for in all cells
    for (const Crossing& c :
         cross_lines(map.rings, {grid.first.y, kPitch, grid.rows}, CrossingSearch::kBucket))
      ASSERT_TRUE(rim_near(c.x, grid.y(c.line))) << c.x << ", " << grid.y(c.line);
  }
}

TEST(CellGrid, InsideIsWhatContainsTheCentre) {
  for (const Polygon& region : regions()) {
    const CellMap map = map_cells(grid_over(region), region);
    const EdgeGrid edges({region});
    for (std::uint32_t cell = 0; cell < map.grid.size(); ++cell) {
      const Point2 centre = map.grid.centre(cell);
      if (edges.distance_to_edge_mm(centre, 1e-5)) continue;  // on the boundary either will do
      ASSERT_EQ((map.flags[cell] & kInsideCell) != 0, edges.contains(centre));
      ASSERT_EQ(map.is_inner(cell), edges.contains(centre) && (map.flags[cell] & kRimCell) == 0);
    }
  }
}

TEST(CellGrid, LinksStayInsideAndJoinAllInnerNeighbours) {
  for (const Polygon& region : regions()) {
    const CellMap map = map_cells(grid_over(region), region);
    const EdgeGrid edges({region});
    const auto check = [&](std::uint32_t cell, std::uint32_t next, CellFlag link) {
      const bool linked = (map.flags[cell] & link) != 0;
      if (linked) {
        ASSERT_TRUE(edges.covers(map.grid.centre(cell), map.grid.centre(next)));
      }
      ASSERT_TRUE(linked || !map.is_inner(cell) || !map.is_inner(next));
    };
    for (std::uint32_t cell = 0; cell < map.grid.size(); ++cell) {
      if (map.grid.column(cell) + 1 < map.grid.columns) check(cell, cell + 1, kEastLink);
      if (map.grid.row(cell) + 1 < map.grid.rows) check(cell, cell + map.grid.columns, kNorthLink);
    }
  }
}

TEST(CellGrid, FittedCellsEndOnTheBoxAndAreNoWiderThanALine) {
  const PlanContext context = test::context_for(0, 1);
  for (const double side : {0.3, 0.5, 0.7, 1.0, 3.3, 9.5, 57.1}) {
    const CellGrid grid = fitted_cells({{1, 2}, {1 + side, 2 + 2 * side}}, context);
    EXPECT_EQ(grid.first, (Point2{1, 2}));
    EXPECT_NEAR(grid.x(grid.columns - 1), 1 + side, 1e-9);
    EXPECT_NEAR(grid.y(grid.rows - 1), 2 + 2 * side, 1e-9);
    EXPECT_LE(std::max(grid.pitch_mm.x, grid.pitch_mm.y), test::kWidth);
  }
  const CellGrid narrow = fitted_cells({{1, 2}, {1.2, 12}}, context);
  EXPECT_EQ(narrow.columns, 1U);
  EXPECT_NEAR(narrow.first.x, 1.1, 1e-9);
}

TEST(CellGrid, RefusesTooManyCells) {
  try {
    static_cast<void>(anchored_cells({{0, 0}, {1000, 1000}}, 0.001));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
  }
}

}  // namespace
}  // namespace routebench
