#pragma once
/// Fewer triangles for nearly the same surface.

#include <string>

#include "routebench/geometry/model.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Collapses edges in the order of the error that this brings, until a share of them is left.
///
/// Vertices at open edges stay where they are. The result does not depend on the order of the
/// triangles.
///
/// Takes   a mended mesh; `share` in (0, 1], of its triangles that shall be left. More are left
///         where going on would turn a triangle over or change how the surface hangs together.
/// Returns what came of it, lengths in the mesh's unit.
/// Throws  Error{kBadInput} if parts of the mesh touch along edges or in corners, or if nothing
/// that
///         encloses anything is left.
/// Cost    O(n log n); about 1 kB a triangle for the time of the call.
/// Source  M. Garland and P. Heckbert, 1997, by CGAL; named as an extension by K. De Keyser, 2016.
[[nodiscard]] Simplification simplify_mesh(Mesh& mesh, double share, const std::string& name);

}  // namespace routebench::models
