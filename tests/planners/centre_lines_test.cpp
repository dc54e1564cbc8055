#include "routebench/planning/centre_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "planning.hpp"
#include "polygons.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/walls.hpp"
#include "src/chordal_axis.hpp"

namespace routebench {
namespace {

std::vector<Stroke> lines_of(const Polygons& thin, const CentreLineRule& rule = {}) {
  return centre_lines(thin, rule, PlanContext{});
}

CentreLineRule inscribed() {
  CentreLineRule rule;
  rule.width = CentreLineWidth::kInscribed;
  return rule;
}

/// A strip from (0, 0) to (length, 0), turned.
Polygons strip(double length, double width, double angle_rad) {
  const Point2 along{std::cos(angle_rad), std::sin(angle_rad)}, up{-along.y, along.x};
  const auto at = [&](double x, double y) { return snap(Point2{50, 50} + x * along + y * up); };
  const double h = width / 2;
  return {{{at(0, -h), at(length, -h), at(length, h), at(0, h)}, {}}};
}

double farthest_outside_mm(const Polygons& polygons, const std::vector<Stroke>& strokes) {
  const EdgeGrid edges(polygons);
  double farthest = 0;
  for (const Stroke& stroke : strokes)
    for (std::size_t i = 1; i < stroke.points.size(); ++i)
      for (int k = 0; k <= 20; ++k) {
        const Point2 p = lerp(stroke.points[i - 1], stroke.points[i], k / 20.0);
        EXPECT_TRUE(edges.contains(p));
        if (const auto mm = edges.distance_to_edge_mm(p, stroke.width_mm / 2))
          farthest = std::max(farthest, stroke.width_mm / 2 - *mm);
      }
  return farthest;
}

TEST(CentreLines, AStripIsOneStrokeOfItsWidthHalfAWidthShortAtItsEnds) {
  for (const double width : {0.12, 0.3, 0.55})
    for (const double angle : {0.0, 0.5, 1.1}) {
      const std::vector<Stroke> strokes = lines_of(strip(10, width, angle));
      ASSERT_EQ(strokes.size(), 1U) << width << ", " << angle;
      EXPECT_NEAR(strokes[0].width_mm, width, 0.012);
      EXPECT_NEAR(length_mm(strokes[0].points), 10 - width, 0.04);
      for (const Point2 p : strokes[0].points)
        EXPECT_NEAR(cross({std::cos(angle), std::sin(angle)}, p - Point2{50, 50}), 0, 0.006);
    }
}

TEST(CentreLines, AWiderPlaceGetsTheGreatestWidth) {
  for (const Stroke& stroke : lines_of(strip(10, 0.9, 0.2)))
    EXPECT_NEAR(stroke.width_mm, 0.6, 0.001);
}

TEST(CentreLines, NarrowerAndShorterPartsGetNone) {
  EXPECT_TRUE(lines_of(strip(10, 0.08, 0.2)).empty());
  EXPECT_TRUE(lines_of(strip(0.15, 0.12, 0.2)).empty());
  EXPECT_TRUE(lines_of({}).empty());
}

TEST(CentreLines, ARingGivesALoop) {
  const Polygons ring{
      {test::circle({5, 5}, 5, 100), {test::reversed(test::circle({5, 5}, 4.6, 100))}}};
  const std::vector<Stroke> strokes = lines_of(ring);
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_EQ(strokes[0].points.front(), strokes[0].points.back());
  EXPECT_NEAR(length_mm(strokes[0].points), 2 * std::numbers::pi * 4.8, 0.1);
  EXPECT_NEAR(strokes[0].width_mm, 0.4, 0.02);
}

TEST(CentreLines, WhatSidesTakeIsLeftOut) {
  // Between the circles 0.4 mm wide, of which the outer side takes 0.1 mm and the inner one less.
  const CentreLineRule rule{.max_width_mm = 0.6, .width = CentreLineWidth::kInscribed};
  for (const double inner_mm : {0.0, 0.05, 0.1}) {
    const std::vector<Stroke> strokes = centre_lines(
        TakenSides{{test::circle({5, 5}, 5, 400), test::reversed(test::circle({5, 5}, 4.6, 400))},
                   {0.1, inner_mm}},
        rule, PlanContext{});
    ASSERT_EQ(strokes.size(), 1U);
    EXPECT_NEAR(strokes[0].width_mm, 0.3 - inner_mm, 0.015);
    for (const Point2 p : strokes[0].points)
      EXPECT_NEAR(distance(p, {5, 5}), 4.75 + inner_mm / 2, 0.01);
  }
  // Nothing is left.
  EXPECT_TRUE(
      centre_lines(TakenSides{{test::rectangle(0, 0, 10, 0.4)}, {0.19}}, rule, PlanContext{})
          .empty());
}

TEST(ChordalAxis, IsATriangulationOfFewAndOfManyPoints) {
  // A frame with long sides: of a triangulation of n points with one hole n triangles, and as many
  // chords, since each triangle has three sides and n of all sides are the boundary's.
  const Polygon frame{test::rectangle(0, 0, 40, 2),
                      {test::reversed(test::rectangle(0.25, 0.25, 39.75, 1.75))}};
  for (const double step_mm : {10.0, 1.0, 0.3, 0.1, 0.02}) {
    std::size_t points = 0;
    for (const Ring& ring : rings_of({frame}))
      for (std::size_t i = 0; i < ring.size(); ++i)
        points +=
            static_cast<std::size_t>(distance(ring[i], ring[(i + 1) % ring.size()]) / step_mm + 1);
    const ChordalAxis axis = chordal_axis(frame, step_mm);
    EXPECT_EQ(axis.triangles.size(), points) << step_mm;
    EXPECT_EQ(axis.chords.size(), points) << step_mm;
  }
}

TEST(CentreLines, TheArmsOfAForkMeet) {
  // A T whose bars are 0.4 mm wide.
  const Polygons fork{
      {{{0, 0}, {8, 0}, {8, 0.4}, {4.2, 0.4}, {4.2, 5}, {3.8, 5}, {3.8, 0.4}, {0, 0.4}}, {}}};
  const std::vector<Stroke> strokes = lines_of(fork);
  ASSERT_EQ(strokes.size(), 3U);
  double length = 0;
  for (const Stroke& stroke : strokes) {
    length += length_mm(stroke.points);
    const auto near_fork = [](Point2 p) { return distance(p, {4, 0.2}) < 0.15; };
    EXPECT_TRUE(near_fork(stroke.points.front()) || near_fork(stroke.points.back()));
  }
  EXPECT_NEAR(length, 3.8 + 3.8 + 4.6, 0.3);
}

TEST(CentreLines, AWedgeIsCutWhereItsWidthChanges) {
  const Polygons wedge{{{{0, 0}, {20, 0.25}, {0, 0.5}}, {}}};
  const std::vector<Stroke> strokes = lines_of(wedge, inscribed());
  ASSERT_GE(strokes.size(), 5U);
  for (const Stroke& stroke : strokes) {
    const auto [first, second] = std::minmax(stroke.points.front().x, stroke.points.back().x);
    EXPECT_LE((20 - first) / (20 - second), 1.35) << first;
    EXPECT_NEAR(stroke.width_mm, 0.5 * (20 - second) / 20, 0.02);
  }
  EXPECT_LE(farthest_outside_mm(wedge, strokes), 0.011);
}

TEST(CentreLines, BeadsStayInsideAndFillNarrowParts) {
  double mean_share = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    // What is left of random polygons near their boundary: bent strips with corners and forks.
    const Polygons all = test::random_polygons(seed);
    const Polygons bands = without_thin_parts(subtract(all, offset(all, -0.45)), 0.1);
    const std::vector<Stroke> tight = lines_of(bands, inscribed());
    EXPECT_LE(farthest_outside_mm(bands, tight), 0.02) << seed;
    const double share = test::share_under_beads(bands, {tight}, 0.11);
    EXPECT_GE(share, 0.9) << seed;
    mean_share += share / 10;
    const std::vector<Stroke> mean = lines_of(bands);
    EXPECT_LE(farthest_outside_mm(bands, mean), 0.1) << seed;
    double volume = 0;
    for (const Stroke& stroke : mean) volume += length_mm(stroke.points) * stroke.width_mm;
    EXPECT_NEAR(volume / area_mm2(bands), 1, 0.08) << seed;
  }
  EXPECT_GE(mean_share, 0.94);
}

TEST(CentreLines, ACompactPartGetsADotIfThatIsAskedFor) {
  const Polygons square{{test::rectangle(3, 4, 3.4, 4.4), {}}};
  CentreLineRule rule = inscribed();
  rule.min_length_mm = 1;
  EXPECT_TRUE(lines_of(square, rule).empty());
  rule.min_dot_mm = 0.35;
  const std::vector<Stroke> strokes = lines_of(square, rule);
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_LT(distance(lerp(strokes[0].points[0], strokes[0].points[1], 0.5), {3.2, 4.2}), 0.03);
  EXPECT_GE(strokes[0].width_mm, 0.28);
  EXPECT_LE(farthest_outside_mm(square, strokes), 1e-5);
  rule.min_dot_mm = 0.45;
  EXPECT_TRUE(lines_of(square, rule).empty());
}

TEST(CentreLines, ACompactPartGetsNearlyTheLargestBeadThatFits) {
  // A bead from corner to corner would be no wider than it is there.
  for (const double length : {0.36, 0.45, 0.6})
    for (const double width : {0.25, 0.3, 0.35})
      for (int turn = 0; turn < 6; ++turn) {
        const double angle = 0.1 + turn * std::numbers::pi / 6;
        for (const Polygons& part :
             {strip(length, width, angle), test::ellipse({50, 50}, length, width, angle)}) {
          const CentreLineRule rule = inscribed();
          const std::vector<Stroke> strokes = lines_of(part, rule);
          EXPECT_LE(farthest_outside_mm(part, strokes), 0.02) << length << ", " << width;
          EXPECT_GE(test::share_under_beads(part, {strokes}, 0.005) * area_mm2(part),
                    0.9 * test::largest_bead_mm2(part, rule.max_width_mm))
              << length << " x " << width << " mm at " << angle;
        }
      }
}

TEST(CentreLines, TheyMoveWithThePolygons) {
  const Point2 by{snap(137.3), snap(-61.7)};
  for (const TrialLayer& trial : routebench::trial_layers()) {
    if (trial.name == "thousand_islands") continue;
    const Polygons& here = trial.layer.polygons;
    Polygons there = here;
    for (Polygon& polygon : there) {
      for (Point2& p : polygon.outer) p = p + by;
      for (Ring& hole : polygon.holes)
        for (Point2& p : hole) p = p + by;
    }
    CentreLineRule rule;
    rule.min_dot_mm = 0.1;
    std::vector<Stroke> expected = lines_of(here, rule);
    for (Stroke& stroke : expected)
      for (Point2& p : stroke.points) {
        EXPECT_EQ(p, snap(p));
        p = p + by;
      }
    EXPECT_EQ(lines_of(there, rule), expected) << trial.name;
  }
}

TEST(CentreLines, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  PlanContext context;
  context.stop = source.get_token();
  EXPECT_THROW((void)centre_lines(strip(10, 0.3, 0), {}, context), Error);
}

}  // namespace
}  // namespace routebench
