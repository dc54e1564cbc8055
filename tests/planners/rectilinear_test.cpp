#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "planning.hpp"
#include "routebench/geometry/grid.hpp"

namespace routebench {
namespace {

using test::context_for;
using test::kSpacing;
using test::kWidth;
using test::layer_of;
using test::length_mm;
using test::word;

Route plan(const Layer& layer, const PlanContext& context, const ParamSet& params = {}) {
  return test::plan("rectilinear", layer, context, params);
}

Layer square(int index = 0) { return layer_of({{test::rectangle(0, 0, 10, 10), {}}}, index); }

const ParamSet kLevelLoose{{"angle_deg", 0.0}, {"link", word("none")}};

/// Heights of level strokes, sorted.
std::vector<double> heights(const Route& route) {
  std::vector<double> ys;
  for (const Stroke& stroke : route.strokes) {
    EXPECT_EQ(stroke.points.front().y, stroke.points.back().y);
    ys.push_back(stroke.points.front().y);
  }
  std::sort(ys.begin(), ys.end());
  return ys;
}

TEST(Rectilinear, SparseLinesOfASquareAreWhereTheyMustBe) {
  // Lines kSpacing / 0.25 = 1.75 apart from the origin, half a line away from the walls.
  const Route route = plan(square(), context_for(0, 0.25), kLevelLoose);
  EXPECT_EQ(heights(route), (std::vector<double>{1.75, 3.5, 5.25, 7, 8.75}));
  for (const Stroke& stroke : route.strokes) {
    EXPECT_EQ(std::min(stroke.points[0].x, stroke.points[1].x), 0.25);
    EXPECT_EQ(std::max(stroke.points[0].x, stroke.points[1].x), 9.75);
    EXPECT_EQ(stroke.width_mm, kWidth);
  }
}

TEST(Rectilinear, NearestFirstMakesAZigzag) {
  const Route route = plan(square(), context_for(0, 0.25), kLevelLoose);
  for (std::size_t i = 1; i < route.strokes.size(); ++i)
    EXPECT_EQ(distance(route.strokes[i - 1].points.back(), route.strokes[i].points.front()), 1.75);
}

TEST(Rectilinear, DirectionTurnsOnOddLayersUnlessToldNotTo) {
  const PlanContext context = context_for(0, 0.25);
  ParamSet params = kLevelLoose;
  const Route odd = plan(square(1), context, params);
  for (const Stroke& stroke : odd.strokes) EXPECT_EQ(stroke.points[0].x, stroke.points[1].x);
  params["alternate"] = false;
  EXPECT_EQ(plan(square(1), context, params), plan(square(0), context, params));
}

TEST(Rectilinear, LinesMeetFromLayerToLayer) {
  PlanContext context = context_for(0, 0.2);
  context.origin = {0.3, 0.7};
  const Layer other = layer_of({{test::rectangle(3, 2.1, 40, 33.3), {}}});
  for (const Layer& layer : {square(), other}) {
    const double distance_mm = kSpacing / 0.2;
    for (const double y : heights(plan(layer, context, kLevelLoose))) {
      const double lines = (y - snap(0.7)) / distance_mm;
      EXPECT_NEAR(lines, std::round(lines), 1e-5);
    }
  }
}

TEST(Rectilinear, GridLaysBothDirectionsAtHalfTheDensityEach) {
  ParamSet params = kLevelLoose;
  params["grid"] = true;
  const Route route = plan(square(), context_for(0, 0.5), params);
  // Lines 2 x kSpacing / 0.5 = 1.75 apart: five each way.
  const auto is_level = [](const Stroke& s) { return s.points[0].y == s.points[1].y; };
  ASSERT_EQ(route.strokes.size(), 10U);
  EXPECT_EQ(std::count_if(route.strokes.begin(), route.strokes.end(), is_level), 5);
  EXPECT_NEAR(length_mm(route), 10 * 9.5, 1e-9);
  // A dense layer gets one direction.
  params["trace"] = false;
  for (const Stroke& stroke : plan(square(), context_for(0, 1), params).strokes)
    EXPECT_TRUE(is_level(stroke));
}

TEST(Rectilinear, DenseLinesAreSpreadEvenlyOverTheRegion) {
  for (const double side : {2.0, 3.1, 5.0, 7.77, 10.0}) {
    const Layer layer = layer_of({{test::rectangle(0, 0, side, side), {}}});
    const std::vector<double> ys = heights(plan(layer, context_for(0, 1), kLevelLoose));
    ASSERT_GE(ys.size(), 2U);
    // The outermost beads reach the edge, but for the wave that offsets may have.
    EXPECT_NEAR(ys.front(), kWidth / 2, 0.011);
    EXPECT_NEAR(ys.back(), side - kWidth / 2, 0.011);
    const double gap = (ys.back() - ys.front()) / static_cast<double>(ys.size() - 1);
    EXPECT_LE(gap, kWidth);
    EXPECT_GE(gap, 0.75 * kSpacing);
    for (std::size_t i = 1; i < ys.size(); ++i) EXPECT_NEAR(ys[i] - ys[i - 1], gap, 1e-5);
  }
}

TEST(Rectilinear, WithoutFitDenseLinesLieASpacingApart) {
  ParamSet params = kLevelLoose;
  params["fit"] = false;
  params["trace"] = false;
  const std::vector<double> ys = heights(plan(square(), context_for(0, 1), params));
  ASSERT_EQ(ys.size(), 22U);  // 1 x 0.4375 to 22 x 0.4375, within 0.25 to 9.75
  for (std::size_t i = 0; i < ys.size(); ++i)
    EXPECT_EQ(ys[i], static_cast<double>(i + 1) * kSpacing);
}

TEST(Rectilinear, AllSearchesGiveTheSameRoute) {
  for (const Layer& layer : test::trial_layers())
    for (const double density : {1.0, 0.3}) {
      const PlanContext context = context_for(0, density);
      const Route bucket = plan(layer, context, {{"search", word("bucket")}});
      EXPECT_EQ(plan(layer, context, {{"search", word("sweep")}}), bucket);
      EXPECT_EQ(plan(layer, context, {{"search", word("naive")}}), bucket);
    }
}

TEST(Rectilinear, LinkedAlongTheBoundaryASquareIsOneStroke) {
  const Route route = plan(square(), context_for(0, 0.25), {{"angle_deg", 0.0}});
  ASSERT_EQ(route.strokes.size(), 1U);
  EXPECT_NEAR(length_mm(route), 5 * 9.5 + 4 * 1.75, 1e-9);
}

TEST(Rectilinear, LongLinksAreNotMade) {
  const ParamSet params{{"angle_deg", 0.0}, {"max_link", 0.99}};
  EXPECT_EQ(plan(square(), context_for(0, 0.25), params).strokes.size(), 5U);
}

TEST(Rectilinear, LinksSaveStrokesAndLoseNoLine) {
  for (const Layer& layer : test::trial_layers()) {
    const PlanContext context = context_for(0, 0.3);
    const Route loose = plan(layer, context, {{"link", word("none")}});
    for (const char* link : {"flows", "boundary"}) {
      const Route linked = plan(layer, context, {{"link", word(link)}});
      EXPECT_LE(linked.strokes.size(), loose.strokes.size());
      EXPECT_GE(length_mm(linked), length_mm(loose) - 1e-6);
    }
  }
}

TEST(Rectilinear, EndsCutAtTheOutlineArePulledInAlongTheLine) {
  ParamSet params = kLevelLoose;
  params["ends"] = word("along");
  params["end_gap"] = 2.0;
  const Layer slanted = layer_of({{{{0, 0}, {20, 0}, {10, 10}, {0, 10}}, {}}});
  for (const Stroke& stroke : plan(slanted, context_for(0, 0.25), params).strokes) {
    const auto [left, right] = std::minmax(stroke.points[0].x, stroke.points[1].x);
    EXPECT_NEAR(left, 2 * kWidth, 1e-5);
    EXPECT_NEAR(right, 20 - stroke.points[0].y - 2 * kWidth, 1e-5);
  }
}

TEST(Rectilinear, ShortLinesAreLeftOut) {
  ParamSet params = kLevelLoose;
  params["min_length_mm"] = 5.0;
  const Layer triangle = layer_of({{{{0, 0}, {20, 0}, {0, 20}}, {}}});
  const Route route = plan(triangle, context_for(0, 0.25), params);
  ASSERT_FALSE(route.strokes.empty());
  for (const Stroke& stroke : route.strokes)
    EXPECT_GE(distance(stroke.points[0], stroke.points[1]), 5 - 1e-5);
}

/// What two walls leave of an outline.
Polygons inside_of(Polygons outline) {
  for (int wall = 0; wall < 2; ++wall) outline = offset(outline, -kSpacing);
  return outline;
}

/// Walls and dense fill as a contender lays them.
Route dense_layer(const Polygons& outline, const ParamSet& fill) {
  const PlanContext context = context_for(2, 1);
  Route route = test::plan("greedy_shell", layer_of(outline), context);
  const Route inner = plan(layer_of(inside_of(outline)), context, fill);
  route.strokes.insert(route.strokes.end(), inner.strokes.begin(), inner.strokes.end());
  return route;
}

TEST(Rectilinear, DenseLayersAreCovered) {
  std::vector<Polygons> outlines{
      test::blob(),
      {{test::rectangle(0, 0, 10, 10), {}}},
      {{test::circle({10, 10}, 10, 64), {test::reversed(test::circle({10, 10}, 6, 64))}}}};
  for (const Polygons& outline : outlines)
    for (const double angle : {0.0, 45.0}) {
      const Route route = dense_layer(outline, {{"angle_deg", angle}});
      EXPECT_GE(test::share_under_beads(inside_of(outline), route), 0.97) << angle;
      // Neither is much laid twice: the material is what the area takes, and little more.
      EXPECT_LE(length_mm(route) * kSpacing, 1.08 * area_mm2(outline)) << angle;
    }
}

TEST(Rectilinear, NarrowSectionsAreCoveredWhateverTheirWidthAndDirection) {
  // Slanted struts cut level: ellipses, from those with room for one line alone to those that walls
  // and lines fill.
  for (const double lines : {0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.5})
    for (const double slant : {1.5, 3.0})
      for (const double angle : {0.0, 0.4, 0.9, 1.5}) {
        const double wide_mm = lines * kWidth;
        const Polygons outline = test::ellipse({20, 20}, slant * wide_mm, wide_mm, angle);
        const Route route = dense_layer(outline, {});
        const double share = test::share_under_beads(outline, route, 0.02);
        // No wider than a line there is room for one bead alone.
        const double least =
            lines > 1 ? 0.9 : 0.9 * test::largest_bead_mm2(outline, kWidth) / area_mm2(outline);
        EXPECT_GE(share, least) << lines << " lines wide, " << slant << " times as long, at "
                                << angle;
      }
}

TEST(Rectilinear, AsDeKeyserPublishedIt) {
  // Both directions at half the density, hence 3.5 mm apart; ends pulled in by 3 x 0.2 mm.
  Layer layer = layer_of({{test::rectangle(1, 1, 11, 11), {}}});
  layer.height_mm = 0.2;
  const ParamSet published{{"published", word("dekeyser")}, {"angle_deg", 30.0}};
  const Route route = plan(layer, context_for(0, 0.25), published);
  const std::vector<std::vector<Point2>> expected{
      {{1.6, 3.5}, {10.4, 3.5}}, {{10.4, 7}, {1.6, 7}}, {{1.6, 10.5}, {10.4, 10.5}}};
  ASSERT_EQ(route.strokes.size(), 6U);
  for (std::size_t i = 0; i < expected.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_LT(distance(route.strokes[i].points[k], expected[i][k]), 1e-5) << i;
  for (std::size_t i = 3; i < 6; ++i)
    EXPECT_EQ(route.strokes[i].points[0].x, route.strokes[i].points[1].x);

  // 2.5 mm less 1.2 mm are under seven layer heights.
  layer.polygons = {{test::rectangle(1, 1, 3.5, 3.5), {}}};
  EXPECT_TRUE(plan(layer, context_for(0, 1), published).strokes.empty());
}

TEST(Rectilinear, PublishedFlowsRunOverHollows) {
  // Two bars that a thin strip joins, with one line in each.
  const Polygon bars{{{0, 0}, {4, 0}, {4, 1.9}, {10, 1.9}, {10, 4}, {6, 4}, {6, 2.1}, {0, 2.1}},
                     {}};
  PlanContext context = context_for(0, kSpacing / 2);
  context.origin = {0, 1};
  const Route published = plan(layer_of({bars}), context, {{"published", word("simple_slicer")}});
  ASSERT_EQ(published.strokes.size(), 1U);
  EXPECT_EQ(published.strokes[0].points,
            (std::vector<Point2>{{0.5, 1}, {3.5, 1}, {9.5, 3}, {6.5, 3}}));
  // Our own rule for flows stays inside.
  const ParamSet flows{{"angle_deg", 0.0}, {"ends", word("along")}, {"link", word("flows")}};
  EXPECT_EQ(plan(layer_of({bars}), context, flows).strokes.size(), 2U);
}

TEST(Rectilinear, ZigzagLaysLineAfterLineToAndFro) {
  ParamSet params = kLevelLoose;
  params["order"] = word("zigzag");
  PlanContext context = context_for(0, 0.25);
  context.start = {5, 9};
  const Route route = plan(square(), context, params);
  ASSERT_EQ(route.strokes.size(), 5U);
  for (std::size_t i = 0; i < route.strokes.size(); ++i) {
    EXPECT_EQ(route.strokes[i].points[0].y, 1.75 * static_cast<double>(i + 1));
    EXPECT_EQ(route.strokes[i].points[0].x < route.strokes[i].points[1].x, i % 2 == 0);
  }
}

TEST(Rectilinear, AStripThinnerThanALineIsFilledWhereAllIsDense) {
  // A square with a tail.
  const Layer tailed = layer_of(
      {{{{0, 0}, {10, 0}, {10, 4}, {20, 4}, {20, 4.3125}, {10, 4.3125}, {10, 10}, {0, 10}}, {}}});
  const auto in_the_tail = [](const Route& route) {
    double sum_mm = 0;
    for (const Stroke& stroke : route.strokes)
      if (stroke.points.front().x > 9.9 && stroke.points.back().x > 9.9) {
        EXPECT_NEAR(stroke.width_mm, 0.3125, 0.01);
        sum_mm += length_mm(stroke.points);
      }
    return sum_mm;
  };
  EXPECT_NEAR(in_the_tail(plan(tailed, context_for(0, 1))), 10, 0.5);
  EXPECT_EQ(in_the_tail(plan(tailed, context_for(0, 1), {{"thin", word("drop")}})), 0);
  EXPECT_EQ(in_the_tail(plan(tailed, context_for(0, 0.5))), 0);
}

}  // namespace
}  // namespace routebench
