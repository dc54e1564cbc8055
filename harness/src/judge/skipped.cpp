#include "judge/skipped.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "judge/bit_plane.hpp"
#include "judge/cell_field.hpp"
#include "judge/rounding.hpp"
#include "judge/sample_grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

constexpr double kLeastShare = 0.7;
constexpr double kReachDistances = 2.5;  // of the average, in line distances
// Cells that are no smaller than a line distance, as on layers of metres, hold now more and now
// fewer lines: the average has to even that out.
constexpr double kLeastReachCells = 3;

/// A box of samples: columns and rows, from the first to before the end.
struct SampleBox {
  std::size_t first_column = 0;
  std::size_t end_column = 0;
  std::size_t first_row = 0;
  std::size_t end_row = 0;

  /// Those of a grid that lie in polygons or, where a point is rounded to the nearest sample, on
  /// their boundary; the first ones are multiples of `multiple`.
  SampleBox(const SampleGrid& grid, const Polygons& polygons, std::size_t multiple) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Point2 lower{kInfinity, kInfinity};
    Point2 upper{-kInfinity, -kInfinity};
    for (const Polygon& polygon : polygons)
      for (const Point2 p : polygon.outer) {
        const Point2 steps = grid.to_steps(p);
        lower = {std::min(lower.x, steps.x), std::min(lower.y, steps.y)};
        upper = {std::max(upper.x, steps.x), std::max(upper.y, steps.y)};
      }
    const auto place = [](double steps, std::size_t end) {
      return static_cast<std::size_t>(std::clamp(steps, 0.0, static_cast<double>(end)));
    };
    first_column = place(lower.x - 1, grid.columns()) / multiple * multiple;
    end_column = place(upper.x + 2, grid.columns());
    first_row = place(lower.y - 1, grid.rows()) / multiple * multiple;
    end_row = place(upper.y + 2, grid.rows());
  }

  /// False if no point of segment ab, in steps, has its nearest sample here.
  [[nodiscard]] bool may_hold_of(Point2 a, Point2 b) const noexcept {
    return std::max(a.x, b.x) + 1 >= static_cast<double>(first_column) &&
           std::min(a.x, b.x) <= static_cast<double>(end_column) &&
           std::max(a.y, b.y) + 1 >= static_cast<double>(first_row) &&
           std::min(a.y, b.y) <= static_cast<double>(end_row);
  }
};

/// A segment cut into pieces of equal length, where it is over a grid.
class Pieces {
 public:
  /// Takes a segment, in steps, and the least number of pieces that the whole of it would be cut
  /// to.
  Pieces(const SampleGrid& grid, Point2 a, Point2 b, double least) {
    const SampleGrid::Shares shares = grid.shares_over(a, b);
    // Rounded down, these are the nearest samples; what is between two of them is one, too.
    const auto place = [&grid, a, b](double share) {
      constexpr double kRounding = 1e-6;
      const Point2 p = lerp(a, b, share) + Point2{0.5, 0.5};
      return Point2{std::clamp(p.x, 0.0, static_cast<double>(grid.columns()) - kRounding),
                    std::clamp(p.y, 0.0, static_cast<double>(grid.rows()) - kRounding)};
    };
    from_ = place(shares.enter);
    over_ = shares.leave - shares.enter;
    count_ = static_cast<double>(rounded_up(over_ * least));
    step_ = (1 / count_) * (place(shares.leave) - from_);
  }

  /// Of the segment's length, that of a piece.
  [[nodiscard]] double share() const noexcept { return over_ / count_; }

  /// Calls visit(column, row) for the sample nearest to the middle of each piece.
  template <typename Visit>
  void visit(Visit&& visit) const {
    for (double i = 0.5; i < count_; i += 1) {
      const Point2 middle = from_ + i * step_;
      // By way of a signed number: to an unsigned one is several instructions on most processors.
      visit(static_cast<std::size_t>(static_cast<std::int64_t>(middle.x)),
            static_cast<std::size_t>(static_cast<std::int64_t>(middle.y)));
    }
  }

 private:
  Point2 from_;
  Point2 step_;
  double count_ = 0;
  double over_ = 0;  // share of the segment
};

