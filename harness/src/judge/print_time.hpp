#pragma once
/// How long a printer takes for moves: the look-ahead model of common firmware.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/harness/task.hpp"

namespace routebench::judging {

/// A straight move. Moves follow one another: each begins where the one before ended.
struct Move {
  Point2 from;
  Point2 to;
  bool extrudes = false;
  bool retracted = false;  ///< a travel with the filament pulled back before it and pushed after it
};

struct PrintTime {
  double extrude_s = 0;
  double travel_s = 0;
  double retract_s = 0;
};

/// Time of a chain of moves that begins and ends at rest.
///
/// Every move has the nominal speed v of its kind (extruding or travelling) and the acceleration a.
/// - Junctions. Where two moves meet at the angle t between the way back and the way on, the nozzle
///   may be as fast as it could run round an arc that leaves the corner by the junction deviation
///   d:
///       v_j^2 = a d sin(t/2) / (1 - sin(t/2)),
///   unbounded straight on (t = 180 degrees), zero for a reversal (t = 0), and no more than the
///   nominal speed of either move. Moves of different kinds meet in the same way.
/// - Curves. Where a straight stretch shorter than 1 mm meets another at a turn by u < 45 degrees,
///   both are taken for pieces of an arc of the radius L/u, L being the shorter one's length, which
///   the acceleration lets be run through with no more than
///       v_j^2 = a L / u.
///   Moves that turn by less than 1e-4 are one stretch, so cutting a line into pieces changes
///   nothing.
/// - Jerk, if the printer has one, in the place of both (Marlin's classic rule): from rest and to
///   rest a move may have the speed j at once; where two moves meet, no axis may change its speed
///   by more than j, an axis that reverses being counted by the larger part alone.
/// - Look-ahead. A move of length L that begins with speed v0 can end with no more than v1 with
///   v1^2 = v0^2 + 2 a L; what the moves after one allow is carried backwards by the same law, then
///   what those before it allow forwards.
/// - Trapezoid. The move climbs to its peak, v_p^2 = min(v^2, a L + (v0^2 + v1^2) / 2), stays there
///   and falls to v1: (2 v_p - v0 - v1) / a + (L - (2 v_p^2 - v0^2 - v1^2) / (2 a)) / v_p.
/// - Retraction. The nozzle stands still before and after a retracted travel, each time for
///   retract_mm / retract_mm_s + lift_mm / travel_mm_s.
///
/// Moves of no length take no time; a retraction is paid for nevertheless.
/// Cost   linear.
/// Source the planners of Grbl and Marlin (junction deviation: S. K. Jeon, 2011; curves:
/// Marlin 2.0, there by the length of the later move alone).
[[nodiscard]] PrintTime print_time(const std::vector<Move>& moves, const Printer& printer);

}  // namespace routebench::judging
