#pragma once
/// Centre lines of walls.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

/// What the centre lines of walls enclose, from the outermost wall inwards: the first lies half a
/// line width inside the polygon, each further one a spacing inside the one before, until nothing
/// is left or context.perimeters are there. Takes   an island in any frame.
[[nodiscard]] std::vector<Polygons> wall_regions(const Polygon& island, const PlanContext& context);

/// What walls leave open between them and before them: parts of the island narrower than a line,
/// and strips between walls in which no further one fits. What lies inside the innermost of
/// context.perimeters walls is none of it.
///
/// Takes   an island and its wall_regions.
/// Returns polygons, with slivers of a few micrometres among them.
/// Cost    linear where nothing is narrow; else two offsets a wall and one Boolean operation.
[[nodiscard]] Polygons wall_gaps(const Polygon& island, const std::vector<Polygons>& regions,
                                 const PlanContext& context);

/// All rings of polygons: each outer one followed by its holes.
[[nodiscard]] std::vector<Ring> rings_of(const Polygons& polygons);

}  // namespace routebench
