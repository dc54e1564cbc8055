#include "judge/samples_left.hpp"

#include <algorithm>

namespace routebench::judging {

bool SamplesLeft::any_near(Point2 lower, Point2 upper, double radius) const {
  return left_.any(span_between(lower.y - radius, upper.y + radius),
                   span_between(lower.x - radius, upper.x + radius));
}

void SamplesLeft::remove_capsule(Point2 a, Point2 b, double radius) {
  // Not by std::minmax, which compilers make branches of.
  if (!any_near({std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)},
                radius))
    return;
  left_.remove(Capsule(Segment(a, b), radius));
}

void SamplesLeft::remove(Point2 a, Point2 b, double radius_mm) {
  const SampleGrid& grid = left_.grid();
  remove_capsule(grid.to_steps(a), grid.to_steps(b), grid.to_steps(radius_mm));
}

void SamplesLeft::remove(std::span<const Point2> path, double radius_mm) {
  if (path.empty()) return;
  const SampleGrid& grid = left_.grid();
  const double radius = grid.to_steps(radius_mm);
  Point2 lower = grid.to_steps(path.front());
  Point2 upper = lower;
  for (const Point2 p : path.subspan(1)) {
    const Point2 steps = grid.to_steps(p);
    lower = {std::min(lower.x, steps.x), std::min(lower.y, steps.y)};
    upper = {std::max(upper.x, steps.x), std::max(upper.y, steps.y)};
  }
  if (!any_near(lower, upper, radius)) return;
  for (std::size_t i = 1; i < path.size(); ++i)
    remove_capsule(grid.to_steps(path[i - 1]), grid.to_steps(path[i]), radius);
}

bool SamplesLeft::empty() {
  for (; strip_ < left_.strips(); ++strip_, row_ = 0) {
    const BitPlane::Rows used = left_.used(strip_);
    for (row_ = std::max(row_, used.first); row_ < used.end; ++row_)
      if (left_.word(strip_, row_) != 0) return false;
  }
  return true;
}

void SamplesLeft::remove(const Polygons& polygons, double radius_mm) {
  const auto remove_ring = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      remove(ring[i == 0 ? ring.size() - 1 : i - 1], ring[i], radius_mm);
  };
  for (const Polygon& polygon : polygons) {
    remove_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) remove_ring(hole);
  }
}

}  // namespace routebench::judging
