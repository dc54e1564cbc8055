#include "judge/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "judge/bit_plane.hpp"
#include "judge/capsule.hpp"
#include "judge/sample_grid.hpp"
#include "judge/samples_left.hpp"
#include "routebench/geometry/region.hpp"
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
    const auto add = [&](std::size_t row, Span bead) {
      const double dy = static_cast<double>(row) - from.y;
      const Span start = goes_on && std::abs(dy) <= radius ? disc_row(from.x, dy, radius) : Span{};
      if (start.empty()) {
        once.add_counting(row, bead.left, bead.right, twice);
        return;
      }
      // A sample on the rim of the disc belongs to it.
      once.add_counting(row, bead.left, std::ceil(start.left) - 1, twice);
      once.add_counting(row, std::floor(start.right) + 1, bead.right, twice);
    };
    visit_capsule_rows(from, grid.to_steps(run.points[i + 1]), radius, grid.rows(), add);
  }
}

/// Takes away all samples within radius_mm of the beads' centre lines, which may be moved by up to
/// slack_mm: steps of a curve that are shorter are taken together.
void remove_reach(SamplesLeft& samples, const std::vector<Run>& runs, double radius_mm,
                  double slack_mm) {
  const auto visit_pieces = [&](auto&& visit) {
    for (const Run& run : runs) {
      Point2 from = run.points.front();
      for (std::size_t i = 0; i < run.widths_mm.size(); ++i) {
        const Point2 to = run.points[i + 1];
        if (run.widths_mm[i] <= 0) {
          from = to;
          continue;
        }
        const double length = distance(from, to);
        const bool last = i + 1 == run.widths_mm.size() || run.widths_mm[i + 1] <= 0;
        if (!last && length < slack_mm) continue;
        visit(from, to, length);
        from = to;
      }
    }
  };
  // Long pieces first: usually they leave nothing for the many short ones.
  visit_pieces([&](Point2 a, Point2 b, double length_mm) {
    if (length_mm >= radius_mm) samples.remove(a, b, radius_mm);
  });
  samples.look();
  if (samples.none()) return;
  visit_pieces([&](Point2 a, Point2 b, double length_mm) {
    if (length_mm < radius_mm) samples.remove(a, b, radius_mm);
  });
}

/// How far a sparse line reaches.
double reach_mm(const Task& task) { return task.spacing_mm() / task.density; }

/// Share of the sparse part that lies within one line distance of a centre line. The reach is many
/// line widths wide, and so are the steps in which it is sampled: nothing if the part slips through
/// between them.
std::optional<double> sparse_share_reached(const Polygons& sparse, const std::vector<Run>& runs,
                                           const Task& task) {
  constexpr double kSamplesAcrossReach = 16;
  constexpr double kSamplesAcrossLayer = 128;
  constexpr double kMaxSamples = 4194304;  // 2^22
  const double reach = reach_mm(task);
  const Box2 box = bounding_box(sparse);
  const double across = std::max(box.upper.x - box.lower.x, box.upper.y - box.lower.y);
  const double pitch = std::min(reach / kSamplesAcrossReach, across / kSamplesAcrossLayer);
  const SampleGrid grid(sparse, 0, pitch, kMaxSamples);
  BitPlane region(grid, sparse);
  const std::size_t samples = region.count();
  if (samples == 0) return std::nullopt;
  SamplesLeft left(std::move(region));
  remove_reach(left, runs, reach, grid.pitch_mm() / 2);
  return static_cast<double>(samples - left.count()) / static_cast<double>(samples);
}

/// As above by the layer's own samples, of which `sparse` are in the part.
double sparse_share_reached_finely(const LayerSamples& samples, std::size_t sparse,
                                   const std::vector<Run>& runs, const Task& task) {
  BitPlane region = samples.sparse;
  region.keep(samples.outline);
  SamplesLeft left(std::move(region));
  remove_reach(left, runs, reach_mm(task), samples.grid.pitch_mm() / 2);
  return static_cast<double>(sparse - left.count()) / static_cast<double>(sparse);
}

std::size_t doubled_samples(const SampleGrid& grid, const std::vector<Run>& runs,
                            const Task& task) {
  BitPlane once(grid);
  BitPlane twice(grid);
  for (const Run& run : runs) add_passes(once, twice, run, task);
  return twice.count();
}

/// Area of beads beyond the samples, as length x width.
double area_beyond_mm2(const SampleGrid& grid, const std::vector<Run>& runs) {
  double area = 0;
  visit_beads(runs, [&](Point2 a, Point2 b, double width_mm) {
    const SampleGrid::Shares over = grid.shares_over(a, b);
    area += (1 - (over.leave - over.enter)) * distance(a, b) * width_mm;
  });
  return area;
}

}  // namespace

Coverage measure_coverage(const LayerSamples& samples, std::size_t outline_samples,
                          const Demand& demand, const std::vector<Run>& runs, const Task& task) {
  const SampleGrid& grid = samples.grid;
  const auto share = [outline_samples](double part) {
    return part / static_cast<double>(outline_samples);
  };
  Coverage result;
  result.doubled = share(static_cast<double>(doubled_samples(grid, runs, task)));

  BitPlane beads(grid);
  visit_beads(runs, [&beads](Point2 a, Point2 b, double width_mm) {
    add_capsule(beads, a, b, width_mm / 2);
  });
  const std::size_t under_beads = samples.outline.count(
      [](Word p, Word s, Word b) { return p & ~s & b; }, samples.sparse, beads);
  const std::size_t sparse =
      samples.outline.count([](Word p, Word s) { return p & s; }, samples.sparse);
  double sparse_reached = 1;
  if (sparse > 0 && task.density > 0) {
    const std::optional<double> share_reached = sparse_share_reached(demand.sparse, runs, task);
    sparse_reached =
        share_reached ? *share_reached : sparse_share_reached_finely(samples, sparse, runs, task);
  }
  result.covered =
      share(static_cast<double>(under_beads) + static_cast<double>(sparse) * sparse_reached);

  beads.remove(samples.outline);
  SamplesLeft outside(std::move(beads));
  outside.remove(demand.outline, task.line_width_mm / 2);
  result.spilled =
      share(static_cast<double>(outside.count()) + area_beyond_mm2(grid, runs) / grid.sample_mm2());
  return result;
}

}  // namespace routebench::judging
