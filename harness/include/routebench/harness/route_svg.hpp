#pragma once
/// A layer's route as a picture.

#include <iosfwd>
#include <optional>

#include "routebench/geometry/types.hpp"
#include "routebench/harness/contender.hpp"

namespace routebench {

/// Writes one SVG document: the material, above it the strokes as wide as they are laid in groups
/// `wall`, `dense` and `sparse` (data-stroke gives the place in the route), the travels in a group
/// and a colour of their own, a round mark where the route begins and a square one where it ends.
/// Millimetres, y upwards; coordinates keep every digit that the grid needs.
///
/// Takes  where the nozzle came from, if the way to the first stroke is to be drawn too.
void write_route_svg(std::ostream& out, const Layer& layer, const PlannedLayer& planned,
                     std::optional<Point2> entered_from = std::nullopt);

}  // namespace routebench
