#include "routebench/geometry/simplify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <utility>

#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

constexpr std::size_t kUsualPoints = 256;  // of a ring, or fewer

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

/// The directions in which a straight side may leave a point and pass within the tolerance of all
/// points that it skips.
class Cone {
 public:
  Cone(Point2 apex, double tolerance_mm) : apex_(apex), tolerance_mm_(tolerance_mm) {}

  /// Whether a side from the apex may end here.
  [[nodiscard]] bool admits(Point2 p) {
    const Point2 way = p - apex_;
    // What has been skipped must lie between the ends, so nothing may turn back.
    if (dot(way, way) < squared_reach_) return false;
    if (!is_narrowed_) return true;
    if (!has_sides_) {
      if (is_clear_of_first(way)) return false;
      make_sides();
    }
    return cross(right_, way) >= 0 && cross(way, left_) >= 0;
  }

  /// From now on sides must pass this point, which the cone admits.
  void narrow(Point2 p) {
    const Point2 way = p - apex_;
    squared_reach_ = dot(way, way);
    if (squared_reach_ <= tolerance_mm_ * tolerance_mm_) return;  // near to any side
    if (!is_narrowed_) {
      first_ = way;
      is_narrowed_ = true;
      return;
    }
    if (!has_sides_) make_sides();
    const Point2 aside = aside_of(way), right = way - aside, left = way + aside;
    if (cross(right_, right) > 0) right_ = right;
    if (cross(left_, left) < 0) left_ = left;
  }

 private:
  /// Across a way, as long as the tolerance.
  [[nodiscard]] Point2 aside_of(Point2 way) const {
    return (tolerance_mm_ / std::sqrt(dot(way, way))) * Point2{-way.y, way.x};
  }

  void make_sides() {
    const Point2 aside = aside_of(first_);
    right_ = first_ - aside;
    left_ = first_ + aside;
    has_sides_ = true;
  }

  /// Whether a way leaves the cone that the first point makes, and not just by rounding: as at most
  /// corners, where it takes no root to tell.
  [[nodiscard]] bool is_clear_of_first(Point2 way) const {
    constexpr double kRounding = 1 + 1e-6;
    const double along = dot(first_, way), across = cross(first_, way);
    return along < 0 || across * across * dot(first_, first_) >
                            kRounding * tolerance_mm_ * tolerance_mm_ * along * along;
  }

  Point2 apex_;
  double tolerance_mm_;
  double squared_reach_ = 0;
  bool is_narrowed_ = false;
  bool has_sides_ = false;
  Point2 first_;         ///< the way to the point that has narrowed the cone first
  Point2 right_, left_;  ///< the cone's sides, once they are needed
};

/// A corner of the ring's hull. In a direction as odd as this one no side of a drawing is upright,
/// so noise does not decide which corner it is.
std::size_t farthest_corner(const Ring& ring) {
  constexpr Point2 kDirection{1, 0.3819660112501051};
  const auto nearer = [&](Point2 a, Point2 b) { return dot(a, kDirection) < dot(b, kDirection); };
  return static_cast<std::size_t>(std::max_element(ring.begin(), ring.end(), nearer) -
                                  ring.begin());
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

Ring straightened_ring(const Ring& ring, double tolerance_mm) {
  if (ring.size() < 3) return ring;
  const std::size_t n = ring.size(), first = farthest_corner(ring);
  const auto at = [&](std::size_t i) { return ring[first + i < n ? first + i : first + i - n]; };
  const auto keep_needed = [&](auto& kept) {
    kept.push_back(at(0));
    Cone cone(at(0), tolerance_mm);
    for (std::size_t i = 1; i <= n; ++i) {
      const Point2 p = at(i == n ? 0 : i);
      if (!cone.admits(p)) {
        kept.push_back(at(i - 1));
        cone = Cone(kept.back(), tolerance_mm);
      }
      cone.narrow(p);
    }
  };
  if (n > kUsualPoints) {
    Ring kept;
    keep_needed(kept);
    return kept;
  }
  // Most points of most rings go; what is left would grow step by step.
  alignas(Point2) std::array<std::byte, kUsualPoints * sizeof(Point2)> usual;
  std::pmr::monotonic_buffer_resource memory(usual.data(), usual.size());
  std::pmr::vector<Point2> kept(&memory);
  kept.reserve(n);
  keep_needed(kept);
  return {kept.begin(), kept.end()};
}

}  // namespace routebench
