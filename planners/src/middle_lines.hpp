#pragma once
/// Lines along the middle of a narrow polygon.

#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// A line along the middle, with its distance from the boundary at each point.
struct MiddleLine {
  std::vector<Point2> points;  // of a loop the first is repeated
  std::vector<double> radii_mm;
  bool free_front = false;  // no other line begins there
  bool free_back = false;
};

/// The middle of a polygon without its spurs into corners. Lines end where three of them meet, and
/// where the polygon ends.
/// Takes   what is left of a polygon near the origin if its sides move inwards by inwards_mm, which
///         has the same middle where it is that wide, and the edges of the polygon itself; distances
///         from these are told up to widest_mm.
[[nodiscard]] std::vector<MiddleLine> middle_lines(const Polygon& core, double inwards_mm,
                                                   const EdgeGrid& edges, double widest_mm);

}  // namespace routebench
