#pragma once
/// Where triangles meet planes: the first step of slicing.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "large_vector.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::slicing {

/// The cutting planes z_k = (k + 1/2) height_mm, k in [0, count).
struct Planes {
  double height_mm = 0;
  int count = 0;

  [[nodiscard]] double z_mm(int plane) const noexcept { return (plane + 0.5) * height_mm; }

  /// Number of planes at or below a height, mm. Every question about above and below is answered by
  /// comparing this number with a plane's, so that no two answers can contradict each other: a
  /// point is above plane k if and only if its level is greater than k.
  [[nodiscard]] int level(double z_mm) const noexcept;
};

/// Names a mesh edge: the smaller vertex index in the upper half, the larger one in the lower.
using EdgeKey = std::uint64_t;

[[nodiscard]] constexpr EdgeKey edge_key(std::uint32_t v, std::uint32_t w) noexcept {
  // Calculated, since nobody could foresee a branch.
  const std::uint32_t lower = w ^ ((v ^ w) & (0U - static_cast<std::uint32_t>(v < w)));
  return EdgeKey{lower} << 32U | (v ^ w ^ lower);
}

/// Where one triangle meets one plane: a straight line from one edge to another, the material on
/// its left. Both edges end at the vertex that lies alone on its side of the plane. The line's end
/// is the beginning of the neighbouring triangle's.
struct Cut {
  std::uint32_t alone;
  std::uint32_t from_end;
  std::uint32_t to_end;

  [[nodiscard]] EdgeKey from() const noexcept { return edge_key(alone, from_end); }
  [[nodiscard]] EdgeKey to() const noexcept { return edge_key(alone, to_end); }
  friend bool operator==(const Cut&, const Cut&) = default;
};

/// The cuts of all layers, layer after layer.
struct CutTable {
  LargeVector<Cut> cuts;
  std::vector<std::size_t> begin;  ///< of each layer in `cuts`, and the end of the last one

  [[nodiscard]] std::span<const Cut> layer(std::size_t index) const {
    return std::span(cuts).subspan(begin[index], begin[index + 1] - begin[index]);
  }
};

/// Where an edge that crosses the plane at z_mm meets it, on the grid. It depends on the
/// coordinates of the edge's ends alone, so all triangles at an edge find the same point.
[[nodiscard]] inline Point2 cut_point(const Mesh& mesh, EdgeKey edge, double z_mm) noexcept {
  // Without a branch, too.
  const auto v = static_cast<std::uint32_t>(edge >> 32U), w = static_cast<std::uint32_t>(edge);
  const bool falls = mesh.vertices[v].z > mesh.vertices[w].z;
  const std::uint32_t change = (v ^ w) & (0U - static_cast<std::uint32_t>(falls));
  const Point3 &lower = mesh.vertices[v ^ change], &upper = mesh.vertices[w ^ change];
  const double share = (z_mm - lower.z) / (upper.z - lower.z);
  return snap(Point2{lower.x + share * (upper.x - lower.x), lower.y + share * (upper.y - lower.y)});
}

/// Whether two layers have cuts of the same triangles, all of which are upright: lean by no more
/// than `lean_mm` from their lowest point to their highest. Then their lines are the same within
/// about that, cut into pieces at other places: where two upright triangles meet at an edge that is
/// not upright, they lie in one plane.
///
/// Both layers' cuts must be in the order of one method.
/// Cost linear in the cuts, up to the first that differs.
[[nodiscard]] bool run_straight_up(std::span<const Cut> lower, std::span<const Cut> upper,
                                   const Mesh& mesh, double lean_mm);

/// Cuts all triangles by all planes. The order of cuts within a layer depends on the method.
/// Throws Error{kBadInput} naming the model where there are more cuts than memory should be spent
/// on.
[[nodiscard]] CutTable cut_triangles(const Mesh& mesh, const Planes& planes, SliceMethod method,
                                     const std::string& model_name,
                                     const ParallelFor& parallel_for);

}  // namespace routebench::slicing
