#pragma once
/// What is left when polygons grow or shrink.

#include <optional>
#include <span>
#include <vector>

#include "overlay/overlay.hpp"

namespace routebench::overlay {

/// Moves each ring of the boundary of polygons outwards by its own of the `distances`, in units
/// (all inwards if negative). Corners that
/// the move pulls apart become mitres, or are cut off squarely at the distance where a mitre would
/// be longer than twice the distance. The result is cleaned of points nearer than `clean` units to
/// their neighbours' line.
///
/// Takes   rings as overlay returns them: the inside lies to their left.
/// Returns nothing if the rings cannot be cut; see PlanarEdges.
/// Cost    about linear where edges are spread evenly.
[[nodiscard]] std::optional<std::vector<GridPolygon>> offset_rings(
    const GridRings& rings, std::span<const double> distances, double clean);

}  // namespace routebench::overlay
