#pragma once
/// Strokes as the nozzle sees them: those that meet are one.

#include <cstddef>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::judging {

/// Material laid without a stop. Consecutive points differ.
struct Run {
  std::vector<Point2> points;
  /// Of the bead from points[i] to points[i + 1]; 0 where the run only steps over a gap.
  std::vector<double> widths_mm;
  bool loop = false;  ///< ends where it begins
};

/// The runs of a route: strokes whose gap is no longer than join_mm are one run. So nothing that is
/// measured on runs depends on where a planner cuts its strokes. What is no longer than join_mm
/// from gap to gap is left out: it lays nothing, and must neither divide a travel into short ones
/// nor bridge it by steps that are no gaps.
///
/// Throws Error{kBadInput} naming the first stroke that cannot be judged: one without points, with
/// a
///        coordinate that is not a number below 10^9 mm, or with a width that is not positive.
[[nodiscard]] std::vector<Run> runs_of(const Route& route, double join_mm);

/// Calls visit(a, b, width_mm) for every bead.
template <typename Visit>
void visit_beads(const std::vector<Run>& runs, Visit&& visit) {
  for (const Run& run : runs)
    for (std::size_t i = 0; i < run.widths_mm.size(); ++i)
      if (run.widths_mm[i] > 0) visit(run.points[i], run.points[i + 1], run.widths_mm[i]);
}

/// Vertices inside runs at which the direction turns by more than 90 degrees. The point at which a
/// loop closes is not inside.
[[nodiscard]] std::size_t sharp_turns(const std::vector<Run>& runs);

}  // namespace routebench::judging
