#include "judge/print_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

/// Round figures: 100 mm/s and 200 mm/s, 1000 mm/s2.
Printer round_printer() {
  Printer printer;
  printer.extrude_mm_s = 100;
  printer.travel_mm_s = 200;
  printer.accel_mm_s2 = 1000;
  printer.junction_mm = 0.01;
  printer.retract_mm = 0.8;
  printer.retract_mm_s = 40;
  printer.lift_mm = 0;
  return printer;
}

std::vector<Move> extruding(const std::vector<Point2>& points) {
  std::vector<Move> moves;
  for (std::size_t i = 1; i < points.size(); ++i)
    moves.push_back({points[i - 1], points[i], true, false});
  return moves;
}

double extrude_s(const std::vector<Point2>& points, const Printer& printer = round_printer()) {
  const PrintTime time = print_time(extruding(points), printer);
  EXPECT_EQ(time.travel_s, 0);
  EXPECT_EQ(time.retract_s, 0);
  return time.extrude_s;
}

TEST(PrintTime, ALongMoveIsATrapezoid) {
  // 0.1 s and 5 mm up to 100 mm/s, the same down, 90 mm between at 100 mm/s.
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}}), 0.1 + 0.9 + 0.1, 1e-12);
}

TEST(PrintTime, AShortMoveIsATriangle) {
  // 2 mm up, 2 mm down: each sqrt(2 * 2 / 1000) s.
  EXPECT_NEAR(extrude_s({{1, 1}, {1, 5}}), 2 * std::sqrt(0.004), 1e-12);
}

TEST(PrintTime, StraightOnIsOneMove) {
  EXPECT_NEAR(extrude_s({{0, 0}, {30, 40}, {60, 80}}), extrude_s({{0, 0}, {60, 80}}), 1e-9);
  // In many pieces, too short to reach the speed one by one.
  std::vector<Point2> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({0.1 * i, 0});
  EXPECT_NEAR(extrude_s(points), 1.1, 1e-9);
}

TEST(PrintTime, AReversalIsAStop) {
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}, {0, 0}}), 2 * 1.1, 1e-12);
}

TEST(PrintTime, ARightAngleIsTakenAtTheJunctionSpeed) {
  // t = 90 degrees: sin(t/2) = sqrt(1/2), v_j^2 = 1000 * 0.01 * 2.41421... = 24.1421...
  const double vj2 = 10 * std::sqrt(0.5) / (1 - std::sqrt(0.5));
  const double vj = std::sqrt(vj2);
  // Each leg: ramps between 0 and 100, and between 100 and vj; the rest at 100.
  const double ramps_s = 0.1 + (100 - vj) / 1000;
  const double ramps_mm = 5 + (10000 - vj2) / 2000;
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}, {100, 100}}), 2 * (ramps_s + (100 - ramps_mm) / 100),
              1e-12);
}

TEST(PrintTime, ACurveOfShortMovesIsRunThroughAsItsArc) {
  // Ten turns round a circle of 2 mm in pieces of a degree: v^2 = 1000 * 2. At both ends the nozzle
  // climbs along the curve, to that speed and from it, v^2 = 2 a s.
  constexpr double kRadius = 2;
  std::vector<Point2> points;
  for (int i = 0; i <= 3600; ++i) {
    const double angle = i * std::numbers::pi / 180;
    points.push_back({kRadius * std::cos(angle), kRadius * std::sin(angle)});
  }
  const double piece = 2 * kRadius * std::sin(std::numbers::pi / 360);
  const double speed = std::sqrt(1000 * piece / (std::numbers::pi / 180));
  EXPECT_NEAR(speed, std::sqrt(1000 * kRadius), 0.001);
  const double ramp_mm = speed * speed / 2000;
  const double wanted = 2 * speed / 1000 + (3600 * piece - 2 * ramp_mm) / speed;
  // The speed is bound at the joints alone; between them the nozzle may be a little faster.
  EXPECT_NEAR(extrude_s(points), wanted, 0.02 * wanted);
  EXPECT_LT(extrude_s(points), wanted);
}

/// From one speed to another and further, at 1000 mm/s2 and up to 100 mm/s.
double leg_s(double length_mm, double from, double to) {
  const double ramps_mm = (2 * 100.0 * 100 - from * from - to * to) / 2000;
  return (2 * 100 - from - to) / 1000 + (length_mm - ramps_mm) / 100;
}

