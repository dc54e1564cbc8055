#pragma once
/// The rows of a bead: all points within a radius of a segment.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "judge/rounding.hpp"
#include "judge/row_loops.hpp"
#include "judge/row_spans.hpp"
#include "judge/sample_grid.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {

/// A segment, of which capsules of several radii are made. All lengths are in steps.
class Segment {
 public:
  Segment(Point2 a, Point2 b) noexcept
      : low_(a.y <= b.y ? a : b),
        high_(a.y <= b.y ? b : a),
        begins_low_(a.y <= b.y),
        run_(high_ - low_),
        length_(distance(low_, high_)),
        slope_(run_.y > kLevel ? run_.x / run_.y : 0) {}

 private:
  friend class Capsule;
  /// Lower than this a segment is taken as level: no row but one is met by its sides.
  static constexpr double kLevel = 1e-9;

  Point2 low_;
  Point2 high_;
  bool begins_low_;
  Point2 run_;
  double length_;
  double slope_;
};

/// All points within a radius of a segment. It is convex, hence one span a row. All lengths are in
/// steps.
class Capsule {
 public:
  Capsule(const Segment& segment, double radius) noexcept
      : shape_{.low_x = segment.low_.x,
               .low_y = segment.low_.y,
               .high_x = segment.high_.x,
               .high_y = segment.high_.y,
               .square = radius * radius,
               .slope = segment.slope_,
               .left = {},
               .right = {}},
        radius_(radius),
        first_(static_cast<double>(rounded_up(segment.low_.y - radius))),
        last_(static_cast<double>(rounded_down(segment.high_.y + radius))),
        begins_low_(segment.begins_low_) {
    double rise = 0;  // of the normal to the left, times the radius
    if (segment.run_.y > Segment::kLevel) {
      shape_.half_width = radius * segment.length_ / segment.run_.y;
      rise = radius * segment.run_.x / segment.length_;
    } else if (segment.length_ > 0) {  // the arcs meet at the sides
      rise = segment.run_.x > 0 ? radius : -radius;
    }
    shape_.left = {shape_.low_y + rise, shape_.high_y + rise};
    shape_.right = {shape_.low_y - rise, shape_.high_y - rise};
  }

  /// Leaves out the rows at which there is nothing but the disc round the segment's first point.
  void leave_start() noexcept {
    if (begins_low_)
      first_ = std::max(
          first_, static_cast<double>(rounded_up(std::min(shape_.left.begin, shape_.right.begin))));
    else
      last_ = std::min(
          last_, static_cast<double>(rounded_down(std::max(shape_.left.end, shape_.right.end))));
  }

  /// Calls visit(rows) with all rows of a grid that the capsule meets, some at a time, upwards.
  /// What is visited may be changed.
  template <typename Visit>
  void visit(GridSize grid, Visit&& visit) const {
    const double first = std::max(first_, 0.0);
    const double last = std::min(last_, static_cast<double>(grid.rows) - 1);
    if (!(first <= last)) return;
    RowSpans rows;
    const auto end = static_cast<std::size_t>(static_cast<std::int64_t>(last)) + 1;
    for (rows.first_row = static_cast<std::size_t>(static_cast<std::int64_t>(first));
         rows.first_row < end; rows.first_row += rows.count) {
      rows.count = std::min(end - rows.first_row, RowSpans::kMost);
      if (fill(rows, grid.columns)) visit(rows);
    }
  }

  /// Takes the disc round the segment's first point away from rows of the capsule.
  void cut_start(RowSpans& rows) const noexcept;

 private:
  /// False if the capsule meets none of the rows on the grid.
  [[nodiscard]] bool fill(RowSpans& rows, std::size_t columns) const noexcept;
  void set_words(RowSpans& rows, std::size_t columns) const noexcept;

  CapsuleShape shape_;
  double radius_;
  double first_;  // row
  double last_;
  bool begins_low_;
};

}  // namespace routebench::judging
