#pragma once
/// Layers of a mesh by way of a container of cells.

#include <string>
#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/types.hpp"
#include "slicing/cut_triangles.hpp"
#include "slicing/voxel_grid.hpp"

namespace routebench::slicing {

/// The container of a mesh: its cells' centres lie at the planes' heights, and from the mesh's
/// lower corner at multiples of cell_mm; one empty cell all round.
[[nodiscard]] VoxelFrame frame_of(const Mesh& mesh, const Planes& planes, double cell_mm);

/// The outlines of the cells that are surface or enclosed by it, a layer of cells each. Cells that
/// touch in an edge only are not joined by it.
/// Cost   see VoxelGrid; linear in the outlines' cells, and O(n log n) a layer for their polygons.
[[nodiscard]] std::vector<Polygons> voxel_layers(const Mesh& mesh, const VoxelFrame& frame,
                                                 const ParallelFor& parallel_for);

}  // namespace routebench::slicing
