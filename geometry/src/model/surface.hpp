#pragma once
/// How the triangles of a mesh hang together.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "large_vector.hpp"
#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Counts of a surface and its parts.
///
/// Triangles that share an edge with nobody else are one *patch*. A *shell* is a patch that closes
/// alone, or several that need each other at edges with three or more triangles: two cubes that
/// touch along an edge are two shells, two rooms with a wall between them are one.
struct Surface {
  std::size_t open_edges = 0;          ///< with one triangle
  std::size_t non_manifold_edges = 0;  ///< with three or more
  std::size_t flipped_triangles = 0;   ///< in the minority of their patch
  std::size_t components = 0;          ///< pieces joined by edges
  std::size_t copies_along = 0;        ///< triangles that are there already, running the same way
  std::size_t copies_against = 0;      ///< triangles that are there already, only the other way
  /// Edges that are not run through equally often both ways once the flipped triangles are turned:
  /// 0 says that every cut through the surface is closed.
  std::size_t unpaired_edges = 0;

  std::vector<std::uint8_t> turn;    ///< per triangle: flipped; empty if none is
  LargeVector<std::uint32_t> shell;  ///< per triangle, numbered by first appearance
  std::vector<std::uint8_t> closed;  ///< per shell: no unpaired edge
};

/// Takes a mesh in which no triangle has a corner twice.
/// Cost  nearly linear; beside the result a megabyte a thread and, for triangles that do not follow
///       their neighbours, up to 48 bytes each.
[[nodiscard]] Surface survey(const Mesh& mesh, const ParallelFor& parallel_for);

}  // namespace routebench::models
