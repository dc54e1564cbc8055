#pragma once
/// Places inside the walls that a route leaves out.

#include <vector>

#include "judge/layer_samples.hpp"
#include "judge/run.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/task.hpp"

namespace routebench::judging {

/// Area inside the walls that is left out, mm2: there less than 70 % of the demanded material is
/// laid, averaged over the place's surroundings in the same part, dense or sparse, up to two and a
/// half line distances each way with falling weight.
///
/// This is sharper than what is covered. A reach of one line distance still covers the gap that a
/// missing sparse line leaves, since as wide a cell may belong to an honest pattern; and a tenth of
/// the gap of a missing dense line is covered by its neighbours, whose beads are wider than their
/// spacing. But a missing line takes two fifths of the material away from the place where it should
/// run, whatever the pattern, so that about as much area is found left out as was left out, in one
/// place or in thin slices; evenly spread patterns keep within a few percent of what is demanded.
/// The boundary of a part counts as half a line, for the wall beyond it: so the gap of up to a line
/// distance that parallel lines leave at the boundary, depending on where they begin, is no fault;
/// and neither are parts that are too narrow for a line.
///
/// Cost linear in the samples' words, in the length of beads over the line distance, and in the
///      cells of the average, of which about two lie side by side in a line distance.
[[nodiscard]] double skipped_area_mm2(const LayerSamples& samples, const Demand& demand,
                                      const std::vector<Run>& runs, const Task& task);

}  // namespace routebench::judging
