#include "gcode/near_boundary.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "routebench/geometry/vec.hpp"

namespace routebench {

std::vector<bool> near_boundary(const Polygons& polygons, const std::vector<NearQuery>& queries) {
  std::vector<bool> near(queries.size(), false);
  std::vector<std::size_t> by_height(queries.size());
  std::iota(by_height.begin(), by_height.end(), std::size_t{0});
  std::sort(by_height.begin(), by_height.end(), [&queries](std::size_t a, std::size_t b) {
    return queries[a].point.y < queries[b].point.y;
  });
  double reach_mm = 0;
  for (const NearQuery& query : queries) reach_mm = std::max(reach_mm, query.limit_mm);

  const auto add_edge = [&](Point2 a, Point2 b) {
    const auto [left, right] = std::minmax(a.x, b.x);
    const auto [lower, upper] = std::minmax(a.y, b.y);
    auto at = std::partition_point(
        by_height.begin(), by_height.end(),
        [&, low = lower - reach_mm](std::size_t i) { return queries[i].point.y < low; });
    for (; at != by_height.end(); ++at) {
      const auto& [p, limit_mm] = queries[*at];
      if (p.y > upper + reach_mm) break;
      if (near[*at] || p.x < left - limit_mm || p.x > right + limit_mm) continue;
      near[*at] = distance(p, nearest_on_segment(p, a, b)) <= limit_mm;
    }
  };
  const auto add_ring = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      add_edge(ring[i == 0 ? ring.size() - 1 : i - 1], ring[i]);
  };
  for (const Polygon& polygon : polygons) {
    add_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) add_ring(hole);
  }
  return near;
}

}  // namespace routebench
