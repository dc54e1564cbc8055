#pragma once
/// Which way the shells of a mesh face, and which way they should.

#include <cstddef>

#include "model/surface.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

struct ShellReport {
  double volume = 0;       ///< enclosed by all shells, cavities taken off
  std::size_t count = 0;   ///< shells
  std::size_t turned = 0;  ///< shells that faced inwards
  std::size_t empty = 0;   ///< closed shells that enclose nothing
};

/// Turns shells that face inwards, in place.
///
/// A closed shell faces inwards if its volume is negative. Inside another shell that faces outwards
/// it is a cavity and stays; a shell that nothing encloses is turned together with everything
/// inside it. A shell with holes is judged alike as long as it is nearly closed; scattered patches
/// are judged all together.
/// Cost  linear in the triangles; where some shell faces inwards, also in the pairs of a triangle
///       and a shell whose lowest point lies over or under it.
/// `uses_all_vertices` may be said of a mesh without vertices that no triangle has; it saves time.
ShellReport turn_inside_out_shells(Mesh& mesh, bool uses_all_vertices, const Surface& surface,
                                   const ParallelFor& parallel_for);

}  // namespace routebench::models
