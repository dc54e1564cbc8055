#pragma once
/// Growing polylines.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::eulerian {

/// Appends a point, unless it is the last one again; the last one goes where it lies on a straight
/// run to the new one.
inline void append_straight(std::vector<Point2>& points, Point2 p) {
  if (!points.empty() && points.back() == p) return;
  if (points.size() >= 2) {
    const Point2 before = points.back() - points[points.size() - 2], after = p - points.back();
    if (cross(before, after) == 0 && dot(before, after) > 0) points.pop_back();
  }
  points.push_back(p);
}

}  // namespace routebench::eulerian
