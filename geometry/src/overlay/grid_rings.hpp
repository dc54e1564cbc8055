#pragma once
/// Closed rings of whole grid units, as overlays work on them.

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

namespace routebench::overlay {

/// A place on the grid of layers. Coordinates stay within kMaxUnits, so that differences fit into
/// 32 bits and cross products into 64.
struct GridPoint {
  std::int32_t x = 0;
  std::int32_t y = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
  friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

/// Ordered as points are, and compared at once.
[[nodiscard]] inline std::int64_t order_of(GridPoint p) noexcept {
  return std::int64_t{p.x} * (std::int64_t{1} << 32) + p.y;
}

inline constexpr std::int32_t kMaxUnits = (1 << 30) - 1;  // 1024 mm

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Twice the area of triangle abc; positive where c lies to the left of ab.
[[nodiscard]] inline std::int64_t turn(GridPoint a, GridPoint b, GridPoint c) noexcept {
  return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

/// How often the rings of two sets run round a place.
struct Winding {
  std::int32_t first = 0;
  std::int32_t second = 0;
  friend bool operator==(const Winding&, const Winding&) = default;
  friend Winding operator+(Winding a, Winding b) {
    return {a.first + b.first, a.second + b.second};
  }
  friend Winding operator-(Winding a, Winding b) {
    return {a.first - b.first, a.second - b.second};
  }
};

struct GridBox {
  GridPoint lower;
  GridPoint upper;

  [[nodiscard]] bool meets(const GridBox& other) const {
    return lower.x <= other.upper.x && other.lower.x <= upper.x && lower.y <= other.upper.y &&
           other.lower.y <= upper.y;
  }
};

/// Takes at least one point.
[[nodiscard]] inline GridBox box_of(std::span<const GridPoint> points) {
  GridBox box{points.front(), points.front()};
  for (const GridPoint p : points) {
    box.lower = {std::min(box.lower.x, p.x), std::min(box.lower.y, p.y)};
    box.upper = {std::max(box.upper.x, p.x), std::max(box.upper.y, p.y)};
  }
  return box;
}

/// Positive if the ring turns left. Takes at least one point.
[[nodiscard]] inline double twice_area(std::span<const GridPoint> ring) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum += static_cast<double>(turn(ring[0], ring[i], ring[i + 1]));
  return sum;
}

/// Many rings in one array.
class GridRings {
 public:
  explicit GridRings(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : points_(memory), starts_(memory) {}
  GridRings(const GridRings& others, std::pmr::memory_resource* memory)
      : points_(others.points_, memory), starts_(others.starts_, memory) {}

  /// Where the rings lie. What is made of them lies there, too.
  [[nodiscard]] std::pmr::memory_resource* memory() const {
    return points_.get_allocator().resource();
  }

  /// Begins a ring; what lies to its left is run round `winding` times more.
  void begin_ring(Winding winding) { starts_.push_back({size(), winding}); }
  /// Adds a point to the last ring, unless it repeats the one before.
  void add(GridPoint p) {
    if (points_.size() > starts_.back().point && points_.back() == p) return;
    points_.push_back(p);
  }
  /// Ends the last ring. Rings of fewer than three points enclose nothing and are dropped.
  void end_ring() {
    const std::size_t begin = starts_.back().point;
    while (points_.size() > begin + 1 && points_.back() == points_[begin]) points_.pop_back();
    if (points_.size() >= begin + 3) return;
    points_.resize(begin);
    starts_.pop_back();
  }

  /// Adds rings of others, but none whose box is clear of the box of what is `near`.
  void add_near(const GridRings& others, const GridRings& near, Winding winding) {
    const GridBox box = box_of(near.points_);
    for (std::uint32_t i = 0; i < others.rings(); ++i) {
      const std::span<const GridPoint> points = others.ring(i);
      if (!box.meets(box_of(points))) continue;
      begin_ring(winding);
      points_.insert(points_.end(), points.begin(), points.end());
    }
  }

  [[nodiscard]] std::uint32_t rings() const { return static_cast<std::uint32_t>(starts_.size()); }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size()); }
  [[nodiscard]] std::uint32_t begin(std::uint32_t ring) const { return starts_[ring].point; }
  [[nodiscard]] std::uint32_t end(std::uint32_t ring) const {
    return ring + 1 < rings() ? begin(ring + 1) : size();
  }
  [[nodiscard]] std::span<const GridPoint> ring(std::uint32_t ring) const {
    return {points_.data() + begin(ring), points_.data() + end(ring)};
  }
  [[nodiscard]] Winding winding(std::uint32_t ring) const { return starts_[ring].winding; }
  [[nodiscard]] const std::pmr::vector<GridPoint>& points() const { return points_; }
  void reserve(std::size_t points) { points_.reserve(points); }
  /// For so many points more.
  void make_room(std::size_t points) {
    const std::size_t needed = points_.size() + points;
    if (needed > points_.capacity()) points_.reserve(std::max(needed, 2 * points_.capacity()));
  }

 private:
  /// Of a ring.
  struct Start {
    std::uint32_t point;
    Winding winding;
  };

  std::pmr::vector<GridPoint> points_;
  std::pmr::vector<Start> starts_;
};

}  // namespace routebench::overlay
