#pragma once
/// Between routebench's polygons and Clipper's integer paths. One grid step is one unit, so nothing
/// is lost.

#include <polyclipping/clipper.hpp>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

[[nodiscard]] inline ClipperLib::IntPoint to_clipper(Point2 p) {
  return {to_grid(p.x), to_grid(p.y)};
}
[[nodiscard]] inline Point2 from_clipper(const ClipperLib::IntPoint& p) {
  return {from_grid(p.X), from_grid(p.Y)};
}
[[nodiscard]] ClipperLib::Path to_clipper(const Ring& ring);
[[nodiscard]] ClipperLib::Paths to_clipper(const Polygons& polygons);

/// Polygons in canonical form: every ring begins at its lexicographically smallest point, holes and
/// polygons are sorted.
[[nodiscard]] Polygons from_clipper(const ClipperLib::PolyTree& tree);

}  // namespace routebench
