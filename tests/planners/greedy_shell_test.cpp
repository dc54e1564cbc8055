#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "planning.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

using test::kSpacing;
using test::kWidth;
using test::layer_of;
using test::length_mm;
using test::trial_layers;
using test::word;

PlanContext context_for(int perimeters) { return test::context_for(perimeters, 1); }

Route plan(const Layer& layer, const PlanContext& context, const ParamSet& params = {}) {
  return test::plan("greedy_shell", layer, context, params);
}

Layer square() { return layer_of({{test::rectangle(0, 0, 10, 10), {}}}); }

TEST(GreedyShell, WallsOfASquareAreWhereTheyMustBe) {
  PlanContext context = context_for(2);
  context.start = {10, 0};
  const Route route = plan(square(), context, {{"order", word("outside_in")}});
  ASSERT_EQ(route.strokes.size(), 2U);
  const std::vector<Point2> outer{
      {9.75, 0.25}, {9.75, 9.75}, {0.25, 9.75}, {0.25, 0.25}, {9.75, 0.25}};
  EXPECT_EQ(route.strokes[0].points, outer);
  const double near = 0.25 + kSpacing, far = 10 - near;
  const std::vector<Point2> inner{{far, near}, {far, far}, {near, far}, {near, near}, {far, near}};
  EXPECT_EQ(route.strokes[1].points, inner);
  EXPECT_EQ(route.strokes[0].width_mm, kWidth);
}

TEST(GreedyShell, InsideOutBeginsWithTheInnermostWall) {
  const Route route = plan(square(), context_for(3), {{"order", word("inside_out")}});
  ASSERT_EQ(route.strokes.size(), 3U);
  EXPECT_LT(length_mm({{route.strokes[0]}}), length_mm({{route.strokes[1]}}));
  EXPECT_LT(length_mm({{route.strokes[1]}}), length_mm({{route.strokes[2]}}));
}

TEST(GreedyShell, NoWallsAreLaidWhereNoneAreAskedFor) {
  EXPECT_TRUE(plan(square(), context_for(0)).strokes.empty());
}

TEST(GreedyShell, EveryWallIsClosedAndLaidOnce) {
  for (const char* chain : {"greedy", "linear"}) {
    for (const char* order : {"inside_out", "outside_in", "any"}) {
      for (const Layer& layer : trial_layers()) {
        const PlanContext context = context_for(3);
        std::size_t rings = 0;
        double perimeter = 0;
        for (const Polygon& polygon : layer.polygons)
          for (const Polygons& region : wall_regions(polygon, context)) {
            rings += rings_of(region).size();
            perimeter += perimeter_mm(region);
          }
        const Route route =
            plan(layer, context,
                 {{"chain", word(chain)}, {"order", word(order)}, {"gaps", word("leave")}});
        EXPECT_EQ(route.strokes.size(), rings);
        EXPECT_NEAR(length_mm(route), perimeter, 1e-6 * perimeter);
        for (const Stroke& stroke : route.strokes)
          EXPECT_EQ(stroke.points.front(), stroke.points.back());
      }
    }
  }
}

TEST(GreedyShell, BothSearchesGiveTheSameRoute) {
  for (const Layer& layer : trial_layers()) {
    for (const char* order : {"inside_out", "any"}) {
      for (const char* seam : {"nearest", "min_x"}) {
        ParamSet params{{"order", word(order)}, {"seam", word(seam)}, {"search", word("grid")}};
        const Route grid = plan(layer, context_for(2), params);
        params["search"] = word("naive");
        EXPECT_EQ(plan(layer, context_for(2), params), grid);
      }
    }
  }
}

TEST(GreedyShell, AlwaysGoesToTheNearestVertexThatIsLeft) {
  for (const Layer& layer : trial_layers()) {
    PlanContext context = context_for(2);
    context.start = {4, 30};
    const Route route = plan(layer, context, {{"order", word("any")}, {"gaps", word("leave")}});
    Point2 nozzle = context.start;
    for (std::size_t i = 0; i < route.strokes.size(); ++i) {
      const double gone = squared_distance(nozzle, route.strokes[i].points.front());
      for (std::size_t k = i; k < route.strokes.size(); ++k)
        for (const Point2 p : route.strokes[k].points) ASSERT_LE(gone, squared_distance(nozzle, p));
      nozzle = route.strokes[i].points.back();
    }
  }
}

