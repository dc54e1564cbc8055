#pragma once
/// From meshes of a file's parts to that of the file.

#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Welds exactly welded parts, whose vertices are in order of first appearance, to what one
/// VertexWelder would have made of all their triangles: the same numbers, whatever the parts.
///
/// Takes  parts without negative zeros. The corners of all triangles together must stay below 2^32.
/// Cost   linear in vertices and triangles.
[[nodiscard]] Mesh join_parts(std::vector<Mesh> parts, const ParallelFor& parallel_for);

}  // namespace routebench::models
