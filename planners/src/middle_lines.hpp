#pragma once
/// Lines along the middle of a narrow polygon.

#include <optional>
#include <utility>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// How far places in a part of an area are from what is taken along the area's sides.
class Room {
 public:
  /// Takes  the area's rings, a box around all places that will be asked for, how much is taken and
  ///        the greatest radius of interest.
  /// Cost   linear in edges.
  Room(const std::vector<Ring>& rings, const Box2& places, double side_mm, double farthest_mm);

  /// Nothing if it is more than limit_mm, which is not beyond the greatest of interest.
  [[nodiscard]] std::optional<double> radius_mm(Point2 p, double limit_mm) const;

 private:
  std::vector<std::pair<Point2, Point2>> edges_;  // near the places, if they are few
  std::optional<EdgeGrid> grid_;                  // else
  double side_mm_;
};

/// A line along the middle, with the radius of the room at each point.
struct MiddleLine {
  std::vector<Point2> points;  // of a loop the first is repeated
  std::vector<double> radii_mm;
  bool free_front = false;  // no other line begins there
  bool free_back = false;
};

/// The middle of a polygon without its spurs into corners. Lines end where three of them meet, and
/// where the polygon ends.
/// Takes   what is left of a polygon near the origin if its sides move inwards beyond what is taken
///         there by inwards_mm, which has the same middle where it is that wide, and the room in
///         the polygon itself; radii are told up to widest_mm.
[[nodiscard]] std::vector<MiddleLine> middle_lines(const Polygon& core, double inwards_mm,
                                                   const Room& room, double widest_mm);

}  // namespace routebench
