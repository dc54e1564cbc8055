#pragma once
/// What beads cover, twice or outside.

#include <cstddef>
#include <vector>

#include "judge/layer_samples.hpp"
#include "judge/run.hpp"
#include "judge/strays.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/task.hpp"

namespace routebench::judging {

/// Shares of the area of a layer's polygons.
struct Coverage {
  /// Filled as demanded. Walls and dense parts: under a bead, half its width from its centre line.
  /// Sparse parts: within one line distance, spacing / density, of a centre line. That is the reach
  /// which patterns of that density need: lines one distance apart half of it, squares, triangles
  /// and hexagons all of it. What is to be left empty, the sparse part at density 0, counts as
  /// filled.
  double covered = 0;
  /// Passed twice. A bead is taken at its mean width, section / height, so that neighbouring lines
  /// at their spacing do not overlap. A point is passed once for every stretch of a run, as long as
  /// can be, that stays within half the mean width of it: a corner is one pass but for the tip of
  /// its inner side, which both legs reach on their own (less than 0.06 mean widths squared at 90
  /// degrees); the two ends of a loop are one pass where they meet; a run that comes back over
  /// itself is two.
  double doubled = 0;
  /// Under beads further than half a line from the polygons. Beyond the samples length x width.
  double spilled = 0;
};

/// Measures one layer. Takes a layer of `outline_samples` > 0 samples and the strays of its runs.
/// Cost   one word operation for 64 samples, some additions for a row between a bead's straight
///        sides, two square roots for a row at its ends; of two to eight rows at once.
[[nodiscard]] Coverage measure_coverage(const LayerSamples& samples, std::size_t outline_samples,
                                        const Demand& demand, const std::vector<Run>& runs,
                                        const std::vector<Bead>& strays, const Task& task);

}  // namespace routebench::judging
