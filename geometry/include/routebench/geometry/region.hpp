#pragma once
/// Areas: measures, offsets and Booleans of polygons with holes, exact to the grid.

#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

[[nodiscard]] double signed_area_mm2(const Ring& ring);  ///< positive if counter-clockwise
[[nodiscard]] double area_mm2(const Polygon& polygon);
[[nodiscard]] double area_mm2(const Polygons& polygons);
[[nodiscard]] double perimeter_mm(const Ring& ring);
[[nodiscard]] double perimeter_mm(const Polygon& polygon);  ///< outer ring and holes
[[nodiscard]] double perimeter_mm(const Polygons& polygons);

struct Box2 {
  Point2 lower;
  Point2 upper;
};
/// Smallest box around two.
[[nodiscard]] Box2 around(const Box2& a, const Box2& b);
/// Smallest box around all points; lower > upper if there are none.
[[nodiscard]] Box2 bounding_box(const Ring& ring);
[[nodiscard]] Box2 bounding_box(const Polygon& polygon);
[[nodiscard]] Box2 bounding_box(const Polygons& polygons);

/// Which winding numbers are inside.
enum class FillRule { kNonZero, kEvenOdd, kPositive };

/// Polygons that directed rings enclose. Rings may cross, overlap and repeat. The result is
/// canonical: it does not depend on the order of the rings or on where each begins.
[[nodiscard]] Polygons polygons_from_rings(std::vector<Ring> rings, FillRule rule);

enum class Join { kMiter, kRound };

/// Grows (distance > 0) or shrinks (distance < 0) polygons by |distance_mm|. The result is cleaned:
/// some of its points that stay within 5 um of the sides left are taken out (see simplify.hpp).
/// Without that, repeated offsets lose area.
/// Cost   O(n log n) typical.
[[nodiscard]] Polygons offset(const Polygons& polygons, double distance_mm,
                              Join join = Join::kMiter);

/// The same of what directed rings enclose, the inside to their left, in whatever order. Each of
/// them moves by its own distance, all outwards or all inwards.
[[nodiscard]] Polygons offset_boundary(const std::vector<Ring>& rings,
                                       const std::vector<double>& distances_mm);

/// Whether a ring has room between two parallel lines so far apart: then nothing is left of it when
/// its boundary moves inwards by half of that, in however many steps. Says no rather than look at
/// every direction.
/// Takes  at least one point.
/// Cost   linear in points, far less than to move the boundary.
[[nodiscard]] bool fits_between_lines(const Ring& ring, double apart_mm);

/// What is left of polygons after everything narrower than width_mm is taken away (opening: shrink,
/// then grow, cut to the original). What is left reaches 15 um into the narrow parts, and its other
/// sides are the original ones to the unit.
[[nodiscard]] Polygons without_thin_parts(const Polygons& polygons, double width_mm);

[[nodiscard]] Polygons unite(const Polygons& a, const Polygons& b);
[[nodiscard]] Polygons intersect(const Polygons& a, const Polygons& b);
[[nodiscard]] Polygons subtract(const Polygons& a, const Polygons& b);

}  // namespace routebench
