#include "layer_files/read_polygons.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"

namespace routebench::layer_files {
namespace {

void turn(Ring& ring, bool counter_clockwise) {
  if ((signed_area_mm2(ring) > 0) == counter_clockwise) return;
  std::reverse(ring.begin() + 1, ring.end());  // begins where it began
}

/// What the polygons mean, whatever their rings do.
Polygons meaning(const Polygons& polygons) {
  std::vector<Ring> rings;
  for (const Polygon& polygon : polygons) {
    const Polygons area = subtract(polygons_from_rings({polygon.outer}, FillRule::kNonZero),
                                   polygons_from_rings(polygon.holes, FillRule::kNonZero));
    for (const Polygon& part : area) {
      rings.push_back(part.outer);
      rings.insert(rings.end(), part.holes.begin(), part.holes.end());
    }
  }
  return polygons_from_rings(std::move(rings), FillRule::kNonZero);
}

}  // namespace

Ring read_ring(const std::vector<Point2>& points) {
  Ring ring;
  for (const Point2 p : points) {
    const Point2 on_grid = snap(p);
    if (ring.empty() || ring.back() != on_grid) ring.push_back(on_grid);
  }
  while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
  return ring;
}

SoundPolygons sound_polygons(Polygons polygons) {
  std::erase_if(polygons, [](const Polygon& polygon) { return polygon.outer.size() < 3; });
  for (Polygon& polygon : polygons) {
    std::erase_if(polygon.holes, [](const Ring& hole) { return hole.size() < 3; });
    turn(polygon.outer, true);
    for (Ring& hole : polygon.holes) turn(hole, false);
  }
  // Crossings, overlaps, common stretches and holes in the wrong place all show in area or length.
  Polygons meant = meaning(polygons);
  const double length_mm = perimeter_mm(polygons);
  const double tolerance = 8 / kGridUnitsPerMm * (1 + length_mm);
  const bool sound = std::abs(area_mm2(meant) - area_mm2(polygons)) <= tolerance &&
                     std::abs(perimeter_mm(meant) - length_mm) <= tolerance;
  return {sound ? std::move(polygons) : std::move(meant), sound};
}

}  // namespace routebench::layer_files
