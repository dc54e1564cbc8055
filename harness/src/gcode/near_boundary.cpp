#include "gcode/near_boundary.hpp"

#include <algorithm>
#include <cstddef>

#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

/// Points by height, and for some levels the first one that is not below.
class ByHeight {
 public:
  struct Point {
    Point2 place;
    double limit_mm;
    std::size_t query;
  };

  explicit ByHeight(const std::vector<NearQuery>& queries) : begin_(queries.size() + 2) {
    for (std::size_t i = 0; i < queries.size(); ++i)
      points_.push_back({queries[i].point, queries[i].limit_mm, i});
    std::sort(points_.begin(), points_.end(),
              [](const Point& a, const Point& b) { return a.place.y < b.place.y; });
    if (points_.empty()) return;
    lowest_mm_ = points_.front().place.y;
    const double height_mm = points_.back().place.y - lowest_mm_;
    if (height_mm > 0) levels_a_mm_ = static_cast<double>(queries.size()) / height_mm;
    std::size_t next = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::size_t level = level_of(points_[i].place.y);
      while (next <= level) begin_[next++] = i;
    }
    while (next < begin_.size()) begin_[next++] = points_.size();
  }

  [[nodiscard]] const Point* first_from(double y) const {
    const Point* first = points_.data() + begin_[level_of(y)];
    while (first != end() && first->place.y < y) ++first;
    return first;
  }
  [[nodiscard]] const Point* end() const { return points_.data() + points_.size(); }

 private:
  /// Those beyond the highest point are one level.
  [[nodiscard]] std::size_t level_of(double y) const {
    const double level = (y - lowest_mm_) * levels_a_mm_;
    return static_cast<std::size_t>(std::clamp(level, 0.0, static_cast<double>(begin_.size() - 1)));
  }

  std::vector<Point> points_;
  std::vector<std::size_t> begin_;  // of each level: how many points are below
  double lowest_mm_ = 0;
  double levels_a_mm_ = 0;
};

}  // namespace

std::vector<bool> near_boundary(const Polygons& polygons, const std::vector<NearQuery>& queries) {
  std::vector<bool> near(queries.size(), false);
  const ByHeight points(queries);
  double reach_mm = 0;
  for (const NearQuery& query : queries) reach_mm = std::max(reach_mm, query.limit_mm);

  // Not by std::minmax, which compilers make branches of.
  const auto add_edge = [&](Point2 a, Point2 b) {
    const double left = std::min(a.x, b.x), right = std::max(a.x, b.x);
    const double highest = std::max(a.y, b.y) + reach_mm;
    for (const ByHeight::Point* at = points.first_from(std::min(a.y, b.y) - reach_mm);
         at != points.end() && at->place.y <= highest; ++at) {
      const auto& [p, limit_mm, query] = *at;
      if (near[query] || p.x < left - limit_mm || p.x > right + limit_mm) continue;
      near[query] = distance(p, nearest_on_segment(p, a, b)) <= limit_mm;
    }
  };
  const auto add_ring = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      add_edge(ring[i == 0 ? ring.size() - 1 : i - 1], ring[i]);
  };
  for (const Polygon& polygon : polygons) {
    add_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) add_ring(hole);
  }
  return near;
}

}  // namespace routebench
