#pragma once
/// How much of the boundary is followed by strokes.

#include <optional>
#include <vector>

#include "judge/run.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// Share of the boundary, outer rings and holes, that lies within reach_mm of a bead's centre line.
///
/// Returns nothing if there is no boundary.
/// Cost    linear in the boundary's points, 0.1 mm apart or closer (a quarter of the reach; 2^22 of
///         them at most), and in the cells, two reaches wide, that the beads run through.
[[nodiscard]] std::optional<double> outline_covered(const Polygons& polygons,
                                                    const std::vector<Run>& runs, double reach_mm);

}  // namespace routebench::judging
