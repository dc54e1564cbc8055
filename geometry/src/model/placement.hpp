#pragma once
/// Where a model stands and how large it is.

#include <optional>
#include <string>
#include <vector>

#include "model/bounds.hpp"
#include "model/raw_mesh.hpp"

namespace routebench::models {

struct Placement {
  double scale;   ///< the factor by which lengths grew
  Bounds bounds;  ///< of the placed mesh
};

/// Scales a mesh so that its largest side measures `size_mm`, if that is given, and moves it onto
/// z = 0; x and y stay unless some of it lies further than 1 m from the origin: then the bounding
/// box begins at x = y = 0 and a warning says what precision is left.
///
/// Throws  Error{kBadInput} for a mesh without thickness, larger than 10 m or so far away that its
///         coordinates cannot tell tenths of a millimetre.
Placement place(RawMesh& raw, std::optional<double> size_mm, const std::string& name,
                const ParallelFor& parallel_for);

}  // namespace routebench::models
