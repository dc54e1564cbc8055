#pragma once
/// A set of samples, one bit each.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "judge/capsule.hpp"
#include "judge/sample_grid.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// Samples of one grid, 64 in a word, rows beginning at a word. The grid must outlive the plane.
///
/// Of every row a plane knows between which words it may have samples: all but making it for the
/// first time on a thread costs no more than what lies between.
class BitPlane {
 public:
  using Word = std::uint64_t;
  static constexpr std::size_t kWordBits = 64;

  /// Words of a row, from the first to before the end.
  struct Words {
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t end = 0;

    [[nodiscard]] bool empty() const noexcept { return first >= end; }
  };

  explicit BitPlane(const SampleGrid& grid);

  /// The samples inside polygons. Cost linear in the samples' words and the rows that edges cross.
  BitPlane(const SampleGrid& grid, const Polygons& polygons);

  /// The samples of a plane for which `word_of(word of it, word of others...)` is set; all planes
  /// are of the same grid.
  template <typename Combine, typename... Planes>
  BitPlane(const BitPlane& plane, Combine&& word_of, const Planes&... others)
      : BitPlane(*plane.grid_) {
    for (std::size_t row = 0; row < plane.used_.size(); ++row) {
      used_[row] = plane.used_[row];
      plane.visit_row(row, [&](std::size_t i) {
        words_[i] = plane.words_[i] & word_of(plane.words_[i], others.words_[i]...);
      });
    }
  }

  BitPlane(BitPlane&&) noexcept = default;
  BitPlane& operator=(BitPlane&&) = delete;
  ~BitPlane();

  [[nodiscard]] const SampleGrid& grid() const noexcept { return *grid_; }

  [[nodiscard]] const Word* row(std::size_t row) const { return words_.data() + row * row_words_; }
  /// Where row() may have samples.
  [[nodiscard]] Words used(std::size_t row) const { return used_[row]; }
  [[nodiscard]] bool test(std::size_t column, std::size_t row) const {
    return (words_[row * row_words_ + column / kWordBits] >> (column % kWordBits) & 1U) != 0;
  }

  /// Whether there is a sample in a box, which may reach beyond the grid.
  [[nodiscard]] bool any(Span rows, Span columns) const {
    const std::int64_t first = std::max<std::int64_t>(rows.left, 0);
    const std::int64_t last = std::min(rows.right, static_cast<std::int64_t>(grid_->rows()) - 1);
    if (first > last) return false;
    Word found = 0;
    visit_words(static_cast<std::size_t>(first), columns.left, columns.right,
                [&](std::size_t i, Word mask) {
                  for (std::int64_t row = first; row <= last; ++row, i += row_words_)
                    found |= words_[i] & mask;
                });
    return found != 0;
  }

  /// Adds the samples of a row from column `left` to column `right`, which may lie beyond the grid.
  void add(std::size_t row, std::int64_t left, std::int64_t right) {
    use(row,
        visit_words(row, left, right, [this](std::size_t i, Word mask) { words_[i] |= mask; }));
  }

  /// Takes the samples away that `add` would add.
  void remove(std::size_t row, std::int64_t left, std::int64_t right) {
    visit_words(row, left, right, [this](std::size_t i, Word mask) { words_[i] &= ~mask; });
  }

  /// Adds samples as `add` does; those that were there already are added to `again` as well.
  void add_counting(std::size_t row, std::int64_t left, std::int64_t right, BitPlane& again) {
    Word met = 0;
    const Words words =
        visit_words(row, left, right, [this, &again, &met](std::size_t i, Word mask) {
          // Most samples are passed once: the other plane's memory is left alone.
          if (const Word both = words_[i] & mask; both != 0) {
            again.words_[i] |= both;
            met |= both;
          }
          words_[i] |= mask;
        });
    use(row, words);
    if (met != 0) again.use(row, words);
  }

  [[nodiscard]] std::size_t count() const;

  /// Number of samples here for which `word_of(word of this, word of others...)` is set.
  template <typename Combine, typename... Planes>
  [[nodiscard]] std::size_t count(Combine&& word_of, const Planes&... others) const {
    // Counting the bits of a word is a call on plain processors; counts of bytes are added up for
    // some words together, which compilers turn into vector instructions.
    constexpr std::size_t kTogether = 16;  // up to 31: a byte holds 255
    std::size_t set = 0;
    for (std::size_t row = 0; row < used_.size(); ++row) {
      if (used_[row].empty()) continue;
      const std::size_t row_end = row * row_words_ + used_[row].end;
      for (std::size_t i = row * row_words_ + used_[row].first; i < row_end;) {
        const std::size_t end = std::min(i + kTogether, row_end);
        Word bytes = 0;
        for (; i < end; ++i)
          bytes += bits_of_bytes(words_[i] & word_of(words_[i], others.words_[i]...));
        set += sum_of_bytes(bytes);
      }
    }
    return set;
  }

 private:
  void flip_from(std::size_t row, double left);

  void use(std::size_t row, Words words) {
    Words& used = used_[row];
    used.first = std::min(used.first, words.first);
    used.end = std::max(used.end, words.end);
  }

  /// Calls visit(place of a word) for a row's words that may have samples.
  template <typename Visit>
  void visit_row(std::size_t row, Visit&& visit) const {
    const std::size_t end = row * row_words_ + used_[row].end;
    if (used_[row].empty()) return;
    for (std::size_t i = row * row_words_ + used_[row].first; i < end; ++i) visit(i);
  }

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

  /// Calls visit(place of a word, mask) for the samples of a row from `left` to `right`; returns
  /// their words.
  template <typename Visit>
  Words visit_words(std::size_t row, std::int64_t left, std::int64_t right, Visit&& visit) const {
    left = std::max<std::int64_t>(left, 0);
    right = std::min(right, static_cast<std::int64_t>(grid_->columns()) - 1);
    if (left > right) return {};
    const auto first = static_cast<std::size_t>(left);
    const auto last = static_cast<std::size_t>(right);
    const Word from_first = ~Word{0} << (first % kWordBits);
    const Word to_last = ~Word{0} >> (kWordBits - 1 - last % kWordBits);
    const std::size_t begin = row * row_words_ + first / kWordBits;
    const std::size_t end = row * row_words_ + last / kWordBits;
    const Words words{static_cast<std::uint32_t>(first / kWordBits),
                      static_cast<std::uint32_t>(last / kWordBits + 1)};
    if (begin == end) {
      visit(begin, from_first & to_last);
      return words;
    }
    visit(begin, from_first);
    for (std::size_t i = begin + 1; i < end; ++i) visit(i, ~Word{0});
    visit(end, to_last);
    return words;
  }

  const SampleGrid* grid_;
  std::size_t row_words_;
  std::vector<Word> words_;  // at least those of the rows; all but the used ones are 0
  std::vector<Words> used_;  // of each row
};

}  // namespace routebench::judging
