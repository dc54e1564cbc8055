#include "routebench/planning/walls.hpp"

#include <utility>

#include "routebench/geometry/region.hpp"

namespace routebench {

std::vector<Polygons> wall_regions(const Polygon& island, const PlanContext& context) {
  std::vector<Polygons> regions;
  double step_mm = context.line_width_mm / 2;
  for (int wall = 0; wall < context.perimeters; ++wall) {
    stop_if_asked(context);
    // One wall at a time: an offset by many widths at once is far slower, and in narrow places
    // another region.
    Polygons inner =
        regions.empty() ? offset({island}, -step_mm) : offset(regions.back(), -step_mm);
    if (inner.empty()) break;
    regions.push_back(std::move(inner));
    step_mm = context.spacing_mm;
  }
  return regions;
}

std::vector<Ring> rings_of(const Polygons& polygons) {
  std::vector<Ring> rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

}  // namespace routebench
