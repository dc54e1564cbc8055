#pragma once
/// Columns or rows from one to another.

#include <algorithm>
#include <cstdint>

#include "judge/rounding.hpp"

namespace routebench::judging {

/// Columns or rows of a sample grid from `left` to `right`, or none if left > right. Those beyond
/// the grid count, too.
struct Span {
  std::int64_t left;
  std::int64_t right;
};

/// The columns from one place to another, in steps: however far away, for what is all but level may
/// meet a row anywhere.
[[nodiscard]] inline Span span_between(double left, double right) noexcept {
  constexpr double kFurthest = 1e18;
  return {rounded_up(std::clamp(left, -kFurthest, kFurthest)),
          rounded_down(std::clamp(right, -kFurthest, kFurthest))};
}

}  // namespace routebench::judging
