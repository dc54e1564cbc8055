#pragma once
/// From rings as they stand in a file to polygons as routebench means them.

#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::layer_files {

/// Largest coordinate that a layer file may hold, mm: beyond it there is no room on the grid.
inline constexpr double kMaxCoordinateMm = 1e6;

/// Puts a closed line on the grid. Points that repeat their neighbour go, so does the closing one.
/// The result has fewer than three points if the line has no extent.
[[nodiscard]] Ring read_ring(const std::vector<Point2>& points);

struct SoundPolygons {
  Polygons polygons;
  bool as_given;  ///< but for the sense of rings
};

/// Outer rings less their holes, united. Rings may run either way round, cross themselves, overlap
/// and lie outside each other; polygons that are sound already come back as they are, rings turned
/// the right way round.
[[nodiscard]] SoundPolygons sound_polygons(Polygons polygons);

}  // namespace routebench::layer_files
