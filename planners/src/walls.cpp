#include "routebench/planning/walls.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/centre_lines.hpp"

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

double grown_area_mm2(const Polygons& polygons, double distance_mm) {
  constexpr double kSharpest = 1.75;  // of half a corner's turn, as a tangent: offsets cut it off
  double area = 0, length = 0, corners = 0;
  for (const Ring& ring : rings_of(polygons)) {
    area += signed_area_mm2(ring);
    length += perimeter_mm(ring);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 in = ring[i] - ring[i == 0 ? ring.size() - 1 : i - 1];
      const Point2 out = ring[i + 1 == ring.size() ? 0 : i + 1] - ring[i];
      // tan(t / 2) = sin t / (1 + cos t) of the turn t
      const double scale = std::sqrt(dot(in, in) * dot(out, out));
      const double tangent = cross(in, out) / (scale + dot(in, out));
      corners += std::isfinite(tangent) ? std::clamp(tangent, -kSharpest, kSharpest) : 0;
    }
  }
  return area + distance_mm * (length + distance_mm * corners);
}

Polygons wall_gaps(const Polygons& polygons, const std::vector<Polygons>& regions, int count,
                   const PlanContext& context) {
  // The least stroke: half as long as a line is wide, and a third as wide.
  const double least_mm2 = context.line_width_mm * context.line_width_mm / 6;
  // Each area holds the next one: what is open before a wall, and what that wall's beads reach. So
  // what lies in an odd number of them is a gap.
  std::vector<Ring> rings;
  const auto add = [&rings](const Polygons& area) {
    for (Ring& ring : rings_of(area)) rings.push_back(std::move(ring));
    return area_mm2(area);
  };
  double gap_mm2 = 0;
  const auto reach_of = [&](std::size_t wall) {
    return (wall == 0 ? context.line_width_mm : context.spacing_mm) / 2;
  };
  for (std::size_t wall = 0; wall <= regions.size() && std::cmp_less(wall, count); ++wall) {
    stop_if_asked(context);
    const Polygons& before = wall == 0 ? polygons : regions[wall - 1];
    const Polygons none;
    const Polygons& region = wall < regions.size() ? regions[wall] : none;
    // Where nothing is narrow, the wall's place grows back to where it came from.
    const double step_mm = wall == 0 ? reach_of(0) : context.spacing_mm;
    if (area_mm2(before) - grown_area_mm2(region, step_mm) < least_mm2) continue;
    gap_mm2 += add(wall == 0 ? before : offset(before, -reach_of(wall)));
    gap_mm2 -= add(offset(region, reach_of(wall)));
  }
  if (gap_mm2 < least_mm2) return {};
  return polygons_from_rings(std::move(rings), FillRule::kEvenOdd);
}

std::vector<Stroke> gap_lines(const Polygons& polygons, const std::vector<Polygons>& regions,
                              int count, double widest_mm, const PlanContext& context) {
  const double narrowest_mm = context.line_width_mm / 3;  // less is left to what beads spread
  return centre_lines(wall_gaps(polygons, regions, count, context),
                      {.min_width_mm = narrowest_mm,
                       .max_width_mm = widest_mm,
                       .min_length_mm = context.line_width_mm / 2,
                       .width = CentreLineWidth::kInscribed},
                      context);
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
