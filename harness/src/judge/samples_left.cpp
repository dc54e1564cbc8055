#include "judge/samples_left.hpp"

#include <algorithm>

namespace routebench::judging {

bool SamplesLeft::any_near(Point2 a, Point2 b, double radius) const {
  const auto [left, right] = std::minmax(a.x, b.x);
  const auto [lower, upper] = std::minmax(a.y, b.y);
  return left_.any(span_between(lower - radius, upper + radius),
                   span_between(left - radius, right + radius));
}

void SamplesLeft::remove(Point2 a, Point2 b, double radius_mm) {
  const SampleGrid& grid = left_.grid();
  const Point2 from = grid.to_steps(a);
  const Point2 to = grid.to_steps(b);
  const double radius = grid.to_steps(radius_mm);
  if (!any_near(from, to, radius)) return;
  Capsule(Segment(from, to), radius).visit(grid.size(), [this](const RowSpans& rows) {
    left_.remove(rows);
  });
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
