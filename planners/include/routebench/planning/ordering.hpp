#pragma once
/// The order in which strokes are laid.

#include <vector>

#include "routebench/planning/planner.hpp"

namespace routebench {

/// Puts strokes in greedy order: from `start`, and then from each stroke's end, to the nearest end
/// of a stroke that is left; it is laid from there, turned round if need be. Of equally near ends
/// the one that came first, its first end before its last. Cost   near linear (see NearestGrid).
[[nodiscard]] std::vector<Stroke> nearest_first(std::vector<Stroke> strokes, Point2 start,
                                                const PlanContext& context);

}  // namespace routebench
