#pragma once
/// Points near a point.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {

/// Balanced k-d tree in one flat array: the node of a range is its middle, and splits by x and y in
/// turn. Balanced whatever the points are; clusters and repeated points do no harm.
/// Cost   construction O(n log n), the k nearest O(k log n) typical.
class PointTree {
 public:
  explicit PointTree(std::span<const Point2> points) : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    build({0, order_.size(), false});
  }

  /// The `count` nearest other points of the tree; all of them if there are fewer.
  [[nodiscard]] std::vector<std::uint32_t> nearest(std::uint32_t point, std::size_t count) const {
    std::vector<std::pair<double, std::uint32_t>> heap;  // the farthest on top
    double limit2 = std::numeric_limits<double>::infinity();
    visit({0, order_.size(), false}, points_[point], limit2,
          [&](std::uint32_t other, double distance2) {
            if (other == point) return;
            heap.emplace_back(distance2, other);
            std::push_heap(heap.begin(), heap.end());
            if (heap.size() > count) {
              std::pop_heap(heap.begin(), heap.end());
              heap.pop_back();
            }
            if (heap.size() == count) limit2 = heap.front().first;
          });
    std::vector<std::uint32_t> nearest;
    for (const auto& [distance2, other] : heap) nearest.push_back(other);
    return nearest;
  }

  /// Calls visit_point(point) for every point of the tree that is no farther than reach_mm.
  template <typename Visit>
  void for_each_within(Point2 place, double reach_mm, Visit&& visit_point) const {
    const double reach2 = reach_mm * reach_mm;
    visit({0, order_.size(), false}, place, reach2, [&](std::uint32_t point, double distance2) {
      if (distance2 <= reach2) visit_point(point);
    });
  }

 private:
  struct Range {
    std::size_t begin, end;
    bool by_y;
    [[nodiscard]] std::size_t middle() const { return begin + (end - begin) / 2; }
    [[nodiscard]] Range below() const { return {begin, middle(), !by_y}; }
    [[nodiscard]] Range above() const { return {middle() + 1, end, !by_y}; }
  };

  void build(Range range) {
    if (range.begin == range.end) return;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      return range.by_y ? points_[a].y < points_[b].y : points_[a].x < points_[b].x;
    };
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(range.begin), at(range.middle()), at(range.end), before);
    build(range.below());
    build(range.above());
  }

  /// Calls see(point, squared distance) for all points whose squared distance is not above limit2,
  /// and for some others, nearer halves first. `see` may lower the limit.
  template <typename See>
  void visit(Range range, Point2 place, const double& limit2, const See& see) const {
    if (range.begin == range.end) return;
    const std::uint32_t point = order_[range.middle()];
    see(point, squared_distance(place, points_[point]));
    const double beyond = range.by_y ? place.y - points_[point].y : place.x - points_[point].x;
    visit(beyond < 0 ? range.below() : range.above(), place, limit2, see);
    if (beyond * beyond <= limit2)
      visit(beyond < 0 ? range.above() : range.below(), place, limit2, see);
  }

  std::span<const Point2> points_;
  std::vector<std::uint32_t> order_;
};

}  // namespace routebench
