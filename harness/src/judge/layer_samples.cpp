#include "judge/layer_samples.hpp"

#include <algorithm>
#include <cmath>

#include "routebench/geometry/region.hpp"

namespace routebench::judging {
namespace {

constexpr double kPitchMm = 0.05;
constexpr double kSamplesAcrossLine = 9;
constexpr double kSamplesAcrossLayer = 200;
constexpr double kMaxSamples = 4194304;  // 2^22: 512 KiB a plane

SampleGrid grid_over(const Polygons& polygons, const Task& task) {
  const Box2 box = bounding_box(polygons);
  const double across = std::sqrt((box.upper.x - box.lower.x) * (box.upper.y - box.lower.y));
  const double pitch =
      std::min({kPitchMm, task.line_width_mm / kSamplesAcrossLine, across / kSamplesAcrossLayer});
  // The margin holds beads of centre lines on the outline.
  return {polygons, 2 * task.line_width_mm, pitch, kMaxSamples};
}

}  // namespace

LayerSamples::LayerSamples(const Demand& demand, const Task& task)
    : grid(grid_over(demand.outline, task)),
      outline(grid, demand.outline),
      dense(grid, demand.dense),
      sparse(grid, demand.sparse) {}

}  // namespace routebench::judging
