#pragma once
/// A cheap proof that an inset lost nothing.

#include "routebench/geometry/types.hpp"

namespace routebench {

/// True if it is sure that an area's inset grows back to the area: no part is narrower than twice
/// the distance, but for short stubs. Every ring of the area is followed on the inset: where that
/// is farther away than the distance and the corner there let one expect, nothing is proven. Takes
/// polygons, offset(area, -distance_mm), and how much farther than expected the inset may
///         be: the depth of stubs of no interest, or for little of it half its square over the
///         distance. Offsets are true to 5 um.
/// Cost    linear in points and in length over distance.
[[nodiscard]] bool grows_back(const Polygons& inset, const Polygons& area, double distance_mm,
                              double slack_mm);

}  // namespace routebench
