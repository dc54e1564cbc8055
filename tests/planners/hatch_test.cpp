#include "routebench/planning/hatch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "planning.hpp"
#include "routebench/geometry/grid.hpp"

namespace routebench {
namespace {

HatchRule level_lines(double first_mm, double step_mm, std::uint32_t count) {
  HatchRule rule;
  rule.lines = {first_mm, step_mm, count};
  return rule;
}

/// Hatches of lively polygons in several directions.
std::vector<Hatch> trial_hatches() {
  std::vector<Hatch> hatches;
  for (const Layer& layer : test::trial_layers())
    for (const Polygon& polygon : layer.polygons)
      for (const double angle : {0.0, 45.0, 90.0, 17.0}) {
        HatchRule rule = level_lines(-100, 0.7, 300);
        rule.angle_deg = angle;
        hatches.emplace_back(polygon, rule);
      }
  return hatches;
}

TEST(Turn, QuarterTurnsAreExact) {
  const Point2 p{1.5, 0.25};
  EXPECT_EQ(Turn(0).to_level(p), p);
  EXPECT_EQ(Turn(90).to_level(p), (Point2{0.25, -1.5}));
  EXPECT_EQ(Turn(180).to_level(p), (Point2{-1.5, -0.25}));
  EXPECT_EQ(Turn(-90).to_level(p), (Point2{-0.25, 1.5}));
  EXPECT_EQ(Turn(270).to_level(p), (Point2{-0.25, 1.5}));
}

TEST(Turn, ThereAndBackIsWhereItWas) {
  for (const double angle : {-180.0, -37.0, 0.0, 45.0, 90.0, 123.4}) {
    const Turn turn(angle);
    const Point2 back = turn.from_level(turn.to_level({3, 4}));
    EXPECT_NEAR(back.x, 3, 1e-12);
    EXPECT_NEAR(back.y, 4, 1e-12);
  }
}

TEST(HatchTest, PiecesLieOnTheirLinesBetweenTheWalls) {
  const Polygon frame{test::rectangle(0, 0, 9, 9), {test::reversed(test::rectangle(3, 3, 6, 6))}};
  const Hatch hatch(frame, level_lines(1, 3, 3));  // y = 1, 4, 7
  ASSERT_EQ(hatch.pieces(), 4U);
  std::vector<Point2> points;
  for (const Hatch::End& end : hatch.ends()) points.push_back(end.point);
  EXPECT_EQ(points,
            (std::vector<Point2>{{0, 1}, {9, 1}, {0, 4}, {3, 4}, {6, 4}, {9, 4}, {0, 7}, {9, 7}}));
  EXPECT_EQ(hatch.first_piece(1), 1U);
  EXPECT_EQ(hatch.first_piece(2), 3U);
  EXPECT_EQ(hatch.first_piece(3), 4U);
}

TEST(HatchTest, EndsArePulledInAndShortPiecesLeftOut) {
  HatchRule rule = level_lines(1, 3, 3);
  rule.end_gap_mm = 0.5;
  rule.min_length_mm = 2.5;
  const Polygon frame{test::rectangle(0, 0, 9, 9), {test::reversed(test::rectangle(3, 3, 6, 6))}};
  const Hatch hatch(frame, rule);
  ASSERT_EQ(hatch.pieces(), 2U);
  EXPECT_EQ(hatch.ends()[0].point, (Point2{0.5, 1}));
  EXPECT_EQ(hatch.ends()[1].point, (Point2{8.5, 1}));
}

TEST(HatchTest, PassesNearAgreesWithLookingAtAllPieces) {
  const Polygon blob = test::blob()[0];
  HatchRule rule = level_lines(-50, 0.9, 150);
  rule.angle_deg = 30;
  const Hatch hatch(blob, rule);
  for (const Ring& ring : hatch.rings())
    for (const Point2 p : ring)
      for (const double reach : {0.1, 0.5, 1.3}) {
        double nearest = 1e9;
        for (std::size_t i = 0; i < hatch.pieces(); ++i)
          nearest =
              std::min(nearest, distance(p, nearest_on_segment(p, hatch.ends()[2 * i].point,
                                                               hatch.ends()[2 * i + 1].point)));
        if (std::abs(nearest - reach) < 1e-5) continue;  // too near to call
        EXPECT_EQ(hatch.passes_near(p, reach), nearest < reach);
      }
}

TEST(HatchTest, StretchesAreTheWholeBoundaryOnce) {
  for (const Hatch& hatch : trial_hatches()) {
    double perimeter = 0, stretched = 0;
    for (const Ring& ring : hatch.rings()) perimeter += perimeter_mm(ring);
    std::multiset<std::size_t> begun, ended;
    for (const Stretch& stretch : boundary_stretches(hatch)) {
      stretched += length_mm(stretch.path);
      if (stretch.from_end == kNoEnd) continue;
      begun.insert(stretch.from_end);
      ended.insert(stretch.to_end);
    }
    EXPECT_NEAR(stretched, perimeter, 1e-5 * (1 + perimeter));
    for (std::size_t end = 0; end < hatch.ends().size(); ++end) {
      EXPECT_EQ(begun.count(end), 1U);
      EXPECT_EQ(ended.count(end), 1U);
    }
  }
}

/// Every end in one joint at most, every joint from end to end, and no piece laid twice or lost.
void expect_sound(const Hatch& hatch, const std::vector<Joint>& joints) {
  std::vector<int> used(hatch.ends().size(), 0);
  double sum = 0;
  for (const Joint& joint : joints) {
    ++used[joint.from_end];
    ++used[joint.to_end];
    EXPECT_EQ(joint.path.front(), hatch.ends()[joint.from_end].point);
    EXPECT_EQ(joint.path.back(), hatch.ends()[joint.to_end].point);
    sum += length_mm(joint.path);
  }
  for (const int times : used) EXPECT_LE(times, 1);
  for (std::size_t i = 0; i < hatch.pieces(); ++i)
    sum += distance(hatch.ends()[2 * i].point, hatch.ends()[2 * i + 1].point);
  double laid = 0;
  const auto polylines = joined_lines(hatch, joints);
  for (const auto& polyline : polylines) laid += length_mm(polyline);
  EXPECT_NEAR(laid, sum, 1e-9 * (1 + sum));
  EXPECT_EQ(polylines.size(), hatch.pieces() - joints.size()) << "a stroke was closed or lost";
}

TEST(HatchTest, JointsAlongTheBoundaryAreSound) {
  for (const Hatch& hatch : trial_hatches()) {
    const std::vector<Stretch> stretches = boundary_stretches(hatch);
    const std::vector<Joint> joints = join_along_boundary(hatch, stretches, 2);
    expect_sound(hatch, joints);
    for (const Joint& joint : joints) EXPECT_LE(length_mm(joint.path), 2);
    // Pieces that meet in a vertex need no way at all.
    for (const Joint& joint : join_along_boundary(hatch, stretches, 0))
      EXPECT_EQ(length_mm(joint.path), 0);
  }
}

TEST(HatchTest, FlowsAreSoundStraightInsideAndBetweenNeighbours) {
  for (const Layer& layer : test::trial_layers())
    for (const Polygon& polygon : layer.polygons) {
      const Hatch hatch(polygon, level_lines(-0.3, 0.7, 100));
      const std::vector<Joint> joints = join_flows(hatch, &polygon);
      expect_sound(hatch, joints);
      const EdgeGrid edges({polygon});
      for (const Joint& joint : joints) {
        EXPECT_LE(joint.path.size(), 2U);
        EXPECT_LE(edges.outside_length_mm(joint.path.front(), joint.path.back()), 1e-4);
        EXPECT_EQ(hatch.line_of_end(joint.from_end) + 1, hatch.line_of_end(joint.to_end));
      }
    }
}

TEST(HatchTest, FlowsEndWhereTheNumberOfPiecesChanges) {
  // Two legs of width 2 that stand on a foot: lines 0 and 1 in the foot, 2 to 4 in the legs.
  const Polygon legs{{{0, 0}, {6, 0}, {6, 5}, {4, 5}, {4, 2}, {2, 2}, {2, 5}, {0, 5}}, {}};
  const Hatch hatch(legs, level_lines(0.5, 1, 5));
  const auto polylines = joined_lines(hatch, join_flows(hatch, &legs));
  ASSERT_EQ(polylines.size(), 3U);
  EXPECT_EQ(polylines[0], (std::vector<Point2>{{0, 0.5}, {6, 0.5}, {6, 1.5}, {0, 1.5}}));
  EXPECT_EQ(polylines[1],
            (std::vector<Point2>{{0, 2.5}, {2, 2.5}, {2, 3.5}, {0, 3.5}, {0, 4.5}, {2, 4.5}}));
  EXPECT_EQ(polylines[2],
            (std::vector<Point2>{{4, 2.5}, {6, 2.5}, {6, 3.5}, {4, 3.5}, {4, 4.5}, {6, 4.5}}));
}

TEST(HatchTest, AStretchThatNoLineComesNearIsBare) {
  // The notch's level top, y = 1.875, lies 0.875 above line y = 1 and 0.625 below line y = 2.5.
  const Polygon notched{{{0, 0}, {10, 0}, {10, 3}, {7, 3}, {7, 1.875}, {3, 1.875}, {3, 3}, {0, 3}},
                        {}};
  const Hatch hatch(notched, level_lines(1, 1.5, 2));
  const auto bare = bare_boundary(hatch, boundary_stretches(hatch), {}, 0.4, 0.5, PlanContext{});
  ASSERT_EQ(bare.size(), 4U);
  for (const auto& polyline : bare) {
    EXPECT_GE(length_mm(polyline), 0.5);
    for (const Point2 p : polyline) EXPECT_EQ(p, snap(p));
  }
  const auto top = std::find_if(bare.begin(), bare.end(), [](const std::vector<Point2>& polyline) {
    return std::count(polyline.begin(), polyline.end(), Point2{3, 1.875}) == 1 &&
           std::count(polyline.begin(), polyline.end(), Point2{7, 1.875}) == 1;
  });
  EXPECT_NE(top, bare.end());
}

TEST(HatchTest, BareStretchesAreFarFromPiecesAndNotTracedTwice) {
  for (const Hatch& hatch : trial_hatches()) {
    const auto bare = bare_boundary(hatch, boundary_stretches(hatch), {}, 0.25, 0.3, PlanContext{});
    double traced = 0, perimeter = 0;
    for (const Ring& ring : hatch.rings()) perimeter += perimeter_mm(ring);
    for (const auto& polyline : bare) {
      traced += length_mm(polyline);
      for (const Point2 p : polyline) EXPECT_FALSE(hatch.passes_near(p, 0.25 - 1e-5));
    }
    EXPECT_LE(traced, perimeter + 1e-6);
  }
  // A slot 0.2 wide between two lines: one of its sides, not both.
  const Polygon slot{test::rectangle(0, 1.4, 10, 1.6), {}};
  const Hatch beside(slot, level_lines(0, 1, 4));
  const auto once = bare_boundary(beside, boundary_stretches(beside), {}, 0.3, 0.3, PlanContext{});
  ASSERT_EQ(once.size(), 1U);
  EXPECT_NEAR(length_mm(once[0]), 10.2, 0.7);
}

}  // namespace
}  // namespace routebench
