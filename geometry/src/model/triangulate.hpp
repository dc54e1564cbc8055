#pragma once
/// Polygons into triangles.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Cuts a face of a mesh into triangles that run as the face does and appends them.
///
/// Takes  three or more corners of a polygon that is flat, or nearly, and may be concave; a face
///        with a hole may be joined to it by a bridge that is run both ways.
/// Gives  corners - 2 triangles over no other edges than the face's own and diagonals. A polygon
/// that
///        crosses itself is cut into a fan: the surface stays closed.
/// Cost   O(n log n) for n corners.
void triangulate_face(std::span<const Point3> vertices, std::span<const std::uint32_t> corners,
                      std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Cuts the area between rings into triangles.
///
/// Takes  rings that neither cross nor touch, as indices into points; what lies inside an odd
/// number
///        of them is area.
/// Gives  counter-clockwise triangles over the rings' points.
/// Throws Error{kInternal} if the rings cross.
/// Cost   O(n log n).
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate_area(
    std::span<const Point2> points, std::span<const std::vector<std::uint32_t>> rings);

}  // namespace routebench::models
