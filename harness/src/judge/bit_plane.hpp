#pragma once
/// A set of samples, one bit each.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "judge/capsule.hpp"
#include "judge/row_loops.hpp"
#include "judge/sample_grid.hpp"
#include "judge/span.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// Samples of one grid, strip by strip as in StripWords. The grid must outlive the plane.
///
/// Of every strip a plane knows between which rows it may have samples: all but making it for the
/// first time on a thread costs no more than what lies between.
class BitPlane {
 public:
  using Word = std::uint64_t;
  using Rows = StripWords::Rows;
  static constexpr std::size_t kWordBits = judging::kWordBits;

  /// No samples.
  explicit BitPlane(const SampleGrid& grid);

  /// The samples inside polygons. Cost linear in the samples' words and the rows that edges cross.
  BitPlane(const SampleGrid& grid, const Polygons& polygons);

  /// The samples of a plane for which `word_of(word of it, word of others...)` is set; all planes
  /// are of the same grid.
  template <typename Combine, typename... Planes>
  BitPlane(const BitPlane& plane, Combine&& word_of, const Planes&... others)
      : BitPlane(*plane.grid_) {
    used_ = plane.used_;
    for (std::size_t strip = 0; strip < used_.size(); ++strip)
      for (std::size_t row = used_[strip].first; row < used_[strip].end; ++row) {
        const std::size_t i = place(strip, row);
        words_[i] = plane.words_[i] & word_of(plane.words_[i], others.words_[i]...);
      }
  }

  BitPlane(BitPlane&&) noexcept = default;
  BitPlane& operator=(BitPlane&&) = delete;
  ~BitPlane();

  [[nodiscard]] const SampleGrid& grid() const noexcept { return *grid_; }

  [[nodiscard]] std::size_t strips() const noexcept { return used_.size(); }
  /// Where a strip may have samples: of these rows first may be beyond end.
  [[nodiscard]] Rows used(std::size_t strip) const { return used_[strip]; }
  [[nodiscard]] Word word(std::size_t strip, std::size_t row) const {
    return words_[place(strip, row)];
  }
  [[nodiscard]] bool test(std::size_t column, std::size_t row) const {
    return (word(column / kWordBits, row) >> (column % kWordBits) & 1U) != 0;
  }

  /// Whether there is a sample in a box, which may reach beyond the grid.
  [[nodiscard]] bool any(Span rows, Span columns) const {
    const std::int64_t first = std::max<std::int64_t>(rows.left, 0);
    const std::int64_t last = std::min(rows.right, static_cast<std::int64_t>(grid_->rows()) - 1);
    if (first > last) return false;
    const auto count = static_cast<std::size_t>(last - first + 1);
    Word found = 0;
    visit_strips(columns.left, columns.right, [&](std::size_t strip, Word mask) {
      const Word* const words = words_.data() + place(strip, static_cast<std::size_t>(first));
      Word in_strip = 0;
      for (std::size_t i = 0; i < count; ++i) in_strip |= words[i];
      found |= in_strip & mask;
    });
    return found != 0;
  }

  /// Adds the samples of a row from column `left` to column `right`, which may lie beyond the grid.
  void add(std::size_t row, std::int64_t left, std::int64_t right) {
    visit_strips(left, right, [this, row](std::size_t strip, Word mask) {
      words_[place(strip, row)] |= mask;
      use(strip, row, row + 1);
    });
  }

  /// Adds the samples that a capsule holds.
  void add(const Capsule& capsule) {
    capsule.visit(grid_->size(), [&](const CapsuleShape& shape, const GridPart& part) {
      row_loops().add(shape, part, words_.data(), grid_->rows());
      use(part);
    });
  }

  /// Takes the samples away that `add` would add.
  void remove(const Capsule& capsule) {
    capsule.visit(grid_->size(), [&](const CapsuleShape& shape, const GridPart& part) {
      row_loops().remove(shape, part, words_.data(), grid_->rows());
    });
  }

  /// Adds samples as `add` does; those that were there already are added to `again` as well.
  void add_counting(const Capsule& capsule, BitPlane& again) {
    capsule.visit(grid_->size(), [&](const CapsuleShape& shape, const GridPart& part) {
      if (row_loops().add_counting(shape, part, words_.data(), again.words_.data(), grid_->rows()))
        again.use(part);
      use(part);
    });
  }

  [[nodiscard]] std::size_t count() const { return count_in(nullptr, nullptr); }
  /// Number of samples that another plane has, too.
  [[nodiscard]] std::size_t count_in(const BitPlane& with) const {
    return count_in(&with, nullptr);
  }
  /// The same less those that a third one has.
  [[nodiscard]] std::size_t count_in(const BitPlane& with, const BitPlane& without) const {
    return count_in(&with, &without);
  }

 private:
  [[nodiscard]] std::size_t place(std::size_t strip, std::size_t row) const {
    return strip * grid_->rows() + row;
  }
  [[nodiscard]] std::size_t count_in(const BitPlane* with, const BitPlane* without) const;
  void flip_right_of(Point2 a, Point2 b);
  void fill_between_flips();

  /// Notes that a strip may have samples in some rows.
  void use(std::size_t strip, std::size_t first, std::size_t end) {
    used_[strip].first = std::min(used_[strip].first, first);
    used_[strip].end = std::max(used_[strip].end, end);
  }
  void use(const GridPart& part) {
    for (std::size_t strip = part.first_word; strip < part.end_word; ++strip)
      use(strip, part.first_row, part.end_row);
  }

  /// Calls visit(strip, mask) for the columns from `left` to `right` that are on the grid.
  template <typename Visit>
  void visit_strips(std::int64_t left, std::int64_t right, Visit&& visit) const {
    left = std::max<std::int64_t>(left, 0);
    right = std::min(right, static_cast<std::int64_t>(grid_->columns()) - 1);
    if (left > right) return;
    const auto first = static_cast<std::size_t>(left);
    const auto last = static_cast<std::size_t>(right);
    for (std::size_t strip = first / kWordBits; strip <= last / kWordBits; ++strip) {
      Word mask = ~Word{0};
      if (strip == first / kWordBits) mask &= ~Word{0} << (first % kWordBits);
      if (strip == last / kWordBits) mask &= ~Word{0} >> (kWordBits - 1 - last % kWordBits);
      visit(strip, mask);
    }
  }

  const SampleGrid* grid_;
  std::vector<Rows> used_;   // of each strip
  std::vector<Word> words_;  // at least those of the strips and their room
};

}  // namespace routebench::judging
