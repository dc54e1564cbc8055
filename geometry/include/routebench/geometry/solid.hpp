#pragma once
/// Which part of each layer must be dense.

#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench {

/// Sets Layer::solid: what has air within `skin_layers` layers above or below, by exact polygon
/// difference (polygons minus the common part of the layers within reach; beyond the top and the
/// bottom there is air). What is narrower than 1 um is left out. skin_layers = 0 leaves solid empty.
///
/// Throws Error{kBadUsage} for skin_layers < 0.
///
/// Cost   about three Boolean operations a layer, whatever skin_layers is.
void find_solid(std::vector<Layer>& layers, int skin_layers,
                const ParallelFor& parallel_for = serial_for);

}  // namespace routebench
