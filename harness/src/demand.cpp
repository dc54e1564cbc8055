#include "routebench/harness/demand.hpp"

#include <utility>

#include "routebench/geometry/region.hpp"

namespace routebench {

Polygons inside_of(const Layer& layer, const Task& task) {
  Polygons inside = layer.polygons;
  // One wall at a time, as walls are laid: an offset by many widths at once is far slower and, in
  // narrow places, another region.
  for (int wall = 0; wall < task.perimeters && !inside.empty(); ++wall)
    inside = offset(inside, -task.spacing_mm());
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
  demand.sparse = subtract(demand.inside, demand.dense);
  return demand;
}

}  // namespace routebench
