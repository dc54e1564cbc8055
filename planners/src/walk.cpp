#include "routebench/planning/walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {

Walk::Walk(const Ring& ring, const RingPlace& from, bool forward)
    : points_(path_along(ring, from, from)) {
  if (!forward) std::reverse(points_.begin(), points_.end());
  along_mm_.push_back(0);
  for (std::size_t i = 1; i < points_.size(); ++i)
    along_mm_.push_back(along_mm_.back() + distance(points_[i - 1], points_[i]));
}

Point2 Walk::at(double mm) const {
  const auto next = std::upper_bound(along_mm_.begin(), along_mm_.end(), mm);
  if (next == along_mm_.end()) return points_.back();
  if (next == along_mm_.begin()) return points_.front();
  const auto i = static_cast<std::size_t>(next - along_mm_.begin());
  return lerp(points_[i - 1], points_[i],
              (mm - along_mm_[i - 1]) / (along_mm_[i] - along_mm_[i - 1]));
}

Walk::Near Walk::nearest(Point2 p) const {
  Near best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Point2 foot = nearest_on_segment(p, points_[i - 1], points_[i]);
    const double squared = squared_distance(p, foot);
    if (squared >= least) continue;
    least = squared;
    best.along_mm = along_mm_[i - 1] + distance(points_[i - 1], foot);
  }
  best.distance_mm = std::sqrt(least);
  return best;
}

void Walk::append(double from_mm, double to_mm, std::vector<Point2>& out) const {
  go_to(at(from_mm), out);
  for (auto i = static_cast<std::size_t>(
           std::upper_bound(along_mm_.begin(), along_mm_.end(), from_mm) - along_mm_.begin());
       i < points_.size() && along_mm_[i] < to_mm; ++i)
    go_to(points_[i], out);
  go_to(at(to_mm), out);
}

void go_to(Point2 p, std::vector<Point2>& polyline) {
  if (const Point2 q = snap(p); polyline.empty() || polyline.back() != q) polyline.push_back(q);
}

}  // namespace routebench
