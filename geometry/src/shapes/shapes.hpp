#pragma once
/// Solids made on demand: closed, manifold, oriented, equal parameters give equal bytes.

#include <map>
#include <string>

#include "routebench/geometry/types.hpp"
#include "shapes/shape_query.hpp"

namespace routebench::shapes {

/// Makes the shape `name`. Its bounding box begins at the origin.
///
/// Takes  the whole name for messages and the parameters without `size`.
/// Throws Error{kBadInput} for an unknown shape or parameter (with the nearest known one) and for
///        values that cannot be built.
/// Cost   linear in the triangles.
[[nodiscard]] Mesh make_shape(const std::string& spec, const std::string& name,
                              const std::map<std::string, std::string>& parameters);

/// The shapes, one file a family.
[[nodiscard]] Mesh make_box(ShapeQuery& query);
[[nodiscard]] Mesh make_cylinder(ShapeQuery& query);
[[nodiscard]] Mesh make_sphere(ShapeQuery& query);
[[nodiscard]] Mesh make_torus(ShapeQuery& query);
[[nodiscard]] Mesh make_hotend(ShapeQuery& query);
[[nodiscard]] Mesh make_gear(ShapeQuery& query);
[[nodiscard]] Mesh make_comb(ShapeQuery& query);
[[nodiscard]] Mesh make_bracket(ShapeQuery& query);
[[nodiscard]] Mesh make_grate(ShapeQuery& query);
[[nodiscard]] Mesh make_islands(ShapeQuery& query);
[[nodiscard]] Mesh make_text(ShapeQuery& query);
[[nodiscard]] Mesh make_gyroid(ShapeQuery& query);
[[nodiscard]] Mesh make_voronoi(ShapeQuery& query);

}  // namespace routebench::shapes
