#pragma once
/// Polylines and rings with fewer points.

#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Some of the points of a polyline, its ends among them, such that the others lie within
/// tolerance_mm of the line that they make.
/// Source   D. Douglas and T. Peucker, 1973.  Cost   n log n typical, n^2 at worst.
[[nodiscard]] std::vector<Point2> simplified(const std::vector<Point2>& points,
                                             double tolerance_mm);

/// The same for a ring, which may lose all area, and then has less than three points. Which points
/// are kept does not depend on where the ring begins, if it visits its smallest point once.
[[nodiscard]] Ring simplified_ring(Ring ring, double tolerance_mm);

/// A ring without points where it runs straight on: the others lie within tolerance_mm of the sides
/// left. As simplified_ring but for the way: in one pass, from the ring's farthest point to the
/// right, which is the one that it may not visit twice.
/// Source   C. Williams, 1978 (cones).  Cost   linear.
[[nodiscard]] Ring straightened_ring(const Ring& ring, double tolerance_mm);

}  // namespace routebench
