#pragma once
/// From a mesh as it came to one that can be sliced.

#include <cstddef>
#include <string>
#include <vector>

#include "routebench/geometry/model.hpp"
#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Counts the defects of a mesh into `report`, mends what has one right answer and describes both
/// in `warnings`.
///
/// Triangles with a corner twice go. Of the ways to treat triangles without area (drop, keep) and
/// triangles that are there more than once (keep one of those running the same way, keep all, keep
/// one in any case) the one that leaves fewest edges unpaired is taken; then triangles that run
/// against their neighbours and shells that face inwards are turned. None of this depends on the
/// order of the triangles, as long as every patch has a majority.
///
/// Throws Error{kBadInput} where the surface encloses nothing.
/// Cost   nearly linear; several surveys of the surface if it has defects.
void mend(Mesh& mesh, const std::string& name, MeshReport& report,
          std::vector<std::string>& warnings, const ParallelFor& parallel_for);

}  // namespace routebench::models
