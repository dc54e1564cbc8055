#pragma once
/// Solids that a function describes.

#include <array>
#include <cstddef>
#include <functional>

#include "routebench/geometry/types.hpp"

namespace routebench::shapes {

/// Greater than 0 inside the solid, continuous, of the size of a distance in mm.
using Field = std::function<double(const Point3&)>;

/// The surface of the part of a solid that lies in the box from the origin to `size`.
///
/// Every cube of a grid is cut into six tetrahedra, in each of which the surface is one or two
/// triangles: it is closed and manifold whatever the field is.
/// Takes  the number of cubes along each axis, at least 1.
/// Cost   one call of the field a node, memory for the mesh and two layers of nodes.
[[nodiscard]] Mesh isosurface(const Field& field, const Point3& size,
                              const std::array<std::size_t, 3>& cubes);

/// isosurface() with cubes that are as large as gives about so many triangles, but no larger than
/// the finest detail of the field needs.
[[nodiscard]] Mesh isosurface_of(std::size_t triangles, const Field& field, const Point3& size,
                                 double longest_edge_mm);

}  // namespace routebench::shapes
