#include "judge/sample_grid.hpp"

#include <algorithm>
#include <limits>

#include "routebench/geometry/vec.hpp"

namespace routebench::judging {

SampleGrid::SampleGrid(const Polygons& polygons, double margin_mm, double pitch_mm,
                       double max_samples)
    : pitch_mm_(pitch_mm) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point2 lower{kInfinity, kInfinity};
  Point2 upper{-kInfinity, -kInfinity};
  for (const Polygon& polygon : polygons)
    for (const Point2 p : polygon.outer) {
      const Point2 turned{kCos * p.x + kSin * p.y, kCos * p.y - kSin * p.x};
      lower = {std::min(lower.x, turned.x), std::min(lower.y, turned.y)};
      upper = {std::max(upper.x, turned.x), std::max(upper.y, turned.y)};
    }
  if (lower.x > upper.x) return;
  lower_ = lower - Point2{margin_mm, margin_mm};
  const Point2 size = upper - lower + Point2{2 * margin_mm, 2 * margin_mm};
  // Both bounds: of the area, and of the longer side where the box is all but a line.
  pitch_mm_ = std::max(
      {pitch_mm, std::sqrt(size.x * size.y / max_samples), std::max(size.x, size.y) / max_samples});
  steps_a_mm_ = 1 / pitch_mm_;
  size_.columns = static_cast<std::size_t>(size.x / pitch_mm_) + 1;
  size_.rows = static_cast<std::size_t>(size.y / pitch_mm_) + 1;
}

SampleGrid::Shares SampleGrid::shares_over(Point2 from, Point2 to) const noexcept {
  const auto is_over = [this](Point2 p) {
    return p.x >= -0.5 && p.y >= -0.5 && p.x <= static_cast<double>(size_.columns) - 0.5 &&
           p.y <= static_cast<double>(size_.rows) - 0.5;
  };
  Shares shares{0, 1};
  if (is_over(from) && is_over(to)) return shares;
  const Point2 run = to - from;
  // Narrows the shares to those between two opposite sides of the box.
  const auto clip = [&shares](double start, double step, std::size_t count) {
    const double low = -0.5 - start;
    const double high = static_cast<double>(count) - 0.5 - start;
    if (step == 0) {
      if (low > 0 || high < 0) shares.leave = 0;
      return;
    }
    const auto [first, last] = std::minmax({low / step, high / step});
    shares.enter = std::max(shares.enter, first);
    shares.leave = std::min(shares.leave, last);
  };
  clip(from.x, run.x, size_.columns);
  clip(from.y, run.y, size_.rows);
  return shares.enter < shares.leave ? shares : Shares{};
}

}  // namespace routebench::judging
