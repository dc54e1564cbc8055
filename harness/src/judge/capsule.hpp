#pragma once
/// The rows of a bead: all points within a radius of a segment.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "judge/rounding.hpp"
#include "judge/row_loops.hpp"
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
        length_(distance(low_, high_)) {
    if (run_.y > kLevel) {
      slope_ = run_.x / run_.y;
      stretch_ = length_ / run_.y;
      lean_ = run_.x / length_;
    } else if (length_ > 0) {  // the arcs meet at the sides
      lean_ = run_.x > 0 ? 1 : -1;
    }
  }

 private:
  friend class Capsule;
  /// Lower than this a segment is taken as level: no row but one is met by its sides.
  static constexpr double kLevel = 1e-9;

  Point2 low_;
  Point2 high_;
  bool begins_low_;
  Point2 run_;
  double length_;
  double slope_ = 0;    // columns a row
  double stretch_ = 0;  // length a row
  double lean_ = 0;     // of the normal to the left, its share that goes upwards
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
               .radius = radius,
               .slope = segment.slope_,
               .half_width = radius * segment.stretch_,
               .left = {},
               .right = {},
               .begins_low = segment.begins_low_},
        first_(static_cast<double>(rounded_up(segment.low_.y - radius))),
        last_(static_cast<double>(rounded_down(segment.high_.y + radius))) {
    const double rise = radius * segment.lean_;
    shape_.left = {shape_.low_y + rise, shape_.high_y + rise};
    shape_.right = {shape_.low_y - rise, shape_.high_y - rise};
  }

  /// Leaves out the rows at which there is nothing but the disc round the segment's first point.
  void leave_start() noexcept {
    if (shape_.begins_low)
      first_ = std::max(
          first_, static_cast<double>(rounded_up(std::min(shape_.left.begin, shape_.right.begin))));
    else
      last_ = std::min(
          last_, static_cast<double>(rounded_down(std::max(shape_.left.end, shape_.right.end))));
  }

  /// Takes the disc round the segment's first point away. A sample on its rim belongs to it.
  void cut_start() noexcept {
    leave_start();
    shape_.is_cut = true;
  }

  /// Calls visit(shape, part) for parts of a grid that hold all of the grid's samples in the
  /// capsule, each once.
  template <typename Visit>
  void visit(GridSize grid, Visit&& visit) const {
    const double first = std::max(first_, 0.0);
    const double last = std::min(last_, static_cast<double>(grid.rows) - 1);
    if (!(first <= last)) return;
    const auto end = static_cast<std::size_t>(static_cast<std::int64_t>(last)) + 1;
    GridPart part;
    part.columns = grid.columns;
    for (part.first_row = static_cast<std::size_t>(static_cast<std::int64_t>(first));
         part.first_row < end; part.first_row = part.end_row) {
      part.end_row = std::min(part.first_row + kRowsAtOnce, end);
      set_words(part);
      if (part.first_word < part.end_word) visit(shape_, part);
    }
  }

 private:
  /// So few that a slanted capsule meets few words in them.
  static constexpr std::size_t kRowsAtOnce = 64;

  void set_words(GridPart& part) const noexcept;

  CapsuleShape shape_;
  double first_;  // row
  double last_;
};

}  // namespace routebench::judging
