#include "judge/print_time.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

/// A stretch shorter than this beside a turn slighter than this (45 degrees) is a piece of a curve.
constexpr double kShortStretchMm = 1;
constexpr double kSlightTurnCos = std::numbers::sqrt2 / 2;
/// Turns slighter than this are none: where a straight line was cut on the grid, say.
constexpr double kStraightSin = 1e-4;

/// A move as the look-ahead sees it. Speeds are squared: (mm/s)^2.
struct Leg {
  Point2 way;
  double length_mm = 0;
  double straight_mm = 0;  ///< of the straight stretch that it is a part of
  bool from_rest = false;
  double top2 = 0;    ///< nominal speed
  double entry2 = 0;  ///< as fast as it may begin
  bool extrudes = false;
};

bool goes_straight_on(const Leg& before, const Leg& after) {
  return !after.from_rest && dot(before.way, after.way) > 0 &&
         std::abs(cross(before.way, after.way)) < kStraightSin * before.length_mm * after.length_mm;
}

void measure_stretches(std::vector<Leg>& legs) {
  for (std::size_t begin = 0, end = 0; begin < legs.size(); begin = end) {
    double length_mm = legs[begin].length_mm;
    for (end = begin + 1; end < legs.size() && goes_straight_on(legs[end - 1], legs[end]); ++end)
      length_mm += legs[end].length_mm;
    for (std::size_t i = begin; i < end; ++i) legs[i].straight_mm = length_mm;
  }
}

/// Speed at which two moves of no more than a top speed may meet, squared; see print_time.
double junction2(const Leg& before, const Leg& after, double top2, const Printer& printer) {
  // cos t = -cos(turn); sin^2(t/2) = (1 - cos t) / 2.
  const double cos_turn =
      std::clamp(dot(before.way, after.way) / (before.length_mm * after.length_mm), -1.0, 1.0);
  const double sin_half = std::sqrt((1 + cos_turn) / 2);
  if (sin_half >= 1) return top2;
  const double corner2 =
      std::min(top2, printer.accel_mm_s2 * printer.junction_mm * sin_half / (1 - sin_half));
  const double stretch_mm = std::min(before.straight_mm, after.straight_mm);
  if (stretch_mm >= kShortStretchMm || cos_turn <= kSlightTurnCos ||
      goes_straight_on(before, after))
    return corner2;
  // A turn u <= 45 degrees has u^2 < 2.11 (1 - cos u): mostly that tells that the curve allows
  // more.
  constexpr double kTurn2 = 2.2;
  const double pull = printer.accel_mm_s2 * stretch_mm;
  if (pull * pull > kTurn2 * (1 - cos_turn) * (corner2 * corner2)) return corner2;
  return std::min(corner2, pull / std::acos(cos_turn));
}

/// The change of speed of one axis between two moves. One that reverses stops on the way, so it
/// changes by the larger part alone.
double axis_change(double before, double after) {
  return before * after > 0 ? std::abs(after - before)
                            : std::max(std::abs(before), std::abs(after));
}

/// As junction2, by the jerk of each axis; both moves are as fast as the slower one may be.
double jerk_junction2(const Leg& before, const Leg& after, double top2, double jerk_mm_s) {
  const double top = std::sqrt(top2);
  const Point2 exit = (top / before.length_mm) * before.way;
  const Point2 entry = (top / after.length_mm) * after.way;
  const double change = std::max(axis_change(exit.x, entry.x), axis_change(exit.y, entry.y));
  const double share = change > jerk_mm_s ? jerk_mm_s / change : 1;
  return top2 * share * share;
}

struct Speed {
  double mm_s = 0;
  double square = 0;
};

/// Time from one speed to another over a leg.
double leg_time(const Leg& leg, Speed entry, Speed exit, double accel) {
  const double peak2 = std::min(leg.top2, accel * leg.length_mm + (entry.square + exit.square) / 2);
  const double peak = std::sqrt(peak2);
  const double ramps_mm = (2 * peak2 - entry.square - exit.square) / (2 * accel);
  return (2 * peak - entry.mm_s - exit.mm_s) / accel +
         std::max(0.0, leg.length_mm - ramps_mm) / peak;
}

}  // namespace

PrintTime print_time(const std::vector<Move>& moves, const Printer& printer) {
  PrintTime time;
  std::vector<Leg> legs;
  legs.reserve(moves.size());
  bool standing = true;
  const double jerk2 = printer.jerk_mm_s * printer.jerk_mm_s;
  for (const Move& move : moves) {
    const Point2 way = move.to - move.from;
    if (move.retracted)
      time.retract_s +=
          2 * (printer.retract_mm / printer.retract_mm_s + printer.lift_mm / printer.travel_mm_s);
    standing = standing || move.retracted;
    if (way != Point2{}) {
      const double top = move.extrudes ? printer.extrude_mm_s : printer.travel_mm_s;
      legs.push_back({way, std::sqrt(dot(way, way)), 0, standing, top * top, 0, move.extrudes});
      standing = false;
    }
    standing = standing || move.retracted;
  }

  measure_stretches(legs);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    Leg& leg = legs[i];
    const double slower2 = i == 0 ? leg.top2 : std::min(leg.top2, legs[i - 1].top2);
    leg.entry2 = std::min(slower2, jerk2);
    if (leg.from_rest) continue;
    leg.entry2 = jerk2 > 0 ? std::max(leg.entry2,
                                      jerk_junction2(legs[i - 1], leg, slower2, printer.jerk_mm_s))
                           : junction2(legs[i - 1], leg, slower2, printer);
  }

  const double last2 = legs.empty() ? 0 : std::min(legs.back().top2, jerk2);
  double next2 = last2;
  for (std::size_t i = legs.size(); i-- > 0;) {
    legs[i].entry2 = std::min(legs[i].entry2, next2 + 2 * printer.accel_mm_s2 * legs[i].length_mm);
    next2 = legs[i].entry2;
  }
  const auto speed = [](double square) { return Speed{std::sqrt(square), square}; };
  Speed entry = speed(legs.empty() ? 0 : legs.front().entry2);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Leg& leg = legs[i];
    const double allowed2 = i + 1 < legs.size() ? legs[i + 1].entry2 : last2;
    const Speed exit =
        speed(std::min(allowed2, entry.square + 2 * printer.accel_mm_s2 * leg.length_mm));
    (leg.extrudes ? time.extrude_s : time.travel_s) +=
        leg_time(leg, entry, exit, printer.accel_mm_s2);
    entry = exit;
  }
  return time;
}

}  // namespace routebench::judging
