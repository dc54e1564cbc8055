#include "judge/coverage.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "judge/bit_plane.hpp"
#include "judge/capsule.hpp"
#include "judge/reach.hpp"
#include "judge/rounding.hpp"
#include "judge/sample_grid.hpp"
#include "judge/samples_left.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

using Word = BitPlane::Word;

/// Adds all points within radius_mm of segment ab.
void add_capsule(BitPlane& plane, Point2 a, Point2 b, double radius_mm) {
  const SampleGrid& grid = plane.grid();
  visit_capsule_rows(
      grid.to_steps(a), grid.to_steps(b), grid.to_steps(radius_mm), grid.rows(),
      [&plane](std::size_t row, Span bead) { plane.add(row, bead.left, bead.right); });
}

/// Adds the passes of a run; see Coverage::doubled. A pass begins in a segment where its bead
/// reaches a sample that was out of reach where the segment began: the bead less the disc round its
/// first point. Only the first segment of an open run begins passes in that disc too. (In a loop
/// the last segment ends there.)
void add_passes(BitPlane& once, BitPlane& twice, const Run& run, const Task& task) {
  const SampleGrid& grid = once.grid();
  for (std::size_t i = 0; i < run.widths_mm.size(); ++i) {
    if (run.widths_mm[i] <= 0) continue;
    const bool goes_on = i > 0 || run.loop;
    const Point2 from = grid.to_steps(run.points[i]);
    const double radius = grid.to_steps(task.mean_width_mm(run.widths_mm[i]) / 2);
    const std::int64_t first_start = rounded_up(from.y - radius);
    const std::int64_t last_start = goes_on ? rounded_down(from.y + radius) : first_start - 1;
    const auto add = [&](std::size_t row, Span bead) {
      const auto signed_row = static_cast<std::int64_t>(row);
      const Span start = first_start <= signed_row && signed_row <= last_start
                             ? disc_row(from.x, static_cast<double>(signed_row) - from.y, radius)
                             : Span{};
      if (start.empty()) {
        once.add_counting(row, bead.left, bead.right, twice);
        return;
      }
      // A sample on the rim of the disc belongs to it. Mostly one end of the row is on the rim.
      if (bead.left < start.left) once.add_counting(row, bead.left, start.left - 1, twice);
      if (bead.right > start.right) once.add_counting(row, start.right + 1, bead.right, twice);
    };
    CapsuleRows rows(from, grid.to_steps(run.points[i + 1]), radius);
    if (goes_on) rows.leave_tip(from);
    rows.visit(grid.rows(), add);
  }
}

std::size_t samples_passed_twice(const SampleGrid& grid, const std::vector<Run>& runs,
                                 const Task& task) {
  BitPlane once(grid);
  BitPlane twice(grid);
  for (const Run& run : runs) add_passes(once, twice, run, task);
  return twice.count();
}

/// Samples of the walls and dense parts that beads are over.
std::size_t samples_under_beads(const LayerSamples& samples, const std::vector<Run>& runs) {
  const SampleGrid& grid = samples.grid;
  BitPlane beads(grid);
  for (const Run& run : runs)
    for (std::size_t i = 0; i < run.widths_mm.size(); ++i) {
      const double width_mm = run.widths_mm[i];
      if (width_mm <= 0) continue;
      const Point2 from = grid.to_steps(run.points[i]);
      CapsuleRows rows(from, grid.to_steps(run.points[i + 1]), grid.to_steps(width_mm / 2));
      // The bead before ends in the same disc.
      if (i > 0 && run.widths_mm[i - 1] == width_mm) rows.leave_tip(from);
      rows.visit(grid.rows(),
                 [&beads](std::size_t row, Span bead) { beads.add(row, bead.left, bead.right); });
    }
  return samples.outline.count([](Word, Word s, Word b) { return ~s & b; }, samples.sparse, beads);
}

/// Area of beads further than half a line from the polygons, in samples.
double spilled_samples(const LayerSamples& samples, const Demand& demand,
                       const std::vector<Bead>& strays, const Task& task) {
  if (strays.empty()) return 0;
  const SampleGrid& grid = samples.grid;
  double beyond_mm2 = 0;  // the samples, as length x width
  BitPlane beads(grid);
  for (const Bead& bead : strays) {
    add_capsule(beads, bead.a, bead.b, bead.width_mm / 2);
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
  const std::size_t sparse = samples.outline.count([](Word, Word s) { return s; }, samples.sparse);
  const std::size_t under_beads = samples_under_beads(samples, runs);
  const double sparse_reached =
      sparse > 0 && task.density > 0
          ? sparse_share_reached(samples, sparse, demand.sparse, runs, task)
          : 1;
  return {.covered = share(static_cast<double>(under_beads) +
                           static_cast<double>(sparse) * sparse_reached),
          .doubled = share(static_cast<double>(samples_passed_twice(samples.grid, runs, task))),
          .spilled = share(spilled_samples(samples, demand, strays, task))};
}

}  // namespace routebench::judging
