#pragma once
/// One number that tells whether two meshes are the same solid surface, bit for bit.

#include <cstdint>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Depends on the coordinates and directions of the triangles; neither on their order nor on the
/// order of the vertices nor on the corner at which a triangle starts.
[[nodiscard]] std::uint64_t content_hash(const Mesh& mesh, const ParallelFor& parallel_for);

}  // namespace routebench::models
