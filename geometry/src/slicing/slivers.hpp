#pragma once
/// What rounding and mending leave behind: areas too narrow to mean anything.

#include "routebench/geometry/types.hpp"

namespace routebench::slicing {

/// Areas narrower than this mean nothing: the walls of two bodies that share a face meet within the
/// rounding of files and of the grid, and where they do not meet exactly they leave slivers.
inline constexpr double kSliverMm = 0.001;

/// Whether a ring is no wider than width_mm on average: a strip's average width is twice its area
/// over its perimeter.
[[nodiscard]] bool is_sliver(const Ring& ring, double width_mm = kSliverMm);

/// A ring without the spikes and notches that are nowhere wider than width_mm: lines there and back
/// again. One that the ring begins in stays. Cost   linear.
[[nodiscard]] Ring without_spikes(const Ring& ring, double width_mm = kSliverMm);

/// Takes away polygons and holes that are slivers.
[[nodiscard]] Polygons without_slivers(Polygons polygons, double width_mm = kSliverMm);

}  // namespace routebench::slicing
