#pragma once
/// Ways along a ring.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// A place on a ring: on the edge from vertex `edge` to the next one.
struct RingPlace {
  std::uint32_t edge = 0;
  Point2 point;
};

/// True if `a` comes before `b` for one who goes along the ring from its first vertex.
[[nodiscard]] bool comes_before(const Ring& ring, const RingPlace& a, const RingPlace& b);

/// The way from one place to another in the ring's direction: both places and the vertices between,
/// no point twice in a row. From a place to itself it is once round. Cost   linear in its vertices.
[[nodiscard]] std::vector<Point2> path_along(const Ring& ring, const RingPlace& from,
                                             const RingPlace& to);

/// A place on a ring and how far it is from the point that asked for it.
struct NearPlace {
  RingPlace place;
  double distance_mm = 0;
};
/// The place of a ring that is nearest to p. Cost   linear.
[[nodiscard]] NearPlace nearest_place(const Ring& ring, Point2 p);

/// Some places of a ring, spread along it.
[[nodiscard]] std::vector<RingPlace> spread_places(const Ring& ring, std::size_t count);

/// How near two rings come, seen from some places of `from`.
[[nodiscard]] double distance_of(const Ring& from, const Ring& to);

/// Length of a polyline, mm.
[[nodiscard]] double length_mm(const std::vector<Point2>& points);

}  // namespace routebench
