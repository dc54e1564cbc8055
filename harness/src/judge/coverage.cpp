#include "judge/coverage.hpp"

#include <utility>

#include "judge/bit_plane.hpp"
#include "judge/capsule.hpp"
#include "judge/reach.hpp"
#include "judge/sample_grid.hpp"
#include "judge/samples_left.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

using Word = BitPlane::Word;

/// What beads are drawn into.
struct Drawing {
  BitPlane beads;        ///< under a bead
  BitPlane passed;       ///< under a pass
  BitPlane passed_more;  ///< under more than one

  explicit Drawing(const SampleGrid& grid) : beads(grid), passed(grid), passed_more(grid) {}
};

/// Draws the beads of a run and their passes; see Coverage::doubled. A pass begins in a segment
/// where its bead reaches a sample that was out of reach where the segment began: the bead less the
/// disc round its first point. Only the first segment of an open run begins passes in that disc
/// too. (In a loop the last segment ends there.)
void draw(Drawing& drawing, const Run& run, const Task& task) {
  const SampleGrid& grid = drawing.beads.grid();
  for (std::size_t i = 0; i < run.widths_mm.size(); ++i) {
    const double width_mm = run.widths_mm[i];
    if (width_mm <= 0) continue;
    const Segment segment(grid.to_steps(run.points[i]), grid.to_steps(run.points[i + 1]));
    Capsule bead(segment, grid.to_steps(width_mm / 2));
    // The bead before ends in the same disc.
    if (i > 0 && run.widths_mm[i - 1] == width_mm) bead.leave_start();
    drawing.beads.add(bead);

    Capsule pass(segment, grid.to_steps(task.mean_width_mm(width_mm) / 2));
    if (i > 0 || run.loop) pass.cut_start();
    drawing.passed.add_counting(pass, drawing.passed_more);
  }
}

/// Area of beads further than half a line from the polygons, in samples.
double spilled_samples(const LayerSamples& samples, const Demand& demand,
                       const std::vector<Bead>& strays, const Task& task) {
  if (strays.empty()) return 0;
  const SampleGrid& grid = samples.grid;
  double beyond_mm2 = 0;  // the samples, as length x width
  BitPlane beads(grid);
  for (const Bead& bead : strays) {
    beads.add(Capsule(Segment(grid.to_steps(bead.a), grid.to_steps(bead.b)),
                      grid.to_steps(bead.width_mm / 2)));
    const SampleGrid::Shares over = grid.shares_over(grid.to_steps(bead.a), grid.to_steps(bead.b));
    beyond_mm2 += (1 - (over.leave - over.enter)) * distance(bead.a, bead.b) * bead.width_mm;
  }
  SamplesLeft outside(BitPlane(
      beads, [](Word, Word p) { return ~p; }, samples.outline));
  outside.remove(demand.outline, task.line_width_mm / 2);
  return static_cast<double>(outside.count()) + beyond_mm2 / grid.sample_mm2();
}

}  // namespace

Coverage measure_coverage(const LayerSamples& samples, std::size_t outline_samples,
                          const Demand& demand, const std::vector<Run>& runs,
                          const std::vector<Bead>& strays, const Task& task) {
  const auto share = [outline_samples](double part) {
    return part / static_cast<double>(outline_samples);
  };
  Drawing drawing(samples.grid);
  for (const Run& run : runs) draw(drawing, run, task);
  // Walls and dense parts.
  const std::size_t under_beads = samples.outline.count_in(drawing.beads, samples.sparse);
  const std::size_t sparse = samples.sparse.count_in(samples.outline);
  const double sparse_reached =
      sparse > 0 && task.density > 0
          ? sparse_share_reached(samples, sparse, demand.sparse, runs, task)
          : 1;
  return {.covered = share(static_cast<double>(under_beads) +
                           static_cast<double>(sparse) * sparse_reached),
          .doubled = share(static_cast<double>(drawing.passed_more.count())),
          .spilled = share(spilled_samples(samples, demand, strays, task))};
}

}  // namespace routebench::judging