TEST(PrintTime, ACurveIsBoundByItsTurnWhateverTheTurn) {
  // A short move between two long ones, by the same turn u from each: v_j^2 is the least of
  // 100^2, a d sin(t/2) / (1 - sin(t/2)) with t = 180 degrees - u, and a L / u.
  std::size_t by_curve = 0;
  for (const double junction_mm : {0.01, 1.0})
    for (const double short_mm : {0.02, 0.3, 0.9})
      for (double turn = 0.002; turn < 0.78; turn *= 1.01) {
        Printer printer = round_printer();
        printer.junction_mm = junction_mm;
        const double sin_half = std::cos(turn / 2);
        const double corner2 = std::min(1e4, 1000 * junction_mm * sin_half / (1 - sin_half));
        const double curve2 = 1000 * short_mm / turn;
        by_curve += curve2 < corner2 ? 1 : 0;
        const double joint = std::sqrt(std::min(corner2, curve2));
        const double peak2 = std::min(1e4, 1000 * short_mm + joint * joint);
        const double ramps_mm = (peak2 - joint * joint) / 1000;
        const double wanted = 2 * leg_s(100, 0, joint) + 2 * (std::sqrt(peak2) - joint) / 1000 +
                              (short_mm - ramps_mm) / std::sqrt(peak2);
        const Point2 a{100, 0};
        const Point2 b = a + short_mm * Point2{std::cos(turn), std::sin(turn)};
        const Point2 c = b + 100 * Point2{std::cos(2 * turn), std::sin(2 * turn)};
        EXPECT_NEAR(extrude_s({{0, 0}, a, b, c}, printer), wanted, 1e-9)
            << junction_mm << ' ' << short_mm << ' ' << turn;
      }
  EXPECT_GT(by_curve, 500U);
}

TEST(PrintTime, ByJerkCornersAndEndsHaveASpeedAtOnce) {
  Printer printer = round_printer();
  printer.jerk_mm_s = 10;
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}}, printer), leg_s(100, 10, 10), 1e-12);
  // A reversal and a right angle along the axes: the axis that stops changes by all it has.
  const double stop = 2 * leg_s(100, 10, 10);
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}, {0, 0}}, printer), stop, 1e-12);
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}, {100, 100}}, printer), stop, 1e-12);
  // The same angle with its sides across: both axes have v / sqrt 2, one keeps it, one reverses.
  const double d = 100 / std::sqrt(2.0);
  const double across = 10 * std::sqrt(2.0);
  EXPECT_NEAR(extrude_s({{0, 0}, {d, d}, {2 * d, 0}}, printer), 2 * leg_s(100, 10, across), 1e-9);
  // By a 3-4-5 angle from the axis: x falls from v to 0.8 v, y rises from 0 to 0.6 v.
  const double slight = 10 / 0.6;
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}, {180, 60}}, printer), 2 * leg_s(100, 10, slight), 1e-9);
  // Straight on there is no corner; a jerk beyond the speed leaves nothing to wait for.
  EXPECT_NEAR(extrude_s({{0, 0}, {40, 0}, {100, 0}}, printer), leg_s(100, 10, 10), 1e-12);
  printer.jerk_mm_s = 1000;
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}, {100, 100}}, printer), 2.0, 1e-12);
}

TEST(PrintTime, ByJerkARetractionStopsTheNozzleAtThatSpeed) {
  Printer printer = round_printer();
  printer.jerk_mm_s = 10;
  std::vector<Move> moves = extruding({{0, 0}, {100, 0}});
  moves.push_back({{100, 0}, {200, 0}, false, true});
  const PrintTime time = print_time(moves, printer);
  EXPECT_NEAR(time.extrude_s, leg_s(100, 10, 10), 1e-12);
  EXPECT_NEAR(time.travel_s, 2 * 190.0 / 1000 + (100 - 2 * (40000 - 100) / 2000.0) / 200, 1e-12);
  EXPECT_NEAR(time.retract_s, 2 * 0.8 / 40, 1e-12);
}

TEST(PrintTime, WhatComesLaterIsSeenInTime) {
  // A move of 0.1 mm before a reversal: the long one before it must already be slow enough to stop.
  const double v2 = 2 * 1000 * 0.1;  // at the joint, straight on: stops within 0.1 mm
  const double first = 0.1 + (100 - std::sqrt(v2)) / 1000 + (100 - 5 - (10000 - v2) / 2000) / 100;
  const double second = std::sqrt(v2) / 1000;
  const double back = 2 * std::sqrt(0.1 / 1000);
  EXPECT_NEAR(extrude_s({{0, 0}, {100, 0}, {100.1, 0}, {100, 0}}), first + second + back, 1e-9);
}

TEST(PrintTime, MovesOfDifferentSpeedBlendAtTheSlowerOne) {
  // 100 mm extruding at 100 mm/s, straight on 100 mm travelling at 200 mm/s.
  std::vector<Move> moves = extruding({{0, 0}, {100, 0}});
  moves.push_back({{100, 0}, {200, 0}, false, false});
  const PrintTime time = print_time(moves, round_printer());
  EXPECT_NEAR(time.extrude_s, 0.1 + 0.95, 1e-12);  // not braked at the end
  // 100 to 200 mm/s: 0.1 s, 15 mm; 200 to 0: 0.2 s, 20 mm; 65 mm at 200 mm/s.
  EXPECT_NEAR(time.travel_s, 0.1 + 0.2 + 65.0 / 200, 1e-12);
}

