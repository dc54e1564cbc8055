/// Hand-computed rulers for every metric.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "random_polygons.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/judge.hpp"
#include "routes.hpp"

namespace routebench {
namespace {

using std::numbers::pi;
using test::rectangle;

Layer layer_of(Polygons polygons) {
  Layer layer;
  layer.height_mm = 0.2;
  layer.polygons = std::move(polygons);
  return layer;
}

Task task_without_walls() {
  Task task;
  task.perimeters = 0;
  return task;
}

/// A layer, a task, a route, and one value of its score.
struct Bench {
  Layer layer = layer_of({{rectangle(0, 0, 20, 10), {}}});
  Task task = task_without_walls();
  Printer printer;
  std::optional<Point2> previous_end;

  [[nodiscard]] LayerScore score(const Route& route) const {
    return Judge(task, printer).score(layer, demand_of(layer, task), route, previous_end);
  }
  [[nodiscard]] std::optional<double> measure(std::string_view metric, const Route& route) const {
    return score(route).scores.at(metric_index(metric));
  }
};

Stroke line(std::vector<Point2> points, double width = 0.45) { return {std::move(points), width}; }

TEST(JudgeRuler, LengthsAndCountsOfAHandMadeRoute) {
  Bench bench;
  bench.previous_end = Point2{0, 5};
  // Entry 3 mm; a stroke of 10 mm; a gap of 0.008 mm; one of 5 mm; a gap of 4 mm; one of 2 + 2 mm.
  const Route route{{line({{3, 5}, {13, 5}}), line({{13.008, 5}, {18.008, 5}}),
                     line({{18.008, 9}, {16.008, 9}, {16.008, 7}})}};
  EXPECT_NEAR(*bench.measure("extrude_mm", route), 19, 1e-9);
  EXPECT_NEAR(*bench.measure("entry_travel_mm", route), 3, 1e-9);
  EXPECT_NEAR(*bench.measure("travel_mm", route), 3 + 4, 1e-9);
  EXPECT_EQ(*bench.measure("travels", route), 2);
  EXPECT_NEAR(*bench.measure("max_travel_mm", route), 4, 1e-9);
  EXPECT_EQ(*bench.measure("strokes", route), 2);
  EXPECT_EQ(*bench.measure("crossings", route), 0);
  EXPECT_EQ(*bench.measure("travel_outside_mm", route), 0);
  EXPECT_EQ(*bench.measure("retractions", route), 2);
  bench.printer.retract_over_mm = 3.5;
  EXPECT_EQ(*bench.measure("retractions", route), 1);
  EXPECT_EQ(bench.score(route).end, (Point2{16.008, 7}));
}

TEST(JudgeRuler, TheFirstLayerHasNoEntryAndAnEmptyOneNoEnd) {
  Bench bench;
  const Route route{{line({{3, 5}, {13, 5}})}};
  EXPECT_EQ(*bench.measure("travel_mm", route), 0);
  EXPECT_EQ(*bench.measure("entry_travel_mm", route), 0);
  EXPECT_EQ(*bench.measure("travels", route), 0);
  bench.previous_end = Point2{1, 1};
  EXPECT_EQ(bench.score({}).end, std::nullopt);
  EXPECT_EQ(*bench.measure("travel_mm", {}), 0);
  EXPECT_EQ(*bench.measure("print_time_s", {}), 0);
  EXPECT_EQ(*bench.measure("strokes", {}), 0);
}

TEST(JudgeRuler, AnEntryUpToAJointIsLengthButNoTravel) {
  Bench bench;
  bench.previous_end = Point2{2.995, 5};
  bench.printer.retract_over_mm = 0;
  const Route route{{line({{3, 5}, {13, 5}})}};
  EXPECT_NEAR(*bench.measure("entry_travel_mm", route), 0.005, 1e-12);
  EXPECT_NEAR(*bench.measure("travel_mm", route), 0.005, 1e-12);
  EXPECT_EQ(*bench.measure("travels", route), 0);
  EXPECT_EQ(*bench.measure("retractions", route), 0);
  EXPECT_EQ(*bench.measure("print_retract_s", route), 0);
}

TEST(JudgeRuler, TravelsThatLeaveThePolygons) {
  Bench bench;
  // A hole from x = 8 to 12 and y = 2 to 8.
  Ring hole = rectangle(8, 2, 12, 8);
  std::ranges::reverse(hole);
  bench.layer = layer_of({{rectangle(0, 0, 20, 10), {hole}}});
  // Across the hole: 4 mm outside. Along its edge: none. Round the corner of the box: 2 sqrt 2.
  const Route across{{line({{1, 5}, {5, 5}}), line({{15, 5}, {19, 5}})}};
  EXPECT_EQ(*bench.measure("crossings", across), 1);
  EXPECT_NEAR(*bench.measure("travel_outside_mm", across), 4, 1e-9);
  const Route along{{line({{1, 5}, {5, 8}}), line({{15, 8}, {19, 5}})}};
  EXPECT_EQ(*bench.measure("crossings", along), 0);
  EXPECT_EQ(*bench.measure("travel_outside_mm", along), 0);
  bench.previous_end = Point2{-2, 1};
  const Route entered{{line({{1, 1}, {5, 1}})}};
  EXPECT_EQ(*bench.measure("crossings", entered), 1);
  EXPECT_NEAR(*bench.measure("travel_outside_mm", entered), 2, 1e-9);
}

TEST(JudgeRuler, RetractionPolicies) {
  Printer printer;
  printer.retract_over_mm = 5;
  const Point2 from{1, 1};
  // 3-4-5: length 5, |dx| + |dy| = 7.
  EXPECT_TRUE(retracts(printer, from, {4, 5}, 0));
  EXPECT_FALSE(retracts(printer, from, {4, 4.99}, 0));
  printer.retract_policy = RetractPolicy::kManhattan;
  EXPECT_TRUE(retracts(printer, from, {3, 4}, 0));
  EXPECT_FALSE(retracts(printer, from, {3, 3.99}, 9));
  printer.retract_policy = RetractPolicy::kLengthAndCrossing;
  EXPECT_TRUE(retracts(printer, from, {4, 5}, 0.1));
  EXPECT_FALSE(retracts(printer, from, {4, 5}, 0));
  EXPECT_FALSE(retracts(printer, from, {4, 4.99}, 0.1));
}

TEST(JudgeRuler, VolumeIsLengthTimesTheBeadsSection) {
  Bench bench;
  bench.task.layer_height_mm = 0.2;
  const auto section = [](double w, double h) { return (w - h) * h + pi * h * h / 4; };
  const Route route{{line({{1, 1}, {11, 1}}), line({{1, 3}, {6, 3}}, 0.6)}};
  EXPECT_NEAR(*bench.measure("filament_mm3", route),
              10 * section(0.45, 0.2) + 5 * section(0.6, 0.2), 1e-9);
  // Narrower than high: an ellipse.
  EXPECT_NEAR(*bench.measure("filament_mm3", {{line({{1, 1}, {11, 1}}, 0.1)}}),
              10 * pi / 4 * 0.1 * 0.2, 1e-9);
}

TEST(JudgeRuler, DepositIsTheVolumeOverTheDemand) {
  Bench bench;
  bench.task.density = 0.25;
  const Route route{{line({{1, 1}, {11, 1}})}};
  const double laid = 10 * bench.task.bead_section_mm2();
  EXPECT_NEAR(*bench.measure("deposit", route), laid / (0.25 * 200 * 0.2), 1e-9);
  // One wall of one spacing s: 200 - (20 - 2 s)(10 - 2 s) at full density.
  bench.task.perimeters = 1;
  const double s = bench.task.spacing_mm();
  const double inside = (20 - 2 * s) * (10 - 2 * s);
  EXPECT_NEAR(*bench.measure("deposit", route), laid / ((200 - inside + 0.25 * inside) * 0.2),
              1e-6);
  // Half of it skin.
  bench.layer.solid = {{rectangle(0, 0, 10, 10), {}}};
  EXPECT_NEAR(*bench.measure("deposit", route),
              laid / ((200 - inside + 0.5 * inside + 0.125 * inside) * 0.2), 1e-6);
  // Nothing is demanded: no share of it.
  bench.task.perimeters = 0;
  bench.task.density = 0;
  bench.layer.solid.clear();
  EXPECT_EQ(bench.measure("deposit", route), std::nullopt);
}

TEST(JudgeRuler, OneBeadCoversACapsule) {
  Bench bench;
  bench.task.density = 1;
  const Route route{{line({{5, 5}, {15, 5}}, 0.8)}};
  const double capsule = 10 * 0.8 + pi * 0.4 * 0.4;
  EXPECT_NEAR(*bench.measure("covered", route), capsule / 200, 5e-5);
  // Sparse: everything within one line distance.
  bench.task.density = 0.2;
  const double reach = bench.task.spacing_mm() / 0.2;
  EXPECT_NEAR(*bench.measure("covered", route), (10 * 2 * reach + pi * reach * reach) / 200, 2e-3);
  // To be left empty: nothing is missing.
  bench.task.density = 0;
  EXPECT_EQ(*bench.measure("covered", {}), 1);
}

TEST(JudgeRuler, WallsAndSkinsAreCoveredByBeadsOnlyTheRestByReach) {
  Bench bench;
  bench.task.perimeters = 2;
  bench.task.density = 0.2;
  const double inside = area_mm2(demand_of(bench.layer, bench.task).inside);
  // A line through the middle: reaches 2 mm of the sparse part, none of the walls.
  const Route route{{line({{5, 5}, {15, 5}})}};
  const double reach = bench.task.spacing_mm() / 0.2;
  EXPECT_NEAR(*bench.measure("covered", route), (10 * 2 * reach + pi * reach * reach) / 200, 2e-3);
  bench.layer.solid = bench.layer.polygons;
  EXPECT_NEAR(*bench.measure("covered", route), (10 * 0.45 + pi * 0.225 * 0.225) / 200, 5e-5);
  // At density 0 all but the sparse part counts.
  bench.layer.solid.clear();
  bench.task.density = 0;
  EXPECT_NEAR(*bench.measure("covered", {}), inside / 200, 1e-4);
}

/// Doubled area of one stroke in mm2.
double doubled_mm2(const std::vector<Point2>& points, double width = 0.6) {
  return 200 * *Bench{}.measure("doubled", {{line(points, width)}});
}

TEST(JudgeRuler, DoubledByASecondStroke) {
  const Bench bench;
  const double m = bench.task.mean_width_mm(0.6);
  // Over itself, all of the capsule; crossing at a right angle, a square; side by side at their
  // spacing, nothing.
  const Stroke stroke = line({{4, 5}, {16, 5}}, 0.6);
  EXPECT_NEAR(200 * *bench.measure("doubled", {{stroke, stroke}}), 12 * m + pi * m * m / 4, 0.01);
  EXPECT_NEAR(200 * *bench.measure("doubled", {{stroke, line({{9, 2}, {9, 8}}, 0.6)}}), m * m,
              0.01);
  EXPECT_NEAR(200 * *bench.measure("doubled", {{stroke, line({{4, 5 + m}, {16, 5 + m}}, 0.6)}}), 0,
              1e-9);
  // Half a spacing apart: half of each.
  const Stroke half = line({{4, 5 + m / 2}, {16, 5 + m / 2}}, 0.6);
  const double lens = m * m / 4 * (2 * pi / 3 - std::sqrt(3) / 2);  // of the two end discs
  EXPECT_NEAR(200 * *bench.measure("doubled", {{stroke, half}}), 12 * m / 2 + lens, 0.01);
}

/// What both legs of a corner reach on their own, without the disc round its point: two
/// right-angled triangles less a sector.
double corner_mm2(double turn, double mean_width) {
  return mean_width * mean_width / 4 * (std::tan(turn / 2) - turn / 2);
}

TEST(JudgeRuler, DoubledByAStrokeThatComesBack) {
  const Bench bench;
  const double m = bench.task.mean_width_mm(0.6);
  // A hairpin over itself: all of its way back but the disc at the turn, which is passed once.
  EXPECT_NEAR(doubled_mm2({{4, 5}, {16, 5}, {5, 5}}), 11 * m, 0.01);
  // In many pieces the same.
  std::vector<Point2> pieces;
  for (int i = 0; i <= 120; ++i) pieces.push_back({4 + 0.1 * i, 5});
  for (int i = 119; i >= 10; --i) pieces.push_back({4 + 0.1 * i, 5});
  EXPECT_NEAR(doubled_mm2(pieces), 11 * m, 0.01);
  // Back to where it began it is a loop: the disc there is passed once, too.
  EXPECT_NEAR(doubled_mm2({{4, 5}, {16, 5}, {4, 5}}), 12 * m - pi * m * m / 4, 0.01);
  // A hairpin with its legs a spacing apart.
  EXPECT_NEAR(doubled_mm2({{4, 5}, {16, 5}, {16, 5 + m}, {4, 5 + m}}), 2 * corner_mm2(pi / 2, m),
              0.005);
  // An eight crosses itself once, at a right angle.
  EXPECT_NEAR(doubled_mm2({{4, 2}, {10, 8}, {14, 8}, {14, 2}, {10, 2}, {4, 8}}),
              m * m + 2 * corner_mm2(pi / 2, m) + 2 * corner_mm2(pi / 4, m), 0.01);
}

TEST(JudgeRuler, ACornerIsOnePass) {
  const Bench bench;
  const double m = bench.task.mean_width_mm(0.6);
  // Straight on, in pieces of any length.
  EXPECT_NEAR(doubled_mm2({{4, 5}, {4.01, 5}, {10, 5}, {10.3, 5}, {16, 5}}), 0, 1e-9);
  // A right angle: the tip of the inner side is reached by both legs on their own.
  EXPECT_NEAR(doubled_mm2({{4, 2}, {12, 2}, {12, 8}}), corner_mm2(pi / 2, m), 0.002);
  EXPECT_NEAR(doubled_mm2({{4, 2}, {12, 2}, {9, 8}}), corner_mm2(std::atan2(6, -3), m), 0.01);
  // A smooth curve: nothing to speak of.
  std::vector<Point2> arc;
  for (int i = 0; i <= 90; ++i)
    arc.push_back({10 + 4 * std::cos(pi * i / 90), 3 + 4 * std::sin(pi * i / 90)});
  EXPECT_NEAR(doubled_mm2(arc), 0, 0.002);
}

TEST(JudgeRuler, ALoopMeetsItselfInOnePass) {
  std::vector<Point2> circle;
  for (int i = 0; i < 180; ++i)
    circle.push_back({10 + 3 * std::cos(pi * i / 90), 5 + 3 * std::sin(pi * i / 90)});
  circle.push_back(circle.front());
  EXPECT_NEAR(doubled_mm2(circle), 0, 0.004);
  // Twice round: all of it twice.
  std::vector<Point2> twice = circle;
  twice.insert(twice.end(), circle.begin() + 1, circle.end());
  const double m = Bench{}.task.mean_width_mm(0.6);
  EXPECT_NEAR(doubled_mm2(twice), 2 * pi * 3 * m, 0.02);
}

TEST(JudgeRuler, APerfectSpiralFillsOnceThePathTwiceTwice) {
  Bench bench;
  bench.task.density = 1;
  bench.layer = layer_of({{rectangle(0, 0, 10, 10), {}}});
  const double w = bench.task.line_width_mm;
  const double s = bench.task.spacing_mm();
  std::vector<Point2> spiral{{w / 2, w / 2}};
  double low = w / 2;
  for (double high = 10 - w / 2; high > low; high -= s) {
    spiral.push_back({high, low});
    spiral.push_back({high, high});
    spiral.push_back({low, high});
    spiral.push_back({low, low + s});
    low += s;
    spiral.push_back({low, low});
  }
  spiral.resize(spiral.size() - 2);
  const Stroke stroke = line(spiral);
  EXPECT_LT(*bench.measure("doubled", {{stroke}}), 0.005);
  EXPECT_GT(*bench.measure("covered", {{stroke}}), 0.98);
  EXPECT_NEAR(*bench.measure("deposit", {{stroke}}), 1, 0.05);
  EXPECT_NEAR(*bench.measure("doubled", {{stroke, stroke}}), 0.98, 0.02);
  EXPECT_NEAR(*bench.measure("deposit", {{stroke, stroke}}),
              2 * *bench.measure("deposit", {{stroke}}), 1e-12);
}

TEST(JudgeRuler, SpilledIsWhatLiesMoreThanHalfALineOutside) {
  const Bench bench;
  // On the outline: half of the bead is outside, none of it too far.
  EXPECT_NEAR(*bench.measure("spilled", {{line({{5, 0}, {15, 0}})}}), 0, 1e-9);
  // Half a line and more outside. The bead's inner rim touches the outline's tolerance.
  EXPECT_NEAR(200 * *bench.measure("spilled", {{line({{5, -0.45}, {15, -0.45}})}}),
              10 * 0.45 + pi * 0.225 * 0.225, 0.005);
  // Centre line a quarter of a line outside: half of that.
  const double lens_free = 10 * 0.225 + pi * 0.225 * 0.225 / 2;
  EXPECT_NEAR(200 * *bench.measure("spilled", {{line({{5, -0.225}, {15, -0.225}})}}), lens_free,
              0.005);
  // Far away, beyond all samples.
  EXPECT_NEAR(200 * *bench.measure("spilled", {{line({{500, -400}, {500, -300}})}}), 45, 1e-6);
  EXPECT_NEAR(200 * *bench.measure("spilled", {{line({{10, 5}, {10, 1e8}})}}), 45e6, 1e3);
}

TEST(JudgeRuler, OutlineCovered) {
  Bench bench;
  // Walls along the lower and the left side, 0.225 mm inside: 20 + 10 of 60 mm, and a little round
  // their ends: within 0.45 mm, that is sqrt(0.45^2 - 0.225^2) further along.
  const double further = std::sqrt(0.45 * 0.45 - 0.225 * 0.225);
  const Route route{{line({{5, 0.225}, {15, 0.225}}), line({{0.225, 2}, {0.225, 8}})}};
  EXPECT_NEAR(*bench.measure("outline_covered", route), (10 + 6 + 4 * further) / 60, 0.1 / 60);
  EXPECT_EQ(*bench.measure("outline_covered", {}), 0);
  // Further in than a line's width: not covered.
  EXPECT_EQ(*bench.measure("outline_covered", {{line({{5, 0.451}, {15, 0.451}})}}), 0);
  // Holes count.
  Ring hole = rectangle(8, 2, 12, 8);
  std::ranges::reverse(hole);
  bench.layer = layer_of({{rectangle(0, 0, 20, 10), {hole}}});
  const Route both = test::loops(offset(bench.layer.polygons, -0.225), 0.45);
  EXPECT_NEAR(*bench.measure("outline_covered", both), 1, 1e-12);
  EXPECT_NEAR(*bench.measure("outline_covered", {{both.strokes.front()}}), 60.0 / 80, 1e-3);
}

TEST(JudgeRuler, SkippedOnLayersOfMetresIsWhatIsLeftOut) {
  // Samples there are farther apart than lines.
  for (const double size_mm : {1000.0, 1500.0, 2200.0}) {
    Bench bench;
    bench.task.density = 1;
    bench.layer = layer_of({{rectangle(0, 0, size_mm, size_mm), {}}});
    const double spacing_mm = bench.task.spacing_mm();
    Route all, most;
    for (double y = spacing_mm / 2; y < size_mm; y += spacing_mm) {
      all.strokes.push_back(line({{spacing_mm / 2, y}, {size_mm - spacing_mm / 2, y}}));
      if (y < 0.6 * size_mm || y > 0.65 * size_mm) most.strokes.push_back(all.strokes.back());
    }
    EXPECT_EQ(*bench.measure("skipped", all), 0) << size_mm;
    EXPECT_NEAR(*bench.measure("skipped", most), 0.05, 0.003) << size_mm;
  }
}

TEST(JudgeRuler, HollowIsTheCentreLineOutside) {
  const Bench bench;
  EXPECT_EQ(*bench.measure("hollow_mm", {{line({{0, 0}, {20, 0}, {20, 10}})}}), 0);
  EXPECT_NEAR(*bench.measure("hollow_mm", {{line({{-3, 5}, {23, 5}, {23, 7}})}}), 3 + 3 + 2, 1e-9);
}

TEST(JudgeRuler, SharpTurns) {
  const Bench bench;
  // 90 degrees is not sharp, a reversal is, 135 is; a duplicate point changes nothing; the point
  // where a loop closes is not inside.
  EXPECT_EQ(*bench.measure("sharp_turns", {{line({{1, 1}, {5, 1}, {5, 5}})}}), 0);
  EXPECT_EQ(*bench.measure("sharp_turns", {{line({{1, 1}, {5, 1}, {5, 1}, {1, 1}})}}), 1);
  EXPECT_EQ(*bench.measure("sharp_turns", {{line({{1, 1}, {5, 1}, {3, 3}, {1, 1}})}}), 1);
  EXPECT_EQ(*bench.measure("sharp_turns", {{line({{1, 1}, {5, 1}, {3, 1.5}, {5, 2}})}}), 2);
  // Two strokes that meet are one.
  EXPECT_EQ(*bench.measure("sharp_turns", {{line({{1, 1}, {5, 1}}), line({{5, 1}, {2, 1.5}})}}), 1);
  EXPECT_EQ(*bench.measure("sharp_turns", {{line({{1, 1}, {5, 1}}), line({{5.5, 1}, {2, 1.5}})}}),
            0);
}

TEST(JudgeRuler, PrintTimeIsThatOfEntryStrokesAndTravels) {
  Bench bench;
  bench.previous_end = Point2{0, 5};
  bench.printer = {.retract_over_mm = 5,
                   .retract_mm = 1,
                   .retract_mm_s = 50,
                   .extrude_mm_s = 100,
                   .travel_mm_s = 100,
                   .accel_mm_s2 = 1e7};  // so that ramps take no time to speak of
  const Route route{{line({{3, 5}, {13, 5}}), line({{13, 9}, {3, 9}}), line({{13, 9}, {13, 5}})}};
  EXPECT_NEAR(*bench.measure("print_extrude_s", route), 0.24, 1e-3);
  EXPECT_NEAR(*bench.measure("print_travel_s", route), 0.17, 1e-3);
  EXPECT_NEAR(*bench.measure("print_retract_s", route), 2 * 1.0 / 50, 1e-12);
  EXPECT_NEAR(*bench.measure("print_time_s", route),
              *bench.measure("print_extrude_s", route) + *bench.measure("print_travel_s", route) +
                  *bench.measure("print_retract_s", route),
              1e-12);
}

TEST(JudgeRuler, WhatDoesNotApplyIsAbsent) {
  Bench bench;
  bench.layer = layer_of({});
  const Route stray{{line({{1, 1}, {5, 1}})}};
  for (const std::string_view share :
       {"covered", "skipped", "doubled", "spilled", "deposit", "outline_covered", "worst_layer"})
    EXPECT_EQ(bench.measure(share, stray), std::nullopt) << share;
  for (const std::string_view planning : {"plan_wall_ns", "plan_cpu_ns", "peak_rss_bytes"})
    EXPECT_EQ(bench.measure(planning, stray), std::nullopt);
  EXPECT_EQ(*bench.measure("hollow_mm", stray), 4);
  EXPECT_EQ(*bench.measure("extrude_mm", stray), 4);
}

TEST(JudgeRuler, StrokesThatAreNoneAreRefusedByPlace) {
  const Bench bench;
  const double nan = std::nan("");
  for (const Stroke& bad : {line({}), line({{1, 1}, {nan, 1}}), line({{1, 1}, {1, HUGE_VAL}}),
                            line({{1, 1}, {1, 1e10}}), line({{1, 1}, {2, 2}}, 0),
                            line({{1, 1}, {2, 2}}, -1), line({{1, 1}, {2, 2}}, nan)}) {
    try {
      static_cast<void>(bench.score({{line({{1, 1}, {2, 1}}), bad}}));
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_NE(std::string_view(error.what()).find("stroke 1 "), std::string_view::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace routebench
