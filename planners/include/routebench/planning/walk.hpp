#pragma once
/// Once round a ring, by the length gone.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/ring_path.hpp"

namespace routebench {

/// The way from a place of a ring once round and back to it.
class Walk {
 public:
  Walk(const Ring& ring, const RingPlace& from, bool forward);

  [[nodiscard]] const std::vector<Point2>& points() const noexcept { return points_; }
  [[nodiscard]] double length_mm() const noexcept { return along_mm_.back(); }
  /// Length gone at a point.
  [[nodiscard]] double along_mm(std::size_t point) const { return along_mm_[point]; }
  [[nodiscard]] Point2 at(double mm) const;

  struct Near {
    double along_mm = 0;
    double distance_mm = 0;
  };
  /// Where the walk passes nearest to p. Cost   linear.
  [[nodiscard]] Near nearest(Point2 p) const;

  /// Appends the stretch between two lengths, both ends included.
  void append(double from_mm, double to_mm, std::vector<Point2>& out) const;

 private:
  std::vector<Point2> points_;
  std::vector<double> along_mm_;
};

/// Appends a point, on the grid, unless the polyline ends there.
void go_to(Point2 p, std::vector<Point2>& polyline);

}  // namespace routebench