TEST(GreedyShell, SeamsLieWhereTheRuleSays) {
  PlanContext context = context_for(2);
  context.origin = {1, 2};
  const auto starts = [&](const ParamSet& params) {
    std::vector<Point2> points;
    for (const Stroke& stroke : plan(square(), context, params).strokes)
      points.push_back(stroke.points.front());
    return points;
  };
  const double near = 0.25 + kSpacing, far = 10 - near;
  EXPECT_EQ(starts({{"seam", word("min_x")}}), (std::vector<Point2>{{near, near}, {0.25, 0.25}}));
  // (8, 7) as seen from the origin is (9, 9).
  EXPECT_EQ(starts({{"seam", word("fixed_point")}, {"seam_x_mm", 8.0}, {"seam_y_mm", 7.0}}),
            (std::vector<Point2>{{far, far}, {9.75, 9.75}}));
  context.start = {0, 11};
  EXPECT_EQ(starts({}), (std::vector<Point2>{{near, far}, {0.25, 9.75}}));
}

TEST(GreedyShell, LinearTakesWallsByTheirSmallestX) {
  PlanContext context = context_for(1);
  context.start = {50, 0};
  const Layer layer = layer_of({{test::rectangle(20, 0, 25, 5), {}},
                                {test::rectangle(0, 0, 5, 5), {}},
                                {test::rectangle(10, 0, 15, 5), {}}});
  const Route route = plan(layer, context, {{"chain", word("linear")}, {"seam", word("min_x")}});
  ASSERT_EQ(route.strokes.size(), 3U);
  EXPECT_EQ(route.strokes[0].points.front(), (Point2{0.25, 0.25}));
  EXPECT_EQ(route.strokes[1].points.front(), (Point2{10.25, 0.25}));
  EXPECT_EQ(route.strokes[2].points.front(), (Point2{20.25, 0.25}));
}

TEST(GreedyShell, AnIslandIsFinishedBeforeTheNextOne) {
  const Layer layer =
      layer_of({{test::rectangle(0, 0, 5, 5), {}}, {test::rectangle(5.1, 0, 10, 5), {}}});
  const Route route = plan(layer, context_for(3));
  ASSERT_EQ(route.strokes.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(route.strokes[i].points.front().x < 5.05, i < 3) << i;
}

TEST(GreedyShell, WallsTooThinForTwoBeadsAreDroppedOrLaidThereAndBack) {
  const Layer strip = layer_of({{test::rectangle(0, 0, 20, kWidth + 0.1), {}}});
  EXPECT_TRUE(plan(strip, context_for(1), {{"thin", word("drop")}, {"gaps", word("leave")}})
                  .strokes.empty());
  // In their place one line as wide as the strip, from end to end but for half its width.
  const Route single = plan(strip, context_for(1), {{"thin", word("drop")}});
  ASSERT_EQ(single.strokes.size(), 1U);
  EXPECT_NEAR(single.strokes[0].width_mm, kWidth + 0.1, 0.02);
  EXPECT_GT(length_mm(single), 20 - 2 * (kWidth + 0.1));
  const Route doubled = plan(strip, context_for(1), {{"thin", word("double")}});
  ASSERT_EQ(doubled.strokes.size(), 1U);
  EXPECT_NEAR(length_mm(doubled), 2 * (20 - kWidth) + 2 * 0.1, 1e-6);
  const Layer wide = layer_of({{test::rectangle(0, 0, 20, kWidth + 0.7 * kSpacing), {}}});
  EXPECT_EQ(plan(wide, context_for(1), {{"thin", word("drop")}}).strokes.size(), 1U);
}

TEST(GreedyShell, SmallIslandsAreWalledTwiceOnRequest) {
  const Layer layer =
      layer_of({{test::rectangle(0, 0, 1.2, 1.2), {}}, {test::rectangle(5, 0, 15, 10), {}}});
  const Route once = plan(layer, context_for(1));
  const Route twice = plan(layer, context_for(1), {{"small_twice", true}});
  ASSERT_EQ(once.strokes.size(), 2U);
  ASSERT_EQ(twice.strokes.size(), 2U);
  EXPECT_NEAR(length_mm({{twice.strokes[0]}}), 2 * length_mm({{once.strokes[0]}}), 1e-9);
  EXPECT_EQ(twice.strokes[0].points.front(), twice.strokes[0].points.back());
  EXPECT_EQ(twice.strokes[1], once.strokes[1]);
}

TEST(GreedyShell, WallsFollowTheOutlineOfALivelyLayer) {
  const Polygons outline = test::blob();
  const Route route = plan(layer_of(outline), context_for(2));
  double reached = 0, all = 0;
  for (const Ring& ring : rings_of(outline)) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      const Point2 middle = lerp(a, b, 0.5);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Stroke& stroke : route.strokes)
        for (std::size_t k = 1; k < stroke.points.size(); ++k)
          nearest = std::min(
              nearest,
              distance(middle, nearest_on_segment(middle, stroke.points[k - 1], stroke.points[k])));
      all += distance(a, b);
      if (nearest <= kWidth) reached += distance(a, b);
    }
  }
  EXPECT_GE(reached, 0.99 * all);
}

