#include "slicing/slivers.hpp"

#include <cmath>

#include "routebench/geometry/region.hpp"

namespace routebench::slicing {

Polygons without_slivers(Polygons polygons, double width_mm) {
  const auto is_sliver = [&](const Ring& ring) {
    return 2 * std::abs(signed_area_mm2(ring)) <= width_mm * perimeter_mm(ring);
  };
  std::erase_if(polygons, [&](const Polygon& polygon) { return is_sliver(polygon.outer); });
  for (Polygon& polygon : polygons) std::erase_if(polygon.holes, is_sliver);
  return polygons;
}

}  // namespace routebench::slicing
