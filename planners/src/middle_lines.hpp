#pragma once
/// Lines along the middle of a narrow polygon.

#include <optional>
#include <utility>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/planning/centre_lines.hpp"

namespace routebench {

/// How far places in a narrow part are from what is taken along its sides.
class Room {
 public:
  /// Many places ask how far they are from it.
  struct Edge {
    Point2 from;
    Point2 way;
    double shares_a_mm2;  ///< of the way, for its product with another vector

    Edge(Point2 a, Point2 b);
    [[nodiscard]] double squared_distance(Point2 p) const;
  };
  /// Edges along which as much is taken: in a list if they are few, else in a grid.
  struct Side {
    double taken_mm;
    std::vector<Edge> edges;
    std::optional<EdgeGrid> grid;
  };

  explicit Room(std::vector<Side> sides) : sides_(std::move(sides)) {}

  /// Nothing if it is more than limit_mm, which is not beyond what the room was made for.
  [[nodiscard]] std::optional<double> radius_mm(Point2 p, double limit_mm) const;

 private:
  std::vector<Side> sides_;
};

/// The rooms of many parts between the same sides.
class Rooms {
 public:
  /// Takes  sides that outlive it, and for how many parts it will be asked.
  Rooms(const TakenSides& sides, std::size_t parts);

  /// The room of one part, until the next one is asked for.
  /// Takes  a box around all places that will be asked for, and the greatest radius of interest.
  /// Cost   linear in all edges for each of a few parts; of many parts, once for all of them.
  [[nodiscard]] const Room& around(const Box2& places, double farthest_mm);

 private:
  const TakenSides& sides_;
  bool are_few_;
  std::optional<Room> near_;
  std::optional<Room> everywhere_;  // once it is needed
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
