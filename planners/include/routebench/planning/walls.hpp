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

/// All rings of polygons: each outer one followed by its holes.
[[nodiscard]] std::vector<Ring> rings_of(const Polygons& polygons);

}  // namespace routebench
