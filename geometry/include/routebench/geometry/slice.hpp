#pragma once
/// From a mesh to layers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// How triangles become layers. Bucket, sweep and naive give identical layers; voxel approximates
/// them. Source: K. De Keyser, 2016.
enum class SliceMethod {
  kBucket,  ///< every triangle is visited once and pushes its cuts into the planes it crosses:
            ///< linear in the output
  kSweep,   ///< triangles enter and leave an active set while the plane rises: O(Q + N log N) plus
            ///< the cuts
  kNaive,   ///< every triangle against every plane: O(Q N)
  kVoxel,   ///< the surface is drawn into a container of cells and the outside flooded; layers are
            ///< outlines of cells. Cells with surface in them count as material, so layers are too
            ///< large by about half a cell all round; enclosed cavities are filled
};

/// Throws Error{kBadUsage} for an unknown name.
[[nodiscard]] SliceMethod slice_method(std::string_view name);
[[nodiscard]] std::string_view to_string(SliceMethod method);  ///< "bucket" and so on

struct SliceOptions {
  double layer_height_mm = 0.2;
  SliceMethod method = SliceMethod::kBucket;
  bool repair = false;     ///< close gaps wider than crack_mm too, and mark those layers
  double crack_mm = 0.1;   ///< gaps up to this are closed without being asked, and counted
  double straight_mm = 0;  ///< contours may be moved by this to have fewer points; 0: are exact
  double cell_mm = 0.45;   ///< voxel: side of a cell in x and y; in z it is a layer high
};

/// The container of SliceMethod::kVoxel.
struct VoxelContainer {
  std::array<std::int64_t, 3> cells{};  ///< along x, y and z
  double bytes = 0;                     ///< two bits a cell; what the layers need comes to it
};

/// What slicing a mesh by voxels will need, without doing it. Throws what slice_mesh throws for
/// meshes and options that it does not even begin with. Cost   linear in vertices.
[[nodiscard]] VoxelContainer voxel_container(const Mesh& mesh, const SliceOptions& options,
                                             const std::string& model_name);

struct SliceReport {
  std::size_t cracks_closed = 0;  ///< gaps up to crack_mm, over all layers
  double widest_crack_mm = 0;
  std::size_t gaps_repaired = 0;  ///< wider gaps, over all layers; only with repair
  double widest_gap_mm = 0;
  std::size_t repaired_layers = 0;
  std::vector<std::string> warnings;
};

struct Slices {
  std::vector<Layer> layers;
  SliceReport report;
};

/// Cuts a mesh at mid-slab heights z_k = (k + 1/2) layer_height_mm above z = 0.
///
/// A vertex on a plane counts as above it: a cut at the height of a flat face is the limit from
/// below, flat faces vanish, and a closed mesh gives closed rings. Where shells overlap the
/// material is what any of them encloses (non-zero winding). Polygons and holes narrower than 1 um,
/// or than the widest crack closed in their layer, are left out. Every coordinate lies on the grid;
/// the layers do not depend on the order of triangles, the loop that runs them or, but for voxel,
/// the method.
///
/// Takes   a mesh on z = 0. `model_name` is used in messages only.
/// Returns one layer a plane that lies below the top, empty ones included; `solid` is left empty
/// (see solid.hpp). Throws  Error{kBadInput} where a contour stays open by more than crack_mm and
/// repair is off (names the first such layer, its
///         z, the place and the gap), and where no layer has any area. Voxel closes gaps up to a
///         cell by itself; where wider ones let the flood in it warns that volume is missing. It
///         refuses containers of more than 1 GiB.
/// Cost    bucket: linear in triangles + segments; rings to polygons O(n log n) a layer. voxel:
///         linear in the cells of the container, and in those of every triangle.
/// Source  K. De Keyser, 2016 (buckets); one integer level a vertex makes it exact.
[[nodiscard]] Slices slice_mesh(const Mesh& mesh, const SliceOptions& options,
                                const std::string& model_name,
                                const ParallelFor& parallel_for = serial_for);

}  // namespace routebench
