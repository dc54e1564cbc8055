#pragma once
/// Where evenly spaced lines cross rings, found in three ways.

#include <cstdint>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// The lines y = first_mm + i step_mm for i in [0, count). step_mm > 0.
struct EvenLines {
  double first_mm = 0;
  double step_mm = 1;
  std::uint32_t count = 0;

  [[nodiscard]] double y(std::uint32_t line) const noexcept { return first_mm + line * step_mm; }
  /// The first line with y(line) >= y; count if there is none.
  [[nodiscard]] std::uint32_t first_at_or_above(double y) const noexcept;
};

struct Crossing {
  double x = 0;
  std::uint32_t line = 0;
  std::uint32_t ring = 0;
  std::uint32_t edge = 0;  ///< from the ring's vertex of this number to the next one
  friend bool operator==(const Crossing&, const Crossing&) = default;
};

/// How crossings are found. Source   K. De Keyser, 2016, who went from the second to the third.
enum class CrossingSearch {
  kBucket,  ///< every edge pushes its crossings into the lines that it spans: linear
  kNaive,   ///< every line looks at every edge
  kSweep,   ///< edges enter and leave a set as the line rises
};

/// Every crossing, by line and then by x. An edge spans a line from its lower end, which counts, to
/// its upper end, which does not: a vertex on a line counts once where the ring goes through it,
/// twice or not at all where it turns back. So every line has an even number of crossings. All
/// three ways give the same.
[[nodiscard]] std::vector<Crossing> cross_lines(const std::vector<Ring>& rings,
                                                const EvenLines& lines, CrossingSearch search);

}  // namespace routebench
