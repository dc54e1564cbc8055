#pragma once
/// What judging does over and over, as loops that are compiled for several kinds of processors.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace routebench::judging {

/// Columns 64 w to 64 w + 63 of a row are bits of its word w, the first of them the lowest.
inline constexpr std::size_t kWordBits = 64;

/// All points within a radius of a segment: of each row one span. Upwards each of its ends runs
/// along an arc of the lower disc, a straight side from height `begin` to height `end`, and an arc
/// of the upper disc. In steps.
struct CapsuleShape {
  struct Side {
    double begin = 0;
    double end = 0;
  };
  double low_x = 0;  ///< centre of the lower disc
  double low_y = 0;
  double high_x = 0;
  double high_y = 0;
  double radius = 0;
  double slope = 0;       ///< of the centre line: columns a row
  double half_width = 0;  ///< along a row, between the straight sides
  Side left;
  Side right;
  bool begins_low = true;  ///< the segment's first point is the centre of the lower disc
  bool is_cut = false;     ///< the disc round that point is left out
};

/// Rows of a grid that a shape meets, and the words in which it does.
struct GridPart {
  std::size_t first_row = 0;
  std::size_t end_row = 0;
  std::size_t first_word = 0;
  std::size_t end_word = 0;
  std::size_t columns = 0;  ///< of the grid: what lies beyond is left out
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

  /// Adds what a capsule holds of a part of a grid to the grid's words, of so many rows; see
  /// StripWords.
  void (*add)(const CapsuleShape& shape, const GridPart& part, std::uint64_t* words,
              std::size_t rows);
  /// Takes it away.
  void (*remove)(const CapsuleShape& shape, const GridPart& part, std::uint64_t* words,
                 std::size_t rows);
  /// Adds it; what was there already is added to `again` as well. Returns whether anything was.
  bool (*add_counting)(const CapsuleShape& shape, const GridPart& part, std::uint64_t* words,
                       std::uint64_t* again, std::size_t rows);

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
