#pragma once
/// Whether a polygon is narrow anywhere, found without any offset.

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Whether two sides of a polygon that run opposite ways, within 60 degrees, come nearer than
/// width_mm to each other across the inside, at least apart_mm from each other along the boundary
/// or on different rings. A part narrower than that and at least apart_mm long has such sides; so
/// have others, such as a long acute corner.
/// Cost   O(n log n) in points at most, linear where nothing is narrow; each of a few points
///        is looked at with each.
[[nodiscard]] bool has_near_sides(const Polygon& polygon, double width_mm, double apart_mm);

}  // namespace routebench
