#include "slicing/slivers.hpp"

#include <cmath>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::slicing {
namespace {

/// The way round a ring along x and y only, with a little to spare: at least as long as the ring,
/// and found without roots.
double most_perimeter_mm(const Ring& ring) {
  constexpr double kForRounding = 1 + 1e-9;
  double sum = 0;
  Point2 a = ring.back();
  for (const Point2 b : ring) {
    sum += std::abs(b.x - a.x) + std::abs(b.y - a.y);
    a = b;
  }
  return sum * kForRounding;
}

}  // namespace

bool is_sliver(const Ring& ring, double width_mm) {
  if (ring.empty()) return true;
  const double twice_area = 2 * std::abs(signed_area_mm2(ring));
  return twice_area <= width_mm * most_perimeter_mm(ring) &&
         twice_area <= width_mm * perimeter_mm(ring);
}

Ring without_spikes(const Ring& ring, double width_mm) {
  const auto is_near = [&](Point2 p, Point2 a, Point2 b) {
    return squared_distance(p, nearest_on_segment(p, a, b)) <= width_mm * width_mm;
  };
  Ring kept;
  kept.reserve(ring.size());
  const auto drop_tips = [&](Point2 next) {
    while (kept.size() >= 2) {
      const Point2 before = kept[kept.size() - 2], tip = kept.back();
      if (dot(tip - before, next - tip) >= 0) return;
      if (!is_near(next, before, tip) && !is_near(before, tip, next)) return;
      kept.pop_back();
    }
  };
  for (const Point2 p : ring) {
    drop_tips(p);
    kept.push_back(p);
  }
  if (!ring.empty()) drop_tips(ring.front());
  return kept;
}

Polygons without_slivers(Polygons polygons, double width_mm) {
  const auto is_narrow = [&](const Ring& ring) { return is_sliver(ring, width_mm); };
  std::erase_if(polygons, [&](const Polygon& polygon) { return is_narrow(polygon.outer); });
  for (Polygon& polygon : polygons) std::erase_if(polygon.holes, is_narrow);
  return polygons;
}

}  // namespace routebench::slicing