TEST(PrintTime, ARetractionIsAStopOnBothSides) {
  Printer printer = round_printer();
  printer.lift_mm = 0.4;
  std::vector<Move> moves = extruding({{0, 0}, {100, 0}});
  moves.push_back({{100, 0}, {200, 0}, false, true});
  moves.push_back({{200, 0}, {300, 0}, true, false});
  const PrintTime time = print_time(moves, printer);
  EXPECT_NEAR(time.extrude_s, 2 * 1.1, 1e-12);
  EXPECT_NEAR(time.travel_s, 0.2 + 60.0 / 200 + 0.2, 1e-12);
  EXPECT_NEAR(time.retract_s, 2 * 0.8 / 40 + 2 * 0.4 / 200, 1e-12);
}

TEST(PrintTime, NothingTakesNoTime) {
  for (const std::vector<Move>& moves :
       {std::vector<Move>{}, extruding({{3, 3}, {3, 3}}), extruding({{3, 3}})}) {
    const PrintTime time = print_time(moves, round_printer());
    EXPECT_EQ(time.extrude_s + time.travel_s + time.retract_s, 0);
  }
  // A retraction on the spot is paid for and stops what would run straight on.
  std::vector<Move> moves = extruding({{0, 0}, {100, 0}});
  moves.push_back({{100, 0}, {100, 0}, false, true});
  moves.push_back({{100, 0}, {200, 0}, true, false});
  const PrintTime time = print_time(moves, round_printer());
  EXPECT_NEAR(time.retract_s, 2 * 0.8 / 40, 1e-12);
  EXPECT_NEAR(time.extrude_s, 2 * 1.1, 1e-12);
}

/// Time by small steps along the path: the fastest speed that all laws allow at each place.
double slow_oracle_s(const std::vector<Point2>& points, const Printer& printer, double step_mm) {
  struct Place {
    double allowed2;
  };
  std::vector<Place> places{{0}};
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double length = distance(points[i - 1], points[i]);
    const int steps = static_cast<int>(std::round(length / step_mm));
    EXPECT_NEAR(length, steps * step_mm, 1e-9) << "the oracle wants whole steps";
    const double top2 = printer.extrude_mm_s * printer.extrude_mm_s;
    for (int k = 1; k < steps; ++k) places.push_back({top2});
    if (i + 1 == points.size()) break;
    const Point2 back = points[i - 1] - points[i];
    const Point2 on = points[i + 1] - points[i];
    const double t = std::abs(std::atan2(cross(back, on), dot(back, on)));
    const double s = std::sin(t / 2);
    double allowed2 =
        s >= 1 ? top2 : std::min(top2, printer.accel_mm_s2 * printer.junction_mm * s / (1 - s));
    const double on_mm = std::sqrt(dot(on, on));
    const double turn = std::numbers::pi - t;
    if (on_mm < 1 && turn < std::numbers::pi / 4 && turn > 1e-9)
      allowed2 = std::min(allowed2, printer.accel_mm_s2 * on_mm / turn);
    places.push_back({allowed2});
  }
  places.push_back({0});
  for (std::size_t i = 1; i < places.size(); ++i)
    places[i].allowed2 =
        std::min(places[i].allowed2, places[i - 1].allowed2 + 2 * printer.accel_mm_s2 * step_mm);
  for (std::size_t i = places.size() - 1; i-- > 0;)
    places[i].allowed2 =
        std::min(places[i].allowed2, places[i + 1].allowed2 + 2 * printer.accel_mm_s2 * step_mm);
  double time = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
    time += 2 * step_mm / (std::sqrt(places[i - 1].allowed2) + std::sqrt(places[i].allowed2));
  return time;
}

TEST(PrintTime, AgreesWithSmallStepsAlongThePath) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 20; ++round) {
    // Whole steps along the axes and along 3-4-5 triangles.
    std::vector<Point2> points{{0, 0}};
    for (int i = 0; i < 30; ++i) {
      const double size = 0.1 * static_cast<double>(1 + random() % 40);
      constexpr Point2 kWays[] = {{5, 0}, {0, 5}, {-5, 0}, {3, 4}, {-3, 4}, {4, -3}, {3, -4}};
      points.push_back(points.back() + (size / 5) * kWays[random() % std::size(kWays)]);
    }
    const double exact = extrude_s(points);
    // The oracle's steps round off peaks that lie between two places.
    EXPECT_NEAR(slow_oracle_s(points, round_printer(), 0.001), exact, 2e-3 * exact);
  }
}

}  // namespace
}  // namespace routebench::judging
