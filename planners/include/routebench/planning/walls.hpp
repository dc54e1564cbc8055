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

/// Area of polygons grown by distance_mm with pointed corners, as long as no parts of them meet and
/// no holes close. Less than an area whose inset they are says that something narrow was lost; no
/// offset is needed to know. Cost   linear.
[[nodiscard]] double grown_area_mm2(const Polygons& polygons, double distance_mm);

/// What `count` walls leave open before and between them: parts narrower than a line, and strips
/// between walls in which no further one fits. What lies inside the last of them is none of it.
///
/// Takes   polygons and their wall_regions, fewer than `count` if no more fit.
/// Returns polygons, with slivers of a few micrometres among them.
/// Cost    linear where nothing is narrow; else two offsets a wall and one Boolean operation.
[[nodiscard]] Polygons wall_gaps(const Polygons& polygons, const std::vector<Polygons>& regions,
                                 int count, const PlanContext& context);

/// Lines along the middle of wall_gaps, each as wide as its gap: from a third of a line width to
/// widest_mm.
[[nodiscard]] std::vector<Stroke> gap_lines(const Polygons& polygons,
                                            const std::vector<Polygons>& regions, int count,
                                            double widest_mm, const PlanContext& context);

/// All rings of polygons: each outer one followed by its holes.
[[nodiscard]] std::vector<Ring> rings_of(const Polygons& polygons);

}  // namespace routebench
