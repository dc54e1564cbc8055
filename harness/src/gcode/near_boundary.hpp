#pragma once
/// Which of some points lie near a boundary.

#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// A point and how near is near.
struct NearQuery {
  Point2 point;
  double limit_mm = 0;
};

/// For each query, whether an edge of the polygons comes within its limit. For fewer points than
/// edges this costs less than to build an EdgeGrid: every edge once, with the queries at its
/// height.
[[nodiscard]] std::vector<bool> near_boundary(const Polygons& polygons,
                                              const std::vector<NearQuery>& queries);

}  // namespace routebench
