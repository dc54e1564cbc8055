#include "routebench/harness/demand.hpp"

#include <algorithm>
#include <utility>

#include "routebench/geometry/region.hpp"

namespace routebench {
namespace {

constexpr int kWallsAtOnce = 2;

bool meet(const Box2& a, const Box2& b) {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
         b.lower.y <= a.upper.y;
}

/// What skins leave of each polygon: of most of them all, so that there is nothing to clip.
Polygons rest_of(const Polygons& inside, const Polygons& dense) {
  if (dense.empty()) return inside;
  std::vector<Box2> boxes;
  for (const Polygon& skin : dense) boxes.push_back(bounding_box(skin));
  Polygons rest;
  for (const Polygon& polygon : inside) {
    const Box2 box = bounding_box(polygon);
    Polygons near;
    for (std::size_t i = 0; i < dense.size(); ++i)
      if (meet(box, boxes[i])) near.push_back(dense[i]);
    for (Polygon& piece : subtract({polygon}, near)) rest.push_back(std::move(piece));
  }
  return rest;
}

}  // namespace

Polygons inside_of(const Layer& layer, const Task& task) {
  const double spacing_mm = task.spacing_mm();
  Polygons inside;
  for (const Polygon& polygon : layer.polygons)
    if (!fits_between_lines(polygon.outer, 2 * task.perimeters * spacing_mm))
      inside.push_back(polygon);
  // A few walls at a time: an offset by many widths at once is far slower.
  for (int wall = 0; wall < task.perimeters && !inside.empty(); wall += kWallsAtOnce)
    inside = offset(inside, -spacing_mm * std::min(kWallsAtOnce, task.perimeters - wall));
  return inside;
}

Demand demand_of(const Layer& layer, const Task& task) {
  return demand_of(layer, task, inside_of(layer, task),
                   [&](const Polygons& inside) { return intersect(inside, layer.solid); });
}

Demand demand_of(const Layer& layer, const Task& task, Polygons inside,
                 const std::function<Polygons(const Polygons& inside)>& skins_in) {
  Demand demand{.outline = layer.polygons, .inside = std::move(inside), .dense = {}, .sparse = {}};
  if (task.density >= 1) {
    demand.dense = demand.inside;
    return demand;
  }
  demand.dense = without_thin_parts(skins_in(demand.inside), task.line_width_mm);
  demand.sparse = rest_of(demand.inside, demand.dense);
  return demand;
}

}  // namespace routebench
