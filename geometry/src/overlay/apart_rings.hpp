#pragma once
/// What rings bound that meet nowhere: nothing has to be cut.

#include <cstddef>
#include <optional>
#include <vector>

#include "overlay/grid_rings.hpp"
#include "overlay/overlay.hpp"

namespace routebench::overlay {

/// Steps a point that rings may be looked at among each other: to cut them is faster than more.
inline constexpr std::size_t kStepsPerPoint = 32;

/// More rings than these are cut sooner than they are looked at each with each.
inline constexpr std::size_t kMostApart = 24;

/// The faces of rings that meet nowhere. Nothing if that takes too long; see kStepsPerPoint.
/// Cost  that of each point with each ring whose box holds it.
[[nodiscard]] std::optional<std::vector<GridPolygon>> faces_apart(const GridRings& rings,
                                                                  Inside inside);

/// What rings bound that meet nowhere and have the inside to their left: outer rings
/// counter-clockwise, holes clockwise. Nothing if that takes too long; see kStepsPerPoint.
/// Cost  that of each hole with each outer ring whose box holds it.
[[nodiscard]] std::optional<std::vector<GridPolygon>> faces_within(const GridRings& rings);

/// Takes points away that lie on the line between their neighbours; all if nothing else is left.
void drop_straight_points(GridRing& ring);

}  // namespace routebench::overlay
