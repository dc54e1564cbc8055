#pragma once
/// From the cuts of one layer to closed lines: the second step of slicing.

#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "slicing/cut_triangles.hpp"

namespace routebench::slicing {

/// A line that does not return to its first point, in the direction that has the material on its
/// left. At least two points.
using Chain = std::vector<Point2>;

/// The lines of one layer. As sets of points they depend neither on the order of triangles nor on
/// that of vertices.
struct Contours {
  std::vector<Ring> rings;  ///< without repeated neighbours
  std::vector<Chain> open;
  bool at_edges = false;  ///< joined at mesh edges, where all of them could be
};

/// Joins the cuts of one layer end to end.
///
/// Where every mesh edge is shared by two triangles that agree on what is outside, cuts are joined
/// at mesh edges. Everywhere else they are joined at equal points, in an order that depends on
/// coordinates only: that closes edges with four triangles and facets that share no vertices.
///
/// Cost linear in the cuts; O(n log n) for layers that need points.
[[nodiscard]] Contours chain_cuts(std::span<const Cut> cuts, const Mesh& mesh, double z_mm);

}  // namespace routebench::slicing
