#pragma once
/// Where an inset may have lost something, found without any Boolean operation.

#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// Boxes around all places at which an area's inset may not grow back to the area, because a part
/// is narrower than twice the distance. Every ring of the area is followed on the inset: where that
/// is farther away than the distance and the corner there let one expect, there is doubt.
///
/// Takes   polygons, offset(area, -distance_mm), how much farther than expected the inset may be
///         (the depth of stubs of no interest, or for little of it half its square over the
///         distance; offsets are true to 5 um), and by how much boxes reach beyond such places.
/// Returns disjoint boxes, or one around all of a small area; none proves that nothing was lost.
/// Cost    linear in points and in length over distance.
[[nodiscard]] std::vector<Box2> doubtful_places(const Polygons& inset, const Polygons& area,
                                                double distance_mm, double slack_mm,
                                                double margin_mm);

/// The part of polygons that lies in a box with corners on the grid. Pieces of one ring stay one
/// ring, which runs from piece to piece along the box and there may run over itself and over holes.
/// Cost   linear.
[[nodiscard]] Polygons clipped(const Polygons& polygons, const Box2& box);

}  // namespace routebench
