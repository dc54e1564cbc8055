#pragma once
/// Sparse parts within reach of lines.

#include <cstddef>
#include <vector>

#include "judge/layer_samples.hpp"
#include "judge/run.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/harness/task.hpp"

namespace routebench::judging {

/// Share of the sparse part that lies within one line distance, spacing / density, of a centre
/// line.
///
/// Takes a part of which `sparse_samples` > 0 of the layer's samples are, and a density that is not
///       0.
/// Cost  of most parts that of 1 / 16 of the samples: all are in reach.
[[nodiscard]] double sparse_share_reached(const LayerSamples& samples, std::size_t sparse_samples,
                                          const Polygons& sparse, const std::vector<Run>& runs,
                                          const Task& task);

}  // namespace routebench::judging
