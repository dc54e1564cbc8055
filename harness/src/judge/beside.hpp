#pragma once
/// Boundaries that beads run along from end to end.

#include <vector>

#include "judge/run.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// True only if all of the polygons' boundary lies within reach_mm of centre lines: then usually,
/// but not always. Walks along each ring and at the same time along the beads beside it, from one
/// bead to its neighbour in the route; a stretch both ends of which are in reach of one bead is so
/// as a whole.
/// Cost linear in the beads and in the boundary's vertices, whatever its length.
[[nodiscard]] bool is_surely_reached(const Polygons& polygons, const std::vector<Run>& runs,
                                     double reach_mm);

}  // namespace routebench::judging
