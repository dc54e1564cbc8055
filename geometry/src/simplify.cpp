#include "routebench/geometry/simplify.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

/// Marks what is needed of the stretch between two points.
void mark_needed(const std::vector<Point2>& points, std::size_t first, std::size_t last,
                 double tolerance_mm, std::vector<bool>& needed) {
  std::vector<std::pair<std::size_t, std::size_t>> stretches{{first, last}};
  while (!stretches.empty()) {
    const auto [from, to] = stretches.back();
    stretches.pop_back();
    needed[from] = needed[to] = true;
    double farthest = tolerance_mm * tolerance_mm;
    std::size_t at = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const Point2 foot = nearest_on_segment(points[i], points[from], points[to]);
      if (squared_distance(points[i], foot) <= farthest) continue;
      farthest = squared_distance(points[i], foot);
      at = i;
    }
    if (at == from) continue;
    stretches.emplace_back(from, at);
    stretches.emplace_back(at, to);
  }
}

std::vector<Point2> needed_points(const std::vector<Point2>& points,
                                  const std::vector<bool>& needed) {
  std::vector<Point2> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (needed[i]) kept.push_back(points[i]);
  return kept;
}

}  // namespace

std::vector<Point2> simplified(const std::vector<Point2>& points, double tolerance_mm) {
  if (points.size() < 3) return points;
  std::vector<bool> needed(points.size(), false);
  mark_needed(points, 0, points.size() - 1, tolerance_mm, needed);
  return needed_points(points, needed);
}

Ring simplified_ring(Ring ring, double tolerance_mm) {
  if (ring.size() < 3) return ring;
  const auto before = [](Point2 a, Point2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), before), ring.end());
  const auto farthest = std::max_element(ring.begin(), ring.end(), [&](Point2 a, Point2 b) {
    return squared_distance(a, ring.front()) < squared_distance(b, ring.front());
  });
  const auto middle = static_cast<std::size_t>(farthest - ring.begin());
  ring.push_back(ring.front());
  std::vector<bool> needed(ring.size(), false);
  mark_needed(ring, 0, middle, tolerance_mm, needed);
  mark_needed(ring, middle, ring.size() - 1, tolerance_mm, needed);
  ring = needed_points(ring, needed);
  ring.pop_back();
  return ring;
}

}  // namespace routebench