TEST(GreedyShell, APartThinnerThanALineGetsOneOfItsOwnWidth) {
  const Route route = plan(layer_of({{test::rectangle(0, 0, 20, 0.3125), {}}}), context_for(2));
  ASSERT_EQ(route.strokes.size(), 1U);
  const Stroke& stroke = route.strokes[0];
  EXPECT_NEAR(stroke.width_mm, 0.3125, 0.005);
  EXPECT_NEAR(length_mm(stroke.points), 20 - 0.3125, 0.02);
  for (const Point2 p : stroke.points) EXPECT_NEAR(p.y, 0.15625, 0.005);
  EXPECT_TRUE(
      plan(layer_of({{test::rectangle(0, 0, 20, 0.1), {}}}), context_for(2)).strokes.empty())
      << "thinner than any printer's line";
}

TEST(GreedyShell, AStripBetweenWallsIsFilled) {
  // The first walls reach (kWidth + kSpacing) / 2 from either side; no second one fits between.
  const double open_mm = 0.25, width_mm = kWidth + kSpacing + open_mm;
  const Route route = plan(layer_of({{test::rectangle(0, 0, 20, width_mm), {}}}), context_for(2));
  ASSERT_EQ(route.strokes.size(), 2U);
  EXPECT_EQ(route.strokes[0].points.front(), route.strokes[0].points.back());
  // Its bead overlaps with the walls' as they would with each other.
  EXPECT_NEAR(route.strokes[1].width_mm, open_mm + kWidth - kSpacing, 0.01);
  for (const Point2 p : route.strokes[1].points) EXPECT_NEAR(p.y, width_mm / 2, 0.01);
  // With one wall asked for, the strip belongs to the inside.
  EXPECT_EQ(
      plan(layer_of({{test::rectangle(0, 0, 20, width_mm), {}}}), context_for(1)).strokes.size(),
      1U);
}

TEST(GreedyShell, FillingGapsLeavesTheWallsAsTheyAreAndCoversMore) {
  const auto sorted_walls = [](const Route& route) {
    std::vector<std::vector<Point2>> walls;
    for (const Stroke& stroke : route.strokes)
      if (stroke.width_mm == kWidth && stroke.points.front() == stroke.points.back())
        walls.push_back(stroke.points);
    const auto less = [](Point2 a, Point2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
    for (std::vector<Point2>& wall : walls) std::sort(wall.begin(), wall.end(), less);
    std::sort(walls.begin(), walls.end(), [&](const auto& a, const auto& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), less);
    });
    return walls;
  };
  const ParamSet fill{{"thin", word("double")}, {"seam", word("min_x")}};
  ParamSet leave = fill;
  leave["gaps"] = word("leave");
  int filled = 0;
  for (const Layer& layer : trial_layers()) {
    const Route walls = plan(layer, context_for(3), leave);
    const Route all = plan(layer, context_for(3), fill);
    EXPECT_EQ(sorted_walls(all), sorted_walls(walls));
    if (all.strokes.size() == walls.strokes.size()) continue;
    ++filled;
    EXPECT_GT(test::share_under_beads(layer.polygons, all, 0.05),
              test::share_under_beads(layer.polygons, walls, 0.05));
  }
  EXPECT_GT(filled, 5);
}

