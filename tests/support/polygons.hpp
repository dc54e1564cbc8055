#pragma once
/// Polygons that ask something of planners.

#include <cmath>

#include "random_polygons.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::test {

/// The same ring, the other way round: a hole.
inline Ring reversed(Ring ring) { return {ring.rbegin(), ring.rend()}; }

/// Regular polygon, counter-clockwise.
inline Ring circle(Point2 centre, double radius_mm, int corners) {
  return star(0, corners, centre, radius_mm, std::nextafter(radius_mm, 2 * radius_mm));
}

}  // namespace routebench::test
