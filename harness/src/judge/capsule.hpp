#pragma once
/// The rows of a bead: all points within a radius of a segment.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "judge/rounding.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {

/// Columns of a sample grid from `left` to `right`, or none if left > right. Those beyond the grid
/// count, too.
struct Span {
  std::int64_t left = std::numeric_limits<std::int64_t>::max();
  std::int64_t right = std::numeric_limits<std::int64_t>::min();

  [[nodiscard]] bool empty() const noexcept { return left > right; }
};

/// The columns from one place to another, in steps: however far away, for what is all but level may
/// meet a row anywhere.
[[nodiscard]] inline Span span_between(double left, double right) noexcept {
  constexpr double kFurthest = 1e18;
  return {rounded_up(std::clamp(left, -kFurthest, kFurthest)),
          rounded_down(std::clamp(right, -kFurthest, kFurthest))};
}

/// The row at height dy over the centre of a disc.
[[nodiscard]] inline Span disc_row(double centre_x, double dy, double radius) noexcept {
  const double square = radius * radius - dy * dy;
  if (square < 0) return {};
  const double half = std::sqrt(square);
  return span_between(centre_x - half, centre_x + half);
}

/// The boundary of a capsule by rows. A capsule is convex, hence one span a row, and upwards each
/// of the span's two ends runs along an arc of the lower disc, a straight side, and an arc of the
/// upper disc.
class CapsuleRows {
 public:
  CapsuleRows(Point2 a, Point2 b, double radius) noexcept
      : low_(a.y <= b.y ? a : b),
        high_(a.y <= b.y ? b : a),
        square_(radius * radius),
        first_(static_cast<double>(rounded_up(low_.y - radius))),
        last_(static_cast<double>(rounded_down(high_.y + radius))) {
    const Point2 run = high_ - low_;
    const double length = distance(low_, high_);
    double rise = 0;  // of the normal to the left, times the radius
    if (run.y > kLevel) {
      slope_ = run.x / run.y;
      half_width_ = radius * length / run.y;
      rise = radius * run.x / length;
    } else if (length > 0) {  // level: the arcs meet at the sides
      rise = run.x > 0 ? radius : -radius;
    }
    left_side_ = {low_.y + rise, high_.y + rise};
    right_side_ = {low_.y - rise, high_.y - rise};
  }

  /// Leaves out the rows at which there is nothing but the disc round a, given again.
  void leave_tip(Point2 a) noexcept {
    if (a == low_)
      first_ = std::max(
          first_, static_cast<double>(rounded_up(std::min(left_side_.begin, right_side_.begin))));
    else
      last_ = std::min(
          last_, static_cast<double>(rounded_down(std::max(left_side_.end, right_side_.end))));
  }

  /// Calls visit(row, span) for every row in [0, row_count) that the capsule meets.
  template <typename Visit>
  void visit(std::size_t row_count, Visit&& visit) const {
    const double last = std::min(last_, static_cast<double>(row_count) - 1);
    double y = std::max(first_, 0.0);
    if (!(y <= last)) return;
    auto row = static_cast<std::size_t>(y);
    // Before, at and after the rows at which both ends are on straight sides.
    const double first_between = std::max(left_side_.begin, right_side_.begin);
    const double last_between = std::min(left_side_.end, right_side_.end);
    for (const double end = std::min(first_between, last + 1); y < end; y += 1) visit(row++, at(y));
    if (const double end = std::min(last_between, last); y <= end) {
      const std::size_t first_row = row;
      row = static_cast<std::size_t>(rounded_down(end)) + 1;
      visit_between(first_row, row, visit);
      y = static_cast<double>(row);
    }
    for (; y <= last; y += 1) visit(row++, at(y));
  }

 private:
  /// Visits rows at which both ends are on straight sides. They move by as much from row to row: in
  /// whole numbers, as fractions of a step that are far below what tells samples apart, this takes
  /// an addition an end. Now and then they begin anew, lest errors add up.
  template <typename Visit>
  void visit_between(std::size_t row, std::size_t end_row, Visit& visit) const {
    constexpr std::size_t kRowsAtOnce = 64;
    constexpr int kFractionBits = 40;
    constexpr std::int64_t kStep = std::int64_t{1} << kFractionBits;
    constexpr double kFurthest = 1 << 21;  // what fits in, and twice that
    const auto fixed = [](double steps) {
      return static_cast<std::int64_t>(steps * static_cast<double>(kStep));
    };
    const bool fits = std::abs(low_.x) + half_width_ < kFurthest &&
                      std::abs(high_.x) + half_width_ < kFurthest &&
                      std::abs(slope_) * static_cast<double>(kRowsAtOnce) < kFurthest;
    const std::int64_t slope = fits ? fixed(slope_) : 0;
    while (row < end_row) {
      const double middle = low_.x + slope_ * (static_cast<double>(row) - low_.y);
      if (!fits) {
        visit(row++, span_between(middle - half_width_, middle + half_width_));
        continue;
      }
      std::int64_t left = fixed(middle - half_width_) + kStep - 1;  // down from here is up
      std::int64_t right = fixed(middle + half_width_);
      for (const std::size_t end = std::min(row + kRowsAtOnce, end_row); row < end; ++row) {
        visit(row, Span{left >> kFractionBits, right >> kFractionBits});
        left += slope;
        right += slope;
      }
    }
  }
  /// The row at any height that the capsule meets.
  [[nodiscard]] Span at(double y) const noexcept {
    // Both ends are on one arc as a rule: one square root.
    const bool low = y < std::max(left_side_.begin, right_side_.begin);
    const bool high = y > std::min(left_side_.end, right_side_.end);
    const double low_chord = low ? half_chord(y - low_.y) : 0;
    const double high_chord = high ? half_chord(y - high_.y) : 0;
    const auto end = [&](double sign, const Side& side) {
      if (y < side.begin) return low_.x + sign * low_chord;
      if (y > side.end) return high_.x + sign * high_chord;
      return low_.x + slope_ * (y - low_.y) + sign * half_width_;
    };
    return span_between(end(-1, left_side_), end(1, right_side_));
  }

  /// Lower than this a segment is taken as level: no row but one is met by its sides.
  static constexpr double kLevel = 1e-9;

  struct Side {
    double begin = 0;  ///< height at which it leaves the lower disc
    double end = 0;    ///< and that at which it reaches the upper one
  };

  /// Half the width of a disc's row.
  [[nodiscard]] double half_chord(double dy) const noexcept {
    return std::sqrt(std::max(square_ - dy * dy, 0.0));  // the tip may be beyond by rounding
  }

  Point2 low_;
  Point2 high_;
  double square_;
  double first_;  // row
  double last_;
  double slope_ = 0;
  double half_width_ = 0;
  Side left_side_;
  Side right_side_;
};

/// Calls visit(row, span) for every row in [0, row_count) that the capsule round segment ab meets.
/// All lengths are in steps.
template <typename Visit>
void visit_capsule_rows(Point2 a, Point2 b, double radius, std::size_t row_count, Visit&& visit) {
  CapsuleRows(a, b, radius).visit(row_count, std::forward<Visit>(visit));
}

}  // namespace routebench::judging
