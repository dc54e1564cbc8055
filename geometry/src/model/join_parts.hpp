#pragma once
/// From parts of a file to the whole.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/vertex_welder.hpp"
#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Exactly welded facets of a part of a file; vertices in order of first appearance, without
/// negative zeros.
struct WeldedPart {
  std::vector<FloatPoint> vertices;
  std::span<std::array<std::uint32_t, 3>> triangles;
};

/// Welds parts to what one VertexWelder would have made of all their triangles: the same numbers,
/// whatever the parts. Returns the vertices of all; the parts' triangles get their numbers, and the
/// parts lose their vertices.
///
/// Takes  parts whose triangles' corners all together stay below 2^32.
/// Cost   linear in vertices and triangles.
[[nodiscard]] std::vector<Point3> join_parts(std::span<WeldedPart> parts,
                                             const ParallelFor& parallel_for);

}  // namespace routebench::models