/// What one part of a layer demands and gets, in cells of equally many samples.
class PartLedger {
 public:
  PartLedger(const BitPlane& samples, const Polygons& part, double line_distance_mm)
      : part_(samples),
        polygons_(part),
        grid_(part_.grid()),
        line_distance_mm_(line_distance_mm),
        cell_shift_(cell_shift(grid_.to_steps(line_distance_mm))),
        cell_steps_(std::size_t{1} << cell_shift_),
        pieces_a_step_(2 / static_cast<double>(cell_steps_)),
        box_(grid_, part, cell_steps_),
        demanded_(cells(box_.end_column - box_.first_column), cells(box_.end_row - box_.first_row)),
        laid_(demanded_),
        wanted_(demanded_.rows(), Columns{demanded_.columns(), 0}) {
    count_samples();
  }

  /// A bead `strength` times as strong as the task's, from and to a place in steps.
  void lay(Point2 from, Point2 to, double length_mm, double strength) {
    if (!box_.may_hold_of(from, to)) return;
    const Pieces pieces(grid_, from, to, least_pieces(length_mm));
    float filled = 0;  // not known yet: most beads of walls lay nothing here
    pieces.visit([&](std::size_t column, std::size_t row) {
      if (!part_.test(column, row)) return;
      if (filled == 0) filled = samples_filled_by(pieces.share() * length_mm * strength);
      cell_at(laid_, column, row) += filled;
    });
  }

  /// The boundary of the part: half a line.
  void lay_boundary() {
    for (const Polygon& polygon : polygons_) {
      lay_ring(polygon.outer);
      for (const Ring& hole : polygon.holes) lay_ring(hole);
    }
  }

  [[nodiscard]] double skipped_area_mm2() const {
    const auto cell_mm = grid_.pitch_mm() * static_cast<double>(cell_steps_);
    const auto reach = static_cast<std::size_t>(
        std::max(kLeastReachCells, std::round(kReachDistances * line_distance_mm_ / cell_mm)));
    NeighbourhoodMeans demanded(demanded_, reach, wanted_);
    NeighbourhoodMeans laid(laid_, reach, wanted_);
    double skipped = 0;
    for (std::size_t row = 0; row < wanted_.size(); ++row) {
      if (wanted_[row].empty()) continue;
      const std::span<const float> own = demanded_.row(row).subspan(wanted_[row].first);
      const std::span<const float> demanded_near = demanded.row(row);
      const std::span<const float> laid_near = laid.row(row);
      for (std::size_t i = 0; i < laid_near.size(); ++i)
        if (own[i] > 0 &&
            static_cast<double>(laid_near[i]) < kLeastShare * static_cast<double>(demanded_near[i]))
          skipped += static_cast<double>(own[i]);
    }
    return skipped * grid_.sample_mm2();
  }

 private:
  /// Of two, the power that gives about half a line distance: so no cell lies in two words.
  static unsigned cell_shift(double line_distance_steps) {
    unsigned shift = 0;
    while (std::size_t{2} << shift <= BitPlane::kWordBits &&
           static_cast<double>(std::size_t{2} << shift) <= 0.75 * line_distance_steps)
      ++shift;
    return shift;
  }

  [[nodiscard]] std::size_t cells(std::size_t steps) const {
    return (steps + cell_steps_ - 1) >> cell_shift_;
  }

  void count_samples() {
    // Two to four rows a cell, each standing for several, are enough: they are averaged over
    // several cells.
    const std::size_t stride = std::max<std::size_t>(1, cell_steps_ / 2);
    const BitPlane::Word mask = ~BitPlane::Word{0} >> (BitPlane::kWordBits - cell_steps_);
    const std::size_t cells_a_word = BitPlane::kWordBits / cell_steps_;
    for (std::size_t strip = 0; strip < part_.strips(); ++strip) {
      const BitPlane::Rows used = part_.used(strip);
      const std::size_t begin = strip * BitPlane::kWordBits - box_.first_column;
      std::size_t row = box_.first_row + stride / 2;
      if (used.first > row) row += (used.first - row + stride - 1) / stride * stride;
      for (; row < std::min(used.end, box_.end_row); row += stride) {
        const BitPlane::Word samples = part_.word(strip, row);
        if (samples == 0) continue;
        const auto before = static_cast<std::size_t>(std::countr_zero(samples));
        const auto after = static_cast<std::size_t>(std::countl_zero(samples));
        Columns& wanted = wanted_[(row - box_.first_row) >> cell_shift_];
        wanted.first = std::min(wanted.first, (begin + before) >> cell_shift_);
        wanted.end =
            std::max(wanted.end, ((begin + BitPlane::kWordBits - 1 - after) >> cell_shift_) + 1);
        BitPlane::Word word = bits_of_cells(samples);
        for (std::size_t cell = strip * cells_a_word; word != 0; ++cell) {
          if (const BitPlane::Word set = word & mask; set > 0)
            cell_at(demanded_, cell * cell_steps_, row) +=
                static_cast<float>(static_cast<std::size_t>(set) * stride);
          word = cell_steps_ == BitPlane::kWordBits ? 0 : word >> cell_steps_;
        }
      }
    }
  }

