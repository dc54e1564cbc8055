#pragma once
/// What judging does over and over, as loops that are compiled for several kinds of processors.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "judge/row_spans.hpp"

namespace routebench::judging {

/// The boundary of a capsule: upwards each end of its rows runs along an arc of the lower disc, a
/// straight side from height `begin` to height `end`, and an arc of the upper disc. In steps.
struct CapsuleShape {
  struct Side {
    double begin = 0;
    double end = 0;
  };
  double low_x = 0;  ///< centre of the lower disc
  double low_y = 0;
  double high_x = 0;
  double high_y = 0;
  double square = 0;      ///< of the radius
  double slope = 0;       ///< of the centre line: columns a row
  double half_width = 0;  ///< along a row, between the straight sides
  Side left;
  Side right;
};

struct DiscShape {
  double x = 0;  ///< of the centre
  double y = 0;
  double square = 0;  ///< of the radius
};

/// A straight line: where it is at which height. In steps.
struct LineShape {
  double x = 0;  ///< at height y
  double y = 0;
  double slope = 0;  ///< columns a row

  [[nodiscard]] double at(double height) const noexcept { return x + (height - y) * slope; }
};

/// Words of a grid's rows, strip by strip: first word 0 of every row, then word 1 of every row and
/// so on. What is done to rows one after the other is then done to words one after the other. All
/// but the used ones are 0.
struct StripWords {
  /// Rows of a strip, from the first to before the end.
  struct Rows {
    std::size_t first = 0;
    std::size_t end = 0;
  };
  static constexpr std::size_t kRoom = 8;  ///< words beyond the last strip, 0 as well

  const std::uint64_t* words = nullptr;
  std::size_t rows = 0;
  std::size_t strips = 0;
  const Rows* used = nullptr;  ///< of each strip
};

/// The loops as one kind of processor takes them. All kinds give the same to the last bit.
struct RowLoops {
  static constexpr std::size_t kFloatRoom = 16;

  const char* name;

  /// Sets left and end of rows [begin, end), which meet the capsule, on a grid of so many columns.
  /// Spoils those of the room after them.
  void (*rows)(const CapsuleShape& shape, std::size_t columns, std::size_t begin, std::size_t end,
               RowSpans& spans);
  /// The same for rows at which both ends are on straight sides.
  void (*straight_rows)(const CapsuleShape& shape, std::size_t columns, std::size_t begin,
                        std::size_t end, RowSpans& spans);
  /// Cuts a disc out of rows [begin, end), nothing out of all others.
  void (*cut_disc)(const DiscShape& disc, std::size_t begin, std::size_t end, RowSpans& spans);

  /// Adds what spans hold to words of a grid of so many rows; see StripWords.
  void (*add)(const RowSpans& spans, std::uint64_t* words, std::size_t rows);
  /// Takes it away.
  void (*remove)(const RowSpans& spans, std::uint64_t* words, std::size_t rows);
  /// Adds it; what was there already is added to `again` as well. Returns whether anything was.
  bool (*add_counting)(const RowSpans& spans, std::uint64_t* words, std::uint64_t* again,
                       std::size_t rows);

  /// Flips in rows [begin, end) the columns from a line on, as far as they are in the word that the
  /// line meets (the first one if it is left of the grid), if that is one of strips
  /// [first_strip, end_strip).
  void (*flip)(const LineShape& line, std::size_t begin, std::size_t end, std::size_t first_strip,
               std::size_t end_strip, std::uint64_t* words, std::size_t rows);
  /// Flips all bits of those words of a strip whose carry is set, as all bits or none; then carry
  /// says so of their last bits. Neither has room.
  void (*fill)(std::uint64_t* words, std::uint64_t* carry, std::size_t rows);

  /// How many bits are set, and set in `with`, and not set in `without`: words of the same grid, or
  /// null. None without `with`.
  std::size_t (*count)(const StripWords& plane, const std::uint64_t* with,
                       const std::uint64_t* without);

  /// Sets to[0 .. count) to the sum, term by term, of each weight times from[term][0 .. count).
  /// Reads and writes up to kFloatRoom numbers beyond these.
  void (*weighted_sum)(const float* const* from, const float* weights, std::size_t terms, float* to,
                       std::size_t count);
};

/// Those that this processor can run, the fastest last.
[[nodiscard]] std::vector<const RowLoops*> runnable_row_loops();

/// The fastest of them.
[[nodiscard]] const RowLoops& row_loops() noexcept;

extern const RowLoops kPlainLoops;
// Where the build makes them.
extern const RowLoops kAvx2Loops;
extern const RowLoops kAvx512Loops;

}  // namespace routebench::judging
