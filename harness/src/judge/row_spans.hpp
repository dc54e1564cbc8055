#pragma once
/// What a shape meets of the rows of a grid.

#include <cstddef>
#include <cstdint>

namespace routebench::judging {

/// Columns 64 w to 64 w + 63 of a row are bits of its word w, the first of them the lowest.
inline constexpr std::size_t kWordBits = 64;

/// Some rows one after the other, and of each the columns from `left` to before `end`, or none if
/// end <= left, less those from `cut_left` to before `cut_end`. All columns lie on the grid, but
/// for those that are cut.
struct RowSpans {
  static constexpr std::size_t kMost = 64;  ///< rows
  static constexpr std::size_t kRoom = 8;   ///< rows of memory beyond the last one

  std::size_t first_row = 0;
  std::size_t count = 0;  ///< of rows
  // All columns lie in words first_word to before end_word.
  std::size_t first_word = 0;
  std::size_t end_word = 0;
  bool is_cut = false;  ///< false if nothing is cut and the cuts may hold anything

  // Beyond the last row there are none. (Arrays of the language: files that are compiled for some
  // processor are to share no functions with others.)
  std::int64_t left[kMost + kRoom];
  std::int64_t end[kMost + kRoom];
  std::int64_t cut_left[kMost + kRoom];
  std::int64_t cut_end[kMost + kRoom];
};

}  // namespace routebench::judging
