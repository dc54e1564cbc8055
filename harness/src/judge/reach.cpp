#include "judge/reach.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "judge/bit_plane.hpp"
#include "judge/cell_rows.hpp"
#include "judge/sample_grid.hpp"
#include "judge/samples_left.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

using Word = BitPlane::Word;

constexpr double kMaxSamples = 4194304;  // 2^22
constexpr double kRounding = 1e-6;       // in steps, far above what arithmetic loses

/// Takes away all samples within radius_mm of the beads' centre lines, which may be moved by up to
/// slack_mm: steps of a curve that are shorter are taken together.
void remove_reach(SamplesLeft& samples, const std::vector<Run>& runs, double radius_mm,
                  double slack_mm) {
  const auto visit_pieces = [&](auto&& visit) {
    // Backwards: lines that fill come after walls, and leave few samples for these.
    for (auto run = runs.rbegin(); run != runs.rend() && !samples.empty(); ++run) {
      Point2 from = run->points.front();
      for (std::size_t i = 0; i < run->widths_mm.size(); ++i) {
        const Point2 to = run->points[i + 1];
        if (run->widths_mm[i] <= 0) {
          from = to;
          continue;
        }
        const double length = distance(from, to);
        const bool last = i + 1 == run->widths_mm.size() || run->widths_mm[i + 1] <= 0;
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
  constexpr std::size_t kTogether = 8;
  std::vector<Point2> path;  // of short pieces
  const auto remove_path = [&] {
    samples.remove(path, radius_mm);
    path.clear();
  };
  visit_pieces([&](Point2 a, Point2 b, double length_mm) {
    if (length_mm >= radius_mm) return;
    if (path.empty() || path.back() != a || path.size() > kTogether) {
      remove_path();
      path.push_back(a);
    }
    path.push_back(b);
  });
  remove_path();
}

/// How far a sparse line reaches.
double reach_mm(const Task& task) { return task.spacing_mm() / task.density; }

/// The share by samples that are as much wider apart than a layer's as the reach is wider than a
/// line: nothing if the part slips through between them.
std::optional<double> share_by_samples(const SampleGrid& grid, const Polygons& sparse,
                                       const std::vector<Run>& runs, double reach_mm) {
  BitPlane region(grid, sparse);
  const std::size_t samples = region.count();
  if (samples == 0) return std::nullopt;
  SamplesLeft left(std::move(region));
  remove_reach(left, runs, reach_mm, grid.pitch_mm() / 2);
  return static_cast<double>(samples - left.count()) / static_cast<double>(samples);
}

/// The share by the layer's own samples, of which `sparse` are in the part.
double share_by_layers_samples(const LayerSamples& samples, std::size_t sparse,
                               const std::vector<Run>& runs, const Task& task) {
  SamplesLeft left(BitPlane(
      samples.sparse, [](Word, Word p) { return p; }, samples.outline));
  remove_reach(left, runs, reach_mm(task), samples.grid.pitch_mm() / 2);
  return static_cast<double>(sparse - left.count()) / static_cast<double>(sparse);
}

/// Whether all of the part is surely reached, seen by squares of four by four samples of a grid:
/// each that the part meets lies in reach as a whole.
bool is_reached_by_squares(const SampleGrid& grid, const Polygons& sparse,
                           const std::vector<Run>& runs, double reach_mm, double slack_mm) {
  const SampleGrid squares(sparse, 0, 4 * grid.pitch_mm(), kMaxSamples);
  // As far as a square reaches from its middle, and what the other measures move centre lines by.
  const double half_diagonal_mm = squares.pitch_mm() * std::numbers::sqrt2 / 2;
  const double surely_mm = reach_mm - half_diagonal_mm - slack_mm;
  if (surely_mm <= 0) return false;
  BitPlane met(squares, sparse);
  const auto add_boundary = [&](const Ring& ring) {
    // A sample's square reaches from half a step before it to half a step after it.
    const auto to_squares = [&squares](Point2 p) { return squares.to_steps(p) + Point2{0.5, 0.5}; };
    for (std::size_t i = 0; i < ring.size(); ++i)
      visit_cell_rows(to_squares(ring[i == 0 ? ring.size() - 1 : i - 1]), to_squares(ring[i]),
                      kRounding, squares.rows(), [&](std::size_t row, double left, double right) {
                        met.add(row,
                                static_cast<std::int64_t>(nearest_cell(left, squares.columns())),
                                static_cast<std::int64_t>(nearest_cell(right, squares.columns())));
                      });
  };
  for (const Polygon& polygon : sparse) {
    add_boundary(polygon.outer);
    for (const Ring& hole : polygon.holes) add_boundary(hole);
  }
  SamplesLeft left(std::move(met));
  remove_reach(left, runs, surely_mm, grid.pitch_mm() / 2);
  return left.count() == 0;
}

}  // namespace

double sparse_share_reached(const LayerSamples& samples, std::size_t sparse_samples,
                            const Polygons& sparse, const std::vector<Run>& runs,
                            const Task& task) {
  constexpr double kSamplesAcrossReach = 16;
  constexpr double kSamplesAcrossLayer = 128;
  const double reach = reach_mm(task);
  const Box2 box = bounding_box(sparse);
  const double across = std::max(box.upper.x - box.lower.x, box.upper.y - box.lower.y);
  const double pitch = std::min(reach / kSamplesAcrossReach, across / kSamplesAcrossLayer);
  const SampleGrid grid(sparse, 0, pitch, kMaxSamples);
  if (is_reached_by_squares(grid, sparse, runs, reach, samples.grid.pitch_mm() + grid.pitch_mm()))
    return 1;
  if (const std::optional<double> share = share_by_samples(grid, sparse, runs, reach))
    return *share;
  return share_by_layers_samples(samples, sparse_samples, runs, task);
}

}  // namespace routebench::judging
