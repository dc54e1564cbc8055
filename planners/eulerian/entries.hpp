#pragma once
/// The order of strokes of which some are closed.

#include <vector>

#include "routebench/planning/planner.hpp"

namespace routebench::eulerian {

/// Puts strokes in greedy order: from `start`, and then from where the last one ended, to the
/// nearest place at which one that is left can begin. A closed stroke begins, and ends, at any of
/// its points; an open one at either end. Cost   near linear in points.
[[nodiscard]] std::vector<Stroke> nearest_entry_first(std::vector<Stroke> strokes, Point2 start,
                                                      const PlanContext& context);

}  // namespace routebench::eulerian
