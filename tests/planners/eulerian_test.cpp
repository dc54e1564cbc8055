#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "planning.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/slice.hpp"

namespace routebench {
namespace {

using test::context_for;
using test::kSpacing;
using test::kWidth;
using test::layer_of;
using test::length_mm;
using test::word;

Route plan(const Polygons& polygons, double density, const ParamSet& params = {}, int index = 0) {
  return test::plan("eulerian", layer_of(polygons, index), context_for(2, density), params);
}

bool is_closed(const Stroke& stroke) { return stroke.points.front() == stroke.points.back(); }

Polygons box(double x, double y) { return {{test::rectangle(0, 0, x, y), {}}}; }

/// What two walls leave of an outline.
Polygons inside_of(Polygons outline) {
  for (int wall = 0; wall < 2; ++wall) outline = offset(outline, -kSpacing);
  return outline;
}

double outside_mm(const Polygons& polygons, const Route& route) {
  const EdgeGrid edges(polygons);
  double sum = 0;
  for (const Stroke& stroke : route.strokes)
    for (std::size_t i = 1; i < stroke.points.size(); ++i)
      sum += edges.outside_length_mm(stroke.points[i - 1], stroke.points[i]);
  return sum;
}

TEST(Eulerian, AnyDenseBoxIsOneClosedStroke) {
  for (int layer = 0; layer < 2; ++layer)
    for (double x = 1.6; x < 21; x += 0.37)
      for (const double y : {1.8, 3.3, 18.25}) {
        const Route route = plan(box(x, y), 1, {}, layer);
        ASSERT_EQ(route.strokes.size(), 1U) << x << " x " << y;
        EXPECT_TRUE(is_closed(route.strokes[0])) << x << " x " << y;
      }
}

TEST(Eulerian, EveryLayerOfA20MmBoxIsOneClosedStroke) {
  for (const double density : {0.1, 0.2, 0.5, 1.0})
    for (int layer = 0; layer < 2; ++layer) {
      const Route route = plan(inside_of(box(20, 20)), density, {}, layer);
      ASSERT_EQ(route.strokes.size(), 1U) << density;
      EXPECT_TRUE(is_closed(route.strokes[0]));
    }
}

TEST(Eulerian, EveryLayerOfAHotEndBlockIsOneClosedStrokeForEachPart) {
  SliceOptions options;
  options.layer_height_mm = 0.5;
  for (const Layer& layer : slice_mesh(load_model("shape:hotend").mesh, options, "hotend").layers) {
    const Polygons region = inside_of(layer.polygons);
    const Polygons parts = offset(region, -kWidth / 2);
    ASSERT_FALSE(parts.empty());
    const Route route = plan(region, 1, {{"thin", word("drop")}}, layer.index);
    EXPECT_EQ(route.strokes.size(), parts.size()) << layer.z_mm;
    EXPECT_TRUE(std::all_of(route.strokes.begin(), route.strokes.end(), is_closed)) << layer.z_mm;
  }
}

TEST(Eulerian, StraightRowsTurnLittleAndChangeDirectionByLayer) {
  // Two points a row and four where it passes to the next: less than half of the nodes.
  const Polygons square = box(18, 18);
  for (int layer = 0; layer < 2; ++layer) {
    const Route route = plan(square, 1, {}, layer);
    ASSERT_EQ(route.strokes.size(), 1U);
    double level_mm = 0;
    const std::vector<Point2>& points = route.strokes[0].points;
    for (std::size_t i = 1; i < points.size(); ++i)
      if (points[i - 1].y == points[i].y) level_mm += distance(points[i - 1], points[i]);
    EXPECT_GT(layer == 0 ? level_mm : length_mm(route) - level_mm, 0.9 * length_mm(route));
    EXPECT_LE(points.size(), 2 * 18 / kSpacing + 10);
  }
}

/// Walls and dense fill as a contender lays them.
Route dense_layer(const Polygons& outline) {
  Route route = test::plan("greedy_shell", layer_of(outline), context_for(2, 1));
  const Route inner = plan(inside_of(outline), 1);
  route.strokes.insert(route.strokes.end(), inner.strokes.begin(), inner.strokes.end());
  return route;
}

TEST(Eulerian, DenseLayersAreCoveredOnce) {
  std::vector<Polygons> outlines{
      test::blob(),
      box(10, 10),
      {{{{0, 0}, {20, 0}, {0, 13}}, {}}},
      {{test::circle({10, 10}, 10, 64), {test::reversed(test::circle({10, 10}, 6, 64))}}}};
  for (const Polygons& outline : outlines) {
    const Route route = dense_layer(outline);
    EXPECT_GE(test::share_under_beads(inside_of(outline), route), 0.96);
    EXPECT_NEAR(length_mm(route) * kSpacing / area_mm2(outline), 1, 0.07);
  }
}

TEST(Eulerian, SparseRegionsGetTheMaterialThatTheyDemand) {
  for (const double density : {0.15, 0.3, 0.6})
    for (const char* graph : {"tree", "grid"}) {
      const Route route = plan(test::blob(), density, {{"graph", word(graph)}});
      const double laid = length_mm(route) * kSpacing / density / area_mm2(test::blob());
      EXPECT_NEAR(laid, 1, 0.12) << graph << " " << density;
    }
}

TEST(Eulerian, SparseLinesMeetFromLayerToLayer) {
  constexpr double kDistance = kSpacing / 0.25;
  // Corners inside, away from the walls, lie at multiples of the line distance.
  const Polygons region = test::blob();
  const EdgeGrid edges(region);
  for (int layer = 0; layer < 2; ++layer)
    for (const Stroke& stroke : plan(region, 0.25, {}, layer).strokes)
      for (const Point2 p : stroke.points) {
        if (edges.distance_to_edge_mm(p, kDistance)) continue;
        EXPECT_NEAR(std::remainder(p.x, kDistance), 0, 1e-5);
        EXPECT_NEAR(std::remainder(p.y, kDistance), 0, 1e-5);
      }
}

TEST(Eulerian, WhatIsTooSmallForALoopGetsALine) {
  // 0.1 mm wide where the nozzle may go.
  const Route line = plan(box(12, kWidth + 0.1), 1);
  ASSERT_EQ(line.strokes.size(), 1U);
  EXPECT_NEAR(length_mm(line), 12 - kSpacing, 0.3);
  const Route dot = plan(box(kWidth + 0.1, kWidth + 0.1), 1);
  ASSERT_EQ(dot.strokes.size(), 1U);
  EXPECT_NEAR(length_mm(dot), 4 * 0.1, 0.03);
  EXPECT_TRUE(plan(box(0.4, 0.4), 1, {{"thin", word("drop")}}).strokes.empty());
  const Route thin = plan(box(12, 0.4), 1);
  ASSERT_EQ(thin.strokes.size(), 1U);
  EXPECT_NEAR(thin.strokes[0].width_mm, 0.4, 0.02);
}

TEST(Eulerian, NeighboursAtADiagonalMakeALineToo) {
  const double w = (kWidth + 0.1) * std::sqrt(2);
  const Polygons slanted{
      {{snap(Point2{0, 0}), snap(Point2{w, 0}), snap(Point2{10 + w, 10}), snap(Point2{10, 10})},
       {}}};
  // Its sharp corners are parts too thin for a loop.
  const Route route = plan(slanted, 1, {{"thin", word("drop")}});
  EXPECT_EQ(route.strokes.size(), 1U);
  EXPECT_GT(length_mm(route), 0.85 * 10 * std::sqrt(2));
}

TEST(Eulerian, EveryKindOfGraphStaysInsideUnlessItExtrudesItsJumps) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Polygons region = test::random_polygons(seed);
    const Polygons reach = offset(region, -kWidth / 2 + 0.011);
    for (const char* graph : {"tree", "mixed", "grid"})
      for (const char* cells : {"uniform", "quadtree"})
        for (const char* jump : {"travel", "reroute"})
          for (const double density : {1.0, 0.3}) {
            const Route route = plan(region, density,
                                     {{"graph", word(graph)},
                                      {"cells", word(cells)},
                                      {"jump", word(jump)},
                                      {"thin", word("drop")},
                                      {"max_jump", 1000.0}});
            EXPECT_FALSE(route.strokes.empty());
            EXPECT_LE(outside_mm(reach, route), 0.011);
          }
  }
}

