#pragma once
/// Nearest points, with removal.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {

/// Balanced k-d tree in flat arrays: the node of a range of `order_` is its middle, and splits by x
/// and y in turn. Balanced whatever the points are; clusters and repeated points do no harm.
/// Cost   construction O(n log n), removal O(log n), nearest O(log n) typical.
class PointTree {
 public:
  explicit PointTree(std::span<const Point2> points)
      : points_(points.begin(), points.end()),
        order_(points.size()),
        position_(points.size()),
        left_over_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    build({0, order_.size(), false});
    for (std::uint32_t i = 0; i < order_.size(); ++i) position_[order_[i]] = i;
  }

  /// Takes a point that has not been removed.
  void remove(std::uint32_t point) {
    Range range{0, order_.size(), false};
    while (true) {
      --left_over_[range.middle()];
      if (position_[point] == range.middle()) break;
      range = position_[point] < range.middle() ? range.below() : range.above();
    }
    position_[point] = kRemoved;
  }

  /// The nearest other point that has not been removed; of equally near ones the lowest.
  [[nodiscard]] std::optional<std::uint32_t> nearest_to(std::uint32_t point) const {
    std::pair best{std::numeric_limits<double>::infinity(), kRemoved};
    visit(points_[point], best.first, [&](std::uint32_t other, double distance2) {
      if (other != point) best = std::min(best, std::pair{distance2, other});
      return best.first;
    });
    return best.second == kRemoved ? std::nullopt : std::optional(best.second);
  }

  /// The `count` nearest other points that have not been removed, nearest first.
  [[nodiscard]] std::vector<std::uint32_t> nearest_to(std::uint32_t point,
                                                      std::size_t count) const {
    std::vector<std::pair<double, std::uint32_t>> heap;  // the farthest on top
    const double everywhere = std::numeric_limits<double>::infinity();
    visit(points_[point], everywhere, [&](std::uint32_t other, double distance2) {
      if (other != point) {
        heap.emplace_back(distance2, other);
        std::push_heap(heap.begin(), heap.end());
        if (heap.size() > count) {
          std::pop_heap(heap.begin(), heap.end());
          heap.pop_back();
        }
      }
      return heap.size() < count ? everywhere : heap.front().first;
    });
    std::sort_heap(heap.begin(), heap.end());
    std::vector<std::uint32_t> nearest;
    for (const auto& [distance2, other] : heap) nearest.push_back(other);
    return nearest;
  }

  /// Calls visit(point) for every point that has not been removed and is no farther than reach_mm.
  template <typename Visit>
  void for_each_within(Point2 place, double reach_mm, Visit&& visit_point) const {
    const double reach2 = reach_mm * reach_mm;
    visit(place, reach2, [&](std::uint32_t point, double distance2) {
      if (distance2 <= reach2) visit_point(point);
      return reach2;
    });
  }

 private:
  static constexpr std::uint32_t kRemoved = std::numeric_limits<std::uint32_t>::max();

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
    left_over_[range.middle()] = static_cast<std::uint32_t>(range.end - range.begin);
    build(range.below());
    build(range.above());
  }

  /// Calls see(point, squared distance) for the points that may be no farther than the square root
  /// of limit2, nearer halves first; it returns the limit from then on.
  template <typename See>
  void visit(Point2 place, double limit2, See&& see) const {
    visit_range({0, order_.size(), false}, place, limit2, see);
  }

  template <typename See>
  void visit_range(Range range, Point2 place, double& limit2, See& see) const {
    if (range.begin == range.end || left_over_[range.middle()] == 0) return;
    const std::uint32_t point = order_[range.middle()];
    if (position_[point] != kRemoved) limit2 = see(point, squared_distance(place, points_[point]));
    const double beyond = range.by_y ? place.y - points_[point].y : place.x - points_[point].x;
    visit_range(beyond < 0 ? range.below() : range.above(), place, limit2, see);
    if (beyond * beyond <= limit2)
      visit_range(beyond < 0 ? range.above() : range.below(), place, limit2, see);
  }

  std::vector<Point2> points_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> position_;   // of each point in order_; kRemoved
  std::vector<std::uint32_t> left_over_;  // of the range whose middle this is: not yet removed
};

}  // namespace routebench
