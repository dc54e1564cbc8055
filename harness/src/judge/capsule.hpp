#pragma once
/// The rows of a bead: all points within a radius of a segment.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "judge/rounding.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {

/// From `left` to `right`, in steps of a sample grid; nothing if left > right.
struct Span {
  double left = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const noexcept { return left > right; }
};

/// The row at height dy over the centre of a disc.
[[nodiscard]] inline Span disc_row(double centre_x, double dy, double radius) noexcept {
  const double square = radius * radius - dy * dy;
  if (square < 0) return {};
  const double half = std::sqrt(square);
  return {centre_x - half, centre_x + half};
}

/// The boundary of a capsule by rows. A capsule is convex, hence one span a row, and upwards each
/// of the span's two ends runs along an arc of the lower disc, a straight side, and an arc of the
/// upper disc.
class CapsuleRows {
 public:
  CapsuleRows(Point2 a, Point2 b, double radius) noexcept
      : low_(a.y <= b.y ? a : b), high_(a.y <= b.y ? b : a), square_(radius * radius) {
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

  /// Rows at which both ends are on straight sides.
  [[nodiscard]] double first_between() const noexcept {
    return std::max(left_side_.begin, right_side_.begin);
  }
  [[nodiscard]] double last_between() const noexcept {
    return std::min(left_side_.end, right_side_.end);
  }
  /// The row at such a height.
  [[nodiscard]] Span between(double y) const noexcept {
    const double middle = low_.x + slope_ * (y - low_.y);
    return {middle - half_width_, middle + half_width_};
  }
  /// The row at any height that the capsule meets.
  [[nodiscard]] Span at(double y) const noexcept {
    const auto end = [this, y](double sign, const Side& side) {
      if (y < side.begin) return low_.x + sign * half_chord(y - low_.y);
      if (y > side.end) return high_.x + sign * half_chord(y - high_.y);
      return low_.x + slope_ * (y - low_.y) + sign * half_width_;
    };
    return {end(-1, left_side_), end(1, right_side_)};
  }

 private:
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
  double slope_ = 0;
  double half_width_ = 0;
  Side left_side_;
  Side right_side_;
};

/// Calls visit(row, span) for every row in [0, row_count) that the capsule round segment ab meets.
/// All lengths are in steps.
template <typename Visit>
void visit_capsule_rows(Point2 a, Point2 b, double radius, std::size_t row_count, Visit&& visit) {
  const auto first = std::max(static_cast<double>(rounded_up(std::min(a.y, b.y) - radius)), 0.0);
  const auto last = std::min(static_cast<double>(rounded_down(std::max(a.y, b.y) + radius)),
                             static_cast<double>(row_count) - 1);
  if (!(first <= last)) return;
  const CapsuleRows rows(a, b, radius);
  double y = first;
  auto row = static_cast<std::size_t>(first);
  for (const double end = std::min(rows.first_between(), last + 1); y < end; y += 1)
    visit(row++, rows.at(y));
  for (const double end = std::min(rows.last_between(), last); y <= end; y += 1)
    visit(row++, rows.between(y));
  for (; y <= last; y += 1) visit(row++, rows.at(y));
}

}  // namespace routebench::judging
