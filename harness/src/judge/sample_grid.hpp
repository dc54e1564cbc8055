#pragma once
/// Where areas are sampled: a square grid of points, turned against the axes.

#include <cmath>
#include <cstddef>

#include "routebench/geometry/types.hpp"

namespace routebench::judging {

/// How many rows and columns of samples there are.
struct GridSize {
  std::size_t rows = 0;
  std::size_t columns = 0;
};

/// Sample points over the bounding box of polygons. Parts and the lines that fill them mostly run
/// along the axes or at 45 degrees; a grid along the axes would meet them in step and be wrong by
/// several percent of the area. This one is turned by 0.3 rad, which leaves its error two orders of
/// magnitude below that.
///
/// Places are given in sample steps: the sample in column i of row j lies at (i, j). The grid moves
/// with the polygons, so that a translation changes nothing but rounding.
class SampleGrid {
 public:
  /// Takes the pitch that is wanted; the grid's own is wider if there would be more than
  /// max_samples of it. `margin_mm` is added on every side. No polygons, no samples.
  SampleGrid(const Polygons& polygons, double margin_mm, double pitch_mm, double max_samples);

  [[nodiscard]] Point2 to_steps(Point2 p) const noexcept {
    return {(kCos * p.x + kSin * p.y - lower_.x) * steps_a_mm_ - 0.5,
            (kCos * p.y - kSin * p.x - lower_.y) * steps_a_mm_ - 0.5};
  }
  [[nodiscard]] double to_steps(double length_mm) const noexcept { return length_mm * steps_a_mm_; }

  [[nodiscard]] double pitch_mm() const noexcept { return pitch_mm_; }
  [[nodiscard]] double sample_mm2() const noexcept { return pitch_mm_ * pitch_mm_; }
  [[nodiscard]] std::size_t columns() const noexcept { return size_.columns; }
  [[nodiscard]] std::size_t rows() const noexcept { return size_.rows; }
  [[nodiscard]] GridSize size() const noexcept { return size_; }

  /// Between which shares of its length a segment, in steps, runs over the samples.
  struct Shares {
    double enter = 0;
    double leave = 0;  ///< equal to enter if it does not
  };
  [[nodiscard]] Shares shares_over(Point2 from, Point2 to) const noexcept;

 private:
  // Written out, since the last digit of a library's sine may differ between machines.
  static constexpr double kCos = 0.955336489125606;
  static constexpr double kSin = 0.29552020666133955;

  Point2 lower_;  // in the turned frame, mm
  double pitch_mm_;
  double steps_a_mm_ = 1;
  GridSize size_;
};

}  // namespace routebench::judging
