#pragma once
/// Where a bead runs through square cells.

#include <algorithm>
#include <cstddef>

#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// The one of `count` cells in a row, each from k to k + 1, that holds a place, or else the
/// nearest.
[[nodiscard]] inline std::size_t nearest_cell(double place, std::size_t count) noexcept {
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
}

/// Calls visit(row, left, right) for rows of cells, row k from height k to k + 1: for all that the
/// capsule round segment ab meets, and it meets them between left and right. It may be called for a
/// few more. All lengths are in cells.
template <typename Visit>
void visit_cell_rows(Point2 a, Point2 b, double radius, std::size_t row_count, Visit&& visit) {
  const auto [lower, upper] = std::minmax(a.y, b.y);
  const std::size_t first = nearest_cell(lower - radius, row_count);
  const std::size_t last = nearest_cell(upper + radius, row_count);
  const Point2 way{b.x - a.x, b.y - a.y};
  constexpr std::size_t kFewRows = 3;  // in which there is little to gain
  const bool whole = last - first < kFewRows || way.y == 0;
  for (std::size_t row = first; row <= last; ++row) {
    // Of the segment, what is no higher or lower than the radius over or under the row.
    const double bottom = static_cast<double>(row) - radius - a.y;
    const double top = bottom + 1 + 2 * radius;
    const auto share = [&way](double rise) { return std::clamp(rise / way.y, 0.0, 1.0); };
    const double enter = whole ? 0 : share(bottom);
    const double leave = whole ? 1 : share(top);
    const auto [left, right] = std::minmax({a.x + enter * way.x, a.x + leave * way.x});
    visit(row, left - radius, right + radius);
  }
}

}  // namespace routebench::judging