  /// How many bits each cell's part of a word has, in its place.
  [[nodiscard]] BitPlane::Word bits_of_cells(BitPlane::Word word) const {
    // Of fields of 1, 2, 4 and so on bits every other one.
    static constexpr std::array<BitPlane::Word, 6> kEveryOther{
        0x5555555555555555U, 0x3333333333333333U, 0x0f0f0f0f0f0f0f0fU,
        0x00ff00ff00ff00ffU, 0x0000ffff0000ffffU, 0x00000000ffffffffU};
    for (unsigned i = 0; i < cell_shift_; ++i)
      word = (word & kEveryOther[i]) + (word >> (1U << i) & kEveryOther[i]);
    return word;
  }

  void lay_ring(const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i];
      const Point2 b = ring[i + 1 == ring.size() ? 0 : i + 1];
      const double length_mm = distance(a, b);
      const Pieces pieces(grid_, grid_.to_steps(a), grid_.to_steps(b), least_pieces(length_mm));
      const float filled = samples_filled_by(pieces.share() * length_mm / 2);
      pieces.visit([this, filled](std::size_t column, std::size_t row) {
        cell_at(laid_, column, row) += filled;
      });
    }
  }

  /// Of at most half a cell each.
  [[nodiscard]] double least_pieces(double length_mm) const {
    return grid_.to_steps(length_mm) * pieces_a_step_;
  }

  /// Every mm of line fills its distance's width.
  [[nodiscard]] float samples_filled_by(double length_mm) const {
    return static_cast<float>(length_mm * line_distance_mm_ / grid_.sample_mm2());
  }

  /// The cell of a sample in the box.
  [[nodiscard]] float& cell_at(CellField& field, std::size_t column, std::size_t row) const {
    return field.at((column - box_.first_column) >> cell_shift_,
                    (row - box_.first_row) >> cell_shift_);
  }

  const BitPlane& part_;
  const Polygons& polygons_;
  const SampleGrid& grid_;
  double line_distance_mm_;
  unsigned cell_shift_;  // of columns and rows to their cells
  std::size_t cell_steps_;
  double pieces_a_step_;
  SampleBox box_;
  CellField demanded_;  // in samples
  CellField laid_;
  std::vector<Columns> wanted_;  // of each row, from the first to the last that demands anything
};

/// Lays all beads, in all parts at once.
void lay_beads(std::span<PartLedger> parts, const SampleGrid& grid, const std::vector<Run>& runs,
               const Task& task) {
  double known_width_mm = 0;  // most beads are as wide as the one before
  double strength = 0;
  visit_beads(runs, [&](Point2 a, Point2 b, double width_mm) {
    if (width_mm != known_width_mm) {
      known_width_mm = width_mm;
      strength = task.mean_width_mm(width_mm) / task.spacing_mm();
    }
    const Point2 from = grid.to_steps(a);
    const Point2 to = grid.to_steps(b);
    const double length_mm = distance(a, b);
    for (PartLedger& part : parts) part.lay(from, to, length_mm, strength);
  });
}

}  // namespace

double skipped_area_mm2(const LayerSamples& samples, const Demand& demand,
                        const std::vector<Run>& runs, const Task& task) {
  std::vector<PartLedger> parts;
  parts.reserve(2);
  if (!demand.dense.empty()) parts.emplace_back(samples.dense, demand.dense, task.spacing_mm());
  if (!demand.sparse.empty() && task.density > 0)
    parts.emplace_back(samples.sparse, demand.sparse, task.spacing_mm() / task.density);
  lay_beads(parts, samples.grid, runs, task);
  double skipped = 0;
  for (PartLedger& part : parts) {
    part.lay_boundary();
    skipped += part.skipped_area_mm2();
  }
  return skipped;
}

}  // namespace routebench::judging
