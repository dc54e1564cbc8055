#pragma once
/// Between routebench's polygons and the overlay's grid. One grid step is one unit, so nothing is
/// lost.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "overlay/grid_rings.hpp"
#include "overlay/overlay.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::overlay {

/// Takes rings to the grid. Its calls return false if a ring does not fit.
class ToGrid {
 public:
  /// Coordinates must be as far as this from the grid's ends.
  explicit ToGrid(double margin_mm = 0,
                  std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : most_units_(kMaxUnits - margin_mm * kGridUnitsPerMm), rings_(memory) {}

  [[nodiscard]] bool add(const Polygons& polygons, Winding winding) {
    return std::all_of(polygons.begin(), polygons.end(),
                       [&](const Polygon& polygon) { return add(polygon, winding); });
  }

  [[nodiscard]] bool add(const Polygon& polygon, Winding winding) {
    return add(polygon.outer, winding) &&
           std::all_of(polygon.holes.begin(), polygon.holes.end(),
                       [&](const Ring& hole) { return add(hole, winding); });
  }

  [[nodiscard]] bool add(const Ring& ring, Winding winding) {
    rings_.begin_ring(winding);
    rings_.make_room(ring.size());
    for (const Point2 p : ring) {
      const double x = p.x * kGridUnitsPerMm, y = p.y * kGridUnitsPerMm;
      if (!(std::abs(x) < most_units_ && std::abs(y) < most_units_)) return false;
      rings_.add({nearest(x), nearest(y)});
    }
    rings_.end_ring();
    return true;
  }

  /// So far; rings of fewer than three places are none.
  [[nodiscard]] std::uint32_t rings() const { return rings_.rings(); }
  [[nodiscard]] GridRings take() { return std::move(rings_); }

 private:
  /// Nearly all are whole; to round the others is a call on plain processors.
  static std::int32_t nearest(double units) {
    const auto whole = static_cast<std::int32_t>(units);
    return static_cast<double>(whole) == units ? whole
                                               : static_cast<std::int32_t>(std::lrint(units));
  }

  double most_units_;
  GridRings rings_;
};

/// Polygons in canonical form: every ring begins at its lexicographically smallest point, holes and
/// polygons are sorted.
[[nodiscard]] Polygons to_polygons(const std::vector<GridPolygon>& faces);

}  // namespace routebench::overlay
