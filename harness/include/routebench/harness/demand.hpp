#pragma once
/// How a layer is cut into what has to be walled, filled densely and filled sparsely.

#include <functional>

#include "routebench/geometry/types.hpp"
#include "routebench/harness/task.hpp"

namespace routebench {

/// The regions of one layer under one task. `outline` = walls + dense + sparse, disjoint but for
/// common boundaries.
struct Demand {
  Polygons outline;  ///< the layer's polygons
  Polygons inside;   ///< what the walls leave: outline shrunk by perimeters x spacing
  Polygons dense;    ///< of the inside: skins, to be filled at density 1
  Polygons sparse;   ///< of the inside: the rest, to be filled at task.density
  friend bool operator==(const Demand&, const Demand&) = default;
};

/// Cuts a layer. A skin narrower than a line is not a place that can be filled for itself and
/// counts as sparse. At task.density = 1 all of the inside is dense.
[[nodiscard]] Demand demand_of(const Layer& layer, const Task& task);

/// Demand::inside of a layer: what the walls leave.
[[nodiscard]] Polygons inside_of(const Layer& layer, const Task& task);

/// As demand_of above, where inside_of is known already, with skins from elsewhere than
/// Layer::solid: `skins_in` is asked once, for those in the layer's inside.
[[nodiscard]] Demand demand_of(const Layer& layer, const Task& task, Polygons inside,
                               const std::function<Polygons(const Polygons& inside)>& skins_in);

}  // namespace routebench
