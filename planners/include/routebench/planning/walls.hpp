#pragma once
/// Centre lines of walls.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/centre_lines.hpp"
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

/// What `count` walls leave open: of each in turn the sides of what lies between its centre line
/// and what comes before it, the outline or a wall, and what these two take of it. What lies inside
/// the last wall is none of it, and nothing is open where a wall just follows what comes before.
///
/// Takes   polygons and their wall_regions, fewer than `count` if no more fit.
/// Returns of each wall the sides near each place where it does not follow, cut off along a box
///         farther away. A wall's place is half a spacing wide, but towards the outline all that
///         its bead reaches.
/// Cost    linear.
[[nodiscard]] std::vector<std::vector<TakenSides>> wall_gaps(const Polygons& polygons,
                                                             const std::vector<Polygons>& regions,
                                                             int count, const PlanContext& context);

/// Lines along the middle of wall_gaps, each as wide as its gap, from narrowest_line_mm to
/// widest_mm. Those between walls overlap with them as much as walls do with each other.
[[nodiscard]] std::vector<Stroke> gap_lines(const Polygons& polygons,
                                            const std::vector<Polygons>& regions, int count,
                                            double widest_mm, const PlanContext& context);

/// No narrower line is laid in a gap: a third of a line width.
[[nodiscard]] double narrowest_line_mm(const PlanContext& context);

/// Width of what a wall leaves open inside itself, if its region is a strip throughout and that is
/// too narrow for the narrowest line; else 0. A wall half as much wider, a quarter of it further
/// in, leaves nothing.
[[nodiscard]] double left_inside_mm(const Polygon& region, const PlanContext& context);

/// A wall's region without the strips that one line serves better than a wall there and back: parts
/// narrower than near_mm, in which the amount of material of a line in the middle, as wide as the
/// strip and the wall's reach on both sides, is nearer to what is needed than that of the wall. A
/// wall there and back is too much in a long strip; in a short one a line lacks its ends.
///
/// Takes   what a wall's centre line encloses, and how far the wall reaches beyond its centre line.
/// Cost    linear where nothing is narrow; else two offsets and two Boolean operations there.
[[nodiscard]] Polygons without_strips(Polygons region, double reach_mm, double near_mm,
                                      const PlanContext& context);

/// A wall's region without its scraps: parts narrower than near_mm that are short only because
/// what they lie in is hardly wider than the wall's reach on both sides, here and there. One line
/// that runs on through all of that place serves them better than a wall there and back round each.
/// Scraps in places too short for a line stay.
///
/// Takes   what a wall's centre line encloses, what comes before it (the outline or a wall), and
///         how far the wall reaches beyond its centre line.
/// Cost    linear where no part is narrow; else an offset and a Boolean operation.
[[nodiscard]] Polygons without_scraps(Polygons region, const Polygons& before, double reach_mm,
                                      double near_mm, const PlanContext& context);

/// All rings of polygons: each outer one followed by its holes.
[[nodiscard]] std::vector<Ring> rings_of(const Polygons& polygons);

}  // namespace routebench
