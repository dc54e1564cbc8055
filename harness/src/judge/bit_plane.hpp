#pragma once
/// A set of samples, one bit each.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "judge/sample_grid.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// Samples of one grid, 64 in a word, rows beginning at a word. The grid must outlive the plane.
class BitPlane {
 public:
  using Word = std::uint64_t;
  static constexpr std::size_t kWordBits = 64;

  explicit BitPlane(const SampleGrid& grid)
      : grid_(&grid),
        row_words_((grid.columns() + kWordBits - 1) / kWordBits),
        words_(row_words_ * grid.rows()) {}

  /// The samples inside polygons. Cost linear in the samples' words and the rows that edges cross.
  BitPlane(const SampleGrid& grid, const Polygons& polygons);

  [[nodiscard]] const SampleGrid& grid() const noexcept { return *grid_; }
  [[nodiscard]] std::size_t row_words() const noexcept { return row_words_; }

  [[nodiscard]] const Word* row(std::size_t row) const { return words_.data() + row * row_words_; }
  [[nodiscard]] bool test(std::size_t column, std::size_t row) const {
    return (words_[row * row_words_ + column / kWordBits] >> (column % kWordBits) & 1U) != 0;
  }

  /// Adds the samples of a row from `left` to `right`, both in steps.
  void add(std::size_t row, double left, double right) {
    visit_words(row, left, right, [this](std::size_t i, Word mask) { words_[i] |= mask; });
  }

  /// Takes the samples away that `add` would add.
  void remove(std::size_t row, double left, double right) {
    visit_words(row, left, right, [this](std::size_t i, Word mask) { words_[i] &= ~mask; });
  }

  /// Keeps only samples that are in another plane of the same grid, too.
  void keep(const BitPlane& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
  }

  /// Takes the samples of another plane of the same grid away.
  void remove(const BitPlane& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
  }

  /// Adds samples as `add` does; those that were there already are added to `again` as well.
  void add_counting(std::size_t row, double left, double right, BitPlane& again) {
    visit_words(row, left, right, [this, &again](std::size_t i, Word mask) {
      again.words_[i] |= words_[i] & mask;
      words_[i] |= mask;
    });
  }

  [[nodiscard]] std::size_t count() const;

  /// Number of samples for which `word_of(word of this, word of others...)` is set.
  template <typename Combine, typename... Planes>
  [[nodiscard]] std::size_t count(Combine&& word_of, const Planes&... others) const {
    // Counting the bits of a word is a call on plain processors; counts of bytes are added up for
    // some words together, which compilers turn into vector instructions.
    constexpr std::size_t kTogether = 16;  // up to 31: a byte holds 255
    std::size_t set = 0;
    for (std::size_t i = 0; i < words_.size();) {
      const std::size_t end = std::min(i + kTogether, words_.size());
      Word bytes = 0;
      for (; i < end; ++i) bytes += bits_of_bytes(word_of(words_[i], others.words_[i]...));
      set += sum_of_bytes(bytes);
    }
    return set;
  }

 private:
  void flip_from(std::size_t row, double left);

  /// How many bits each byte of a word has.
  [[nodiscard]] static constexpr Word bits_of_bytes(Word word) noexcept {
    word -= word >> 1 & 0x5555555555555555U;
    word = (word & 0x3333333333333333U) + (word >> 2 & 0x3333333333333333U);
    return (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fU;
  }
  [[nodiscard]] static constexpr std::size_t sum_of_bytes(Word bytes) noexcept {
    bytes = (bytes & 0x00ff00ff00ff00ffU) + (bytes >> 8 & 0x00ff00ff00ff00ffU);
    return static_cast<std::size_t>(bytes * 0x0001000100010001U >> 48);
  }

  /// Calls visit(place of a word, mask) for the samples of a row from `left` to `right`.
  template <typename Visit>
  void visit_words(std::size_t row, double left, double right, Visit&& visit) {
    const double end_step = static_cast<double>(grid_->columns()) - 1;
    if (!(right >= 0 && left <= end_step)) return;
    // Rounding by conversion: std::ceil and std::floor are calls on plain processors.
    const double from = std::max(left, 0.0);
    auto first = static_cast<std::size_t>(static_cast<std::int64_t>(from));
    if (static_cast<double>(first) < from) ++first;
    const auto last =
        static_cast<std::size_t>(static_cast<std::int64_t>(std::min(right, end_step)));
    if (first > last) return;
    const Word from_first = ~Word{0} << (first % kWordBits);
    const Word to_last = ~Word{0} >> (kWordBits - 1 - last % kWordBits);
    const std::size_t begin = row * row_words_ + first / kWordBits;
    const std::size_t end = row * row_words_ + last / kWordBits;
    if (begin == end) {
      visit(begin, from_first & to_last);
      return;
    }
    visit(begin, from_first);
    for (std::size_t i = begin + 1; i < end; ++i) visit(i, ~Word{0});
    visit(end, to_last);
  }

  const SampleGrid* grid_;
  std::size_t row_words_;
  std::vector<Word> words_;
};

}  // namespace routebench::judging