/// What is left between the sides of places beyond what is taken.
Polygons open_between(const std::vector<TakenSides>& places) {
  // Where one wall just follows the other nothing is; offsets are true to 5 um.
  constexpr double kNoiseMm = 0.01;
  Polygons open;
  for (const TakenSides& sides : places) {
    std::vector<double> distances_mm;
    for (const double taken_mm : sides.taken_mm) distances_mm.push_back(-taken_mm - kNoiseMm);
    open = unite(open, offset(offset_boundary(sides.rings, distances_mm), kNoiseMm));
  }
  return open;
}

TEST(WallGaps, AreWhatNoWallReaches) {
  for (const Layer& layer : trial_layers())
    for (const Polygon& polygon : layer.polygons) {
      const PlanContext context = context_for(3);
      const std::vector<Polygons> regions = wall_regions(polygon, context);
      // Offsets are true to 5 um.
      Polygons all;
      for (const std::vector<TakenSides>& places : wall_gaps({polygon}, regions, 3, context))
        all = unite(all, open_between(places));
      const Polygons gaps = without_thin_parts(all, 0.02);
      const double slivers_mm2 = 0.001 * perimeter_mm(polygon);
      EXPECT_LE(area_mm2(subtract(gaps, {polygon})), slivers_mm2);
      for (std::size_t wall = 0; wall < regions.size(); ++wall) {
        const double reach_mm = (wall == 0 ? kWidth : kSpacing) / 2;
        const Polygons band =
            subtract(offset(regions[wall], reach_mm), offset(regions[wall], -kSpacing / 2));
        EXPECT_LE(area_mm2(intersect(gaps, band)), slivers_mm2);
      }
    }
  const Polygon square{test::rectangle(0, 0, 10, 10), {}};
  for (const std::vector<TakenSides>& none :
       wall_gaps({square}, wall_regions(square, context_for(3)), 3, context_for(3)))
    EXPECT_TRUE(none.empty());
}

TEST(WallGaps, LeaveNoRoomForALineBesideThem) {
  // They are sought only where a wall does not follow the one before it; this looks everywhere.
  int found = 0;
  for (const Layer& layer : trial_layers())
    for (const Polygon& polygon : layer.polygons) {
      const PlanContext context = context_for(3);
      const std::vector<Polygons> regions = wall_regions(polygon, context);
      const std::vector<std::vector<TakenSides>> gaps = wall_gaps({polygon}, regions, 3, context);
      const auto missing = [&](const Polygons& open, const Polygons& laid, const Polygons& gap) {
        found += gap.empty() ? 0 : 1;
        const Polygons all = without_thin_parts(subtract(open, laid), narrowest_line_mm(context));
        for (const Polygon& part : subtract(all, offset(gap, 0.02))) {
          // What is left is no longer than the ends of a line.
          const Box2 box = bounding_box(part);
          EXPECT_LE(distance(box.lower, box.upper), kWidth / 2);
        }
      };
      for (std::size_t wall = 0; wall <= regions.size() && wall < 3; ++wall) {
        const Polygons region = wall < regions.size() ? regions[wall] : Polygons{};
        if (wall == 0)
          missing({polygon}, offset(region, kWidth / 2), open_between(gaps[wall]));
        else
          missing(offset(regions[wall - 1], -kSpacing / 2), offset(region, kSpacing / 2),
                  open_between(gaps[wall]));
      }
    }
  EXPECT_GT(found, 20);
}

}  // namespace
}  // namespace routebench
