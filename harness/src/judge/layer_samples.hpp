#pragma once
/// One layer's demand as samples: what all measures of area share.

#include "judge/bit_plane.hpp"
#include "judge/sample_grid.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/task.hpp"

namespace routebench::judging {

/// Samples 0.05 mm apart: closer for lines under 0.45 mm (nine across a line) and for layers under
/// 10 mm across (two hundred across the layer), further apart in boxes over 100 mm across, which
/// get 2^22 of them: shares of an area are as exact as their number makes them.
struct LayerSamples {
  SampleGrid grid;
  BitPlane outline;
  BitPlane dense;
  BitPlane sparse;

  LayerSamples(const Demand& demand, const Task& task);
  LayerSamples(const LayerSamples&) = delete;  // the planes point to the grid
  LayerSamples& operator=(const LayerSamples&) = delete;
};

}  // namespace routebench::judging
