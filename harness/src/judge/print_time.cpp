#include "judge/print_time.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

/// A move shorter than this after a turn slighter than this (45 degrees) is a piece of a curve.
constexpr double kShortMoveMm = 1;
constexpr double kSlightTurnCos = std::numbers::sqrt2 / 2;

/// A move as the look-ahead sees it. Speeds are squared: (mm/s)^2.
struct Leg {
  double length_mm = 0;
  double top2 = 0;    ///< nominal speed
  double entry2 = 0;  ///< as fast as it may begin
  bool extrudes = false;
};

/// Speed at which two moves may meet, squared; see print_time.
double junction2(Point2 before, Point2 after, const Printer& printer) {
  const double lengths = std::sqrt(dot(before, before) * dot(after, after));
  // cos t = -cos(turn); sin^2(t/2) = (1 - cos t) / 2.
  const double cos_turn = std::clamp(dot(before, after) / lengths, -1.0, 1.0);
  const double sin_half = std::sqrt((1 + cos_turn) / 2);
  if (sin_half >= 1) return std::numeric_limits<double>::infinity();
  const double corner2 = printer.accel_mm_s2 * printer.junction_mm * sin_half / (1 - sin_half);
  const double after_mm = std::sqrt(dot(after, after));
  if (after_mm >= kShortMoveMm || cos_turn <= kSlightTurnCos) return corner2;
  return std::min(corner2, printer.accel_mm_s2 * after_mm / std::acos(cos_turn));
}

/// Time from one speed to another over a leg.
double leg_time(const Leg& leg, double entry2, double exit2, double accel) {
  const double peak2 = std::min(leg.top2, accel * leg.length_mm + (entry2 + exit2) / 2);
  const double peak = std::sqrt(peak2);
  const double ramps_mm = (2 * peak2 - entry2 - exit2) / (2 * accel);
  return (2 * peak - std::sqrt(entry2) - std::sqrt(exit2)) / accel +
         std::max(0.0, leg.length_mm - ramps_mm) / peak;
}

}  // namespace

PrintTime print_time(const std::vector<Move>& moves, const Printer& printer) {
  PrintTime time;
  std::vector<Leg> legs;
  Point2 before{};
  bool standing = true;
  for (const Move& move : moves) {
    const Point2 way = move.to - move.from;
    if (move.retracted)
      time.retract_s +=
          2 * (printer.retract_mm / printer.retract_mm_s + printer.lift_mm / printer.travel_mm_s);
    standing = standing || move.retracted;
    if (way != Point2{}) {
      const double top = move.extrudes ? printer.extrude_mm_s : printer.travel_mm_s;
      Leg leg{std::sqrt(dot(way, way)), top * top, 0, move.extrudes};
      if (!standing)
        leg.entry2 = std::min({leg.top2, legs.back().top2, junction2(before, way, printer)});
      legs.push_back(leg);
      before = way;
      standing = false;
    }
    standing = standing || move.retracted;
  }

  double next2 = 0;  // the last leg ends at rest
  for (std::size_t i = legs.size(); i-- > 0;) {
    legs[i].entry2 = std::min(legs[i].entry2, next2 + 2 * printer.accel_mm_s2 * legs[i].length_mm);
    next2 = legs[i].entry2;
  }
  for (std::size_t i = 0; i < legs.size(); ++i) {
    double exit2 = 0;
    if (i + 1 < legs.size()) {
      Leg& next = legs[i + 1];
      next.entry2 =
          std::min(next.entry2, legs[i].entry2 + 2 * printer.accel_mm_s2 * legs[i].length_mm);
      exit2 = next.entry2;
    }
    (legs[i].extrudes ? time.extrude_s : time.travel_s) +=
        leg_time(legs[i], legs[i].entry2, exit2, printer.accel_mm_s2);
  }
  return time;
}

}  // namespace routebench::judging
