#pragma once
/// More triangles for the same surface.

#include <cstddef>

#include "routebench/geometry/types.hpp"

namespace routebench::shapes {

/// Cuts every triangle into parts x parts of the same form. Neighbours stay joined: a point on an
/// edge is computed from the edge alone.
[[nodiscard]] Mesh subdivide(const Mesh& mesh, std::size_t parts);

/// subdivide() with the number of parts that comes nearest to a count of triangles.
[[nodiscard]] Mesh subdivide_to(const Mesh& mesh, std::size_t triangles);

}  // namespace routebench::shapes
