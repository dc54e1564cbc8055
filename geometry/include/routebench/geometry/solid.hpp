#pragma once
/// Which part of each layer must be dense.

#include <cstddef>
#include <memory>
#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// Sets Layer::solid: what has air within `skin_layers` layers above or below, by exact polygon
/// difference (polygons minus the common part of the layers within reach; beyond the top and the
/// bottom there is air). What is narrower than 1 um is left out. skin_layers = 0 leaves solid
/// empty.
///
/// Throws Error{kBadUsage} for skin_layers < 0.
///
/// Cost   about three Boolean operations a layer, whatever skin_layers is.
void find_solid(std::vector<Layer>& layers, int skin_layers,
                const ParallelFor& parallel_for = serial_for);

/// Technical parts have the same outline over many layers. For each layer the lowest one from which
/// on, up to it, all have equal polygons; itself, if it differs from the one below.
/// Cost   linear in vertices at most.
[[nodiscard]] std::vector<std::size_t> first_of_equal_layers(const std::vector<Layer>& layers);

/// Finds what find_solid finds, but only inside of given regions. Where a region lies clear of all
/// air, as the inside of a steep wall does, that is seen without any Boolean operation.
/// Immutable after construction; safe from any thread.
class SkinFinder {
 public:
  /// The layers must outlive the finder.
  /// Throws Error{kBadUsage} for skin_layers < 0.
  SkinFinder(const std::vector<Layer>& layers, int skin_layers,
             const ParallelFor& parallel_for = serial_for);
  ~SkinFinder();
  SkinFinder(SkinFinder&&) noexcept;
  SkinFinder& operator=(SkinFinder&&) noexcept;

  /// What of a region has air within reach above or below; slivers are not left out.
  /// Takes  a place in the layers, and a region inside of that layer.
  /// Cost   linear in the edges of the region and of the layers within reach; a Boolean operation
  ///        for each layer that does not hold the whole region.
  [[nodiscard]] Polygons skins_in(const Polygons& region, std::size_t layer) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Which facets make the layers about them dense as a whole: two rules that are cheaper than
/// find_solid and cruder, for the experiments that compare them.
enum class FlatRule {
  kNear,   ///< level ones (at most 0.1 mm high) that begin less than 0.8 mm from the layer's plane
  kSlope,  ///< those that rise by less than a fifth of their larger side as seen from above; they
           ///< count for two layers below the first plane at or above them, that one and the next
};

/// True for every layer that a flat facet makes dense.
///
/// Takes   a mesh on z = 0; planes at mid-slab as in slice_mesh.
/// Cost    linear in triangles plus the layers that each of them counts for.
/// Source  K. De Keyser, 2016: his first rule and his last one.
[[nodiscard]] std::vector<bool> layers_with_flat_facets(const Mesh& mesh, FlatRule rule,
                                                        double layer_height_mm,
                                                        std::size_t layer_count);

}  // namespace routebench
