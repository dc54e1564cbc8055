#pragma once
/// The rows of a bead: all points within a radius of a segment.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {

/// From `left` to `right`, in steps of a sample grid; nothing if left > right.
struct Span {
  double left = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool empty() const noexcept { return left > right; }
  /// Widens this to hold another; exact where the two make up one span.
  void widen(Span other) noexcept {
    left = std::min(left, other.left);
    right = std::max(right, other.right);
  }
};

/// The row at height dy over the centre of a disc.
[[nodiscard]] inline Span disc_row(double centre_x, double dy, double radius) noexcept {
  const double square = radius * radius - dy * dy;
  if (square < 0) return {};
  const double half = std::sqrt(square);
  return {centre_x - half, centre_x + half};
}

/// The rows of the rectangle between the two discs of a capsule: |cross| <= radius and
/// 0 <= dot <= length are two ranges of x, both linear in the height.
class RectangleRows {
 public:
  RectangleRows(Point2 a, Point2 b, double radius) noexcept : a_(a) {
    const double length = distance(a, b);
    const Point2 along = length > 0 ? (1 / length) * (b - a) : Point2{1, 0};
    if (along.y != 0) {
      side_slope_ = along.x / along.y;
      half_width_ = radius / std::abs(along.y);
    }
    if (along.x != 0) {
      end_slope_ = -along.y / along.x;
      first_end_ = std::min(0.0, length / along.x);
      last_end_ = std::max(0.0, length / along.x);
    } else {
      lowest_ = std::min(0.0, b.y - a.y);
      highest_ = std::max(0.0, b.y - a.y);
    }
  }

  [[nodiscard]] Span at(double dy) const noexcept {
    if (dy < lowest_ || dy > highest_) return {};
    return {a_.x + std::max(side_slope_ * dy - half_width_, end_slope_ * dy + first_end_),
            a_.x + std::min(side_slope_ * dy + half_width_, end_slope_ * dy + last_end_)};
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  Point2 a_;
  double side_slope_ = 0;  // of the long sides, x over y
  double half_width_ = kInfinity;
  double end_slope_ = 0;  // of the short sides
  double first_end_ = -kInfinity;
  double last_end_ = kInfinity;
  double lowest_ = -kInfinity;
  double highest_ = kInfinity;
};

/// Calls visit(row, span of the capsule, span of the disc round a) for every row in [0, row_count)
/// that the capsule round segment ab meets. All lengths are in steps. A capsule is convex, hence
/// one span a row: from its two discs and the rectangle between them.
template <typename Visit>
void visit_capsule_rows(Point2 a, Point2 b, double radius, std::size_t row_count, Visit&& visit) {
  const RectangleRows rectangle(a, b, radius);
  const double first = std::max(std::ceil(std::min(a.y, b.y) - radius), 0.0);
  const double last =
      std::min(std::floor(std::max(a.y, b.y) + radius), static_cast<double>(row_count) - 1);
  for (double y = first; y <= last; y += 1) {
    const Span start = disc_row(a.x, y - a.y, radius);
    Span row = start;
    row.widen(disc_row(b.x, y - b.y, radius));
    if (const Span between = rectangle.at(y - a.y); !between.empty()) row.widen(between);
    if (!row.empty()) visit(static_cast<std::size_t>(y), row, start);
  }
}

}  // namespace routebench::judging