TEST(Eulerian, JumpsThatAreReroutedCloseTheStroke) {
  const ParamSet params{{"graph", word("grid")}, {"jump", word("reroute")}, {"max_jump", 1000.0}};
  const Route route = plan(box(20, 20), 0.2, params);
  ASSERT_EQ(route.strokes.size(), 1U);
  EXPECT_TRUE(is_closed(route.strokes[0]));
  const Route travelled = plan(box(20, 20), 0.2, {{"graph", word("grid")}});
  EXPECT_GT(travelled.strokes.size(), 3U);
  EXPECT_LT(length_mm(travelled), length_mm(route));
}

TEST(Eulerian, MixedIsTreeWhereItIsDenseAndGridWhereItIsSparse) {
  const ParamSet mixed{{"graph", word("mixed")}}, grid{{"graph", word("grid")}};
  EXPECT_EQ(plan(test::blob(), 1, mixed), plan(test::blob(), 1));
  EXPECT_EQ(plan(test::blob(), 0.3, mixed), plan(test::blob(), 0.3, grid));
}

TEST(Eulerian, PublishedStandsForTheOthersAndCrossesHollows) {
  const ParamSet published{{"variant", word("published")}};
  ParamSet others = published;
  others.insert({{"graph", word("tree")},
                 {"cells", word("uniform")},
                 {"pairing", word("matching")},
                 {"jump", word("travel")},
                 {"prefer", word("straight")}});
  const Polygons ring{
      {test::circle({10, 10}, 10, 64), {test::reversed(test::circle({10, 10}, 6, 64))}}};
  const Route route = plan(ring, 1, published);
  EXPECT_EQ(plan(ring, 1, others), route);
  EXPECT_EQ(plan(ring, 0.2, published), route) << "whatever the density";
  ASSERT_EQ(route.strokes.size(), 1U);
  EXPECT_TRUE(is_closed(route.strokes[0]));
  EXPECT_GT(outside_mm(ring, route), 1);
  // Where cells have the smallest size every line is laid a width from the next, both ways.
  const Polygons bar = box(20, 1.3);
  EXPECT_GT(length_mm(plan(bar, 1, published)) * kSpacing, 1.5 * area_mm2(bar));
}

}  // namespace
}  // namespace routebench
