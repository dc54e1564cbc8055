#pragma once
/// Ways round holes: shortest paths that do not leave an area.

#include <optional>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// Answers which way is the shortest from one point of an area to another without leaving it.
/// Immutable after construction; queries are const and safe from any thread.
class InsidePaths {
 public:
  /// Cost   linear in vertices.
  explicit InsidePaths(const Polygons& polygons);

  /// The shortest polyline from a to b inside the polygons; running along their boundary is inside.
  /// It does not bend in a point where the area only touches itself.
  ///
  /// Returns its points, a and b included; nothing if there is none, that is if a and b do not lie
  ///         in the same polygon.
  /// Cost    constant where b is in sight of a; else, with k corners in the ellipse around a and b
  ///         whose points are no farther from both than twice the way, O(k^2).
  /// Source  visibility graph of the corners that point inwards, T. Lozano-Perez and M. Wesley,
  ///         1979; only edges that touch their corners without entering them are kept.
  [[nodiscard]] std::optional<std::vector<Point2>> shortest(Point2 a, Point2 b) const;

 private:
  /// A vertex where a path may bend: the area has more than half a turn there.
  struct Corner {
    Point2 before, at, after;
  };
  struct Room {
    EdgeGrid edges;
    Box2 box;
    std::vector<Corner> corners;
  };
  /// The shortest way that bends at the given corners only.
  [[nodiscard]] static std::vector<Point2> shortest_over(const std::vector<Corner>& corners,
                                                         const EdgeGrid& edges, Point2 a, Point2 b);

  std::vector<Room> rooms_;  // one a polygon
};

}  // namespace routebench
