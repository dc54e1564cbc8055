#include "judge/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "judge/beside.hpp"
#include "judge/cell_rows.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

constexpr double kMaxPoints = 4194304;  // 2^22
constexpr double kMaxCells = 1048576;   // 2^20

/// A point of the boundary that stands for a piece of it.
struct Sample {
  Point2 point;
  double length_mm = 0;
};

std::vector<Sample> sample_boundary(const Polygons& polygons, double pitch_mm) {
  std::vector<Sample> samples;
  samples.reserve(static_cast<std::size_t>(1.5 * perimeter_mm(polygons) / pitch_mm));
  const auto add_ring = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i];
      const Point2 b = ring[i + 1 == ring.size() ? 0 : i + 1];
      const double length = distance(a, b);
      const double pieces = std::ceil(length / pitch_mm);
      for (double k = 0; k < pieces; k += 1)
        samples.push_back({lerp(a, b, (k + 0.5) / pieces), length / pieces});
    }
  };
  for (const Polygon& polygon : polygons) {
    add_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) add_ring(hole);
  }
  return samples;
}

/// A segment that is asked for its distance to many points.
class CentreLine {
 public:
  CentreLine(Point2 a, Point2 b)
      : a_(a), run_(b - a), inverse_(dot(run_, run_) > 0 ? 1 / dot(run_, run_) : 0) {}

  [[nodiscard]] double squared_distance_to(Point2 p) const {
    const Point2 way = p - a_;
    return squared_distance(way, std::clamp(dot(way, run_) * inverse_, 0.0, 1.0) * run_);
  }

 private:
  Point2 a_;
  Point2 run_;
  double inverse_;  // of the squared length
};

/// Samples by cells of a grid along the axes, so that a bead looks at those near it only.
class SampleCells {
 public:
  SampleCells(std::vector<Sample> samples, const Box2& box, double reach_mm)
      : lower_(box.lower), reach_mm_(reach_mm) {
    const Point2 size = box.upper - box.lower;
    cell_mm_ = std::max({2 * reach_mm, std::sqrt(size.x * size.y / kMaxCells),
                         std::max(size.x, size.y) / kMaxCells});
    columns_ = static_cast<std::size_t>(size.x / cell_mm_) + 1;
    rows_ = static_cast<std::size_t>(size.y / cell_mm_) + 1;
    begin_.assign(columns_ * rows_ + 1, 0);
    for (const Sample& sample : samples) ++begin_[cell_of(sample.point) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    samples_.resize(samples.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (const Sample& sample : samples) samples_[next[cell_of(sample.point)]++] = sample;
    unreached_end_.assign(begin_.begin() + 1, begin_.end());
    for (std::size_t row = 0; row < rows_; ++row)
      unreached_in_row_.push_back(begin_[(row + 1) * columns_] - begin_[row * columns_]);
  }

  void reach_from(Point2 a, Point2 b) {
    const CentreLine bead(a, b);
    visit_cell_rows(to_cells(a), to_cells(b), reach_mm_ / cell_mm_ + kRounding, rows_,
                    [&](std::size_t row, double left, double right) {
                      if (unreached_in_row_[row] > 0)
                        reach_in(row, nearest_cell(left, columns_), nearest_cell(right, columns_),
                                 bead);
                    });
  }

  [[nodiscard]] double share_reached() const {
    double reached = 0;
    double all = 0;
    for (std::size_t cell = 0; cell < unreached_end_.size(); ++cell)
      for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
        all += samples_[i].length_mm;
        if (i >= unreached_end_[cell]) reached += samples_[i].length_mm;
      }
    return reached / all;
  }

 private:
  /// Far below what tells cells apart, far above what arithmetic loses.
  static constexpr double kRounding = 1e-6;

  [[nodiscard]] Point2 to_cells(Point2 p) const { return (1 / cell_mm_) * (p - lower_); }

  [[nodiscard]] std::size_t cell_of(Point2 p) const {
    const Point2 cells = to_cells(p);
    return nearest_cell(cells.y, rows_) * columns_ + nearest_cell(cells.x, columns_);
  }

  void reach_in(std::size_t row, std::size_t first, std::size_t last, const CentreLine& bead) {
    for (std::size_t cell = row * columns_ + first; cell <= row * columns_ + last; ++cell)
      for (std::uint32_t i = begin_[cell]; i < unreached_end_[cell];)
        if (bead.squared_distance_to(samples_[i].point) <= reach_mm_ * reach_mm_) {
          std::swap(samples_[i], samples_[--unreached_end_[cell]]);
          --unreached_in_row_[row];
        } else {
          ++i;
        }
  }

  Point2 lower_;
  double reach_mm_;
  double cell_mm_ = 1;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<Sample> samples_;                  // cell by cell
  std::vector<std::uint32_t> begin_;             // of cell c: samples_[begin_[c] .. begin_[c + 1])
  std::vector<std::uint32_t> unreached_end_;     // of cell c: those before it were not reached yet
  std::vector<std::uint32_t> unreached_in_row_;  // number of samples
};

}  // namespace

std::optional<double> outline_covered(const Polygons& polygons, const std::vector<Run>& runs,
                                      double reach_mm) {
  const double length_mm = perimeter_mm(polygons);
  if (length_mm > 0 && is_surely_reached(polygons, runs, reach_mm)) return 1;
  const double pitch = std::max(std::min(0.1, reach_mm / 4), length_mm / (kMaxPoints / 2));
  std::vector<Sample> samples = sample_boundary(polygons, pitch);
  if (samples.empty()) return std::nullopt;
  SampleCells cells(std::move(samples), bounding_box(polygons), reach_mm);
  visit_beads(runs, [&](Point2 a, Point2 b, double) { cells.reach_from(a, b); });
  return cells.share_reached();
}

}  // namespace routebench::judging
