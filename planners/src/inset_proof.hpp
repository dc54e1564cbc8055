#pragma once
/// A cheap proof that an inset lost nothing.

#include "routebench/geometry/types.hpp"

namespace routebench {

/// True if it is sure that an area's inset grows back to the area: no part is narrower than twice
/// the distance, but for stubs of about a tenth of a millimetre. Every ring of the area is followed
/// on the inset: a place of the boundary that has no inset beside it, as far as the corner there
/// lets one expect, proves nothing.
/// Takes   polygons and offset(area, -distance_mm).
/// Cost    linear in points and in length over distance.
[[nodiscard]] bool grows_back(const Polygons& inset, const Polygons& area, double distance_mm);

}  // namespace routebench
