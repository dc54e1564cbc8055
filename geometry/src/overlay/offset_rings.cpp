#include "overlay/offset_rings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace routebench::overlay {
namespace {

struct Vector {
  double x = 0;
  double y = 0;
};

GridPoint moved(GridPoint p, Vector by) {
  const auto rounded = [](double v) {
    return static_cast<std::int32_t>(v < 0 ? v - 0.5 : v + 0.5);
  };
  return {rounded(p.x + by.x), rounded(p.y + by.y)};
}

/// Draws the moved boundary of one ring after the other. The curve may cross itself; what it winds
/// round at least once is the result.
class MovedBoundary {
 public:
  MovedBoundary(double distance, std::size_t points) : distance_(distance) {
    curve_.reserve(points + points / 2);
  }

  void add(std::span<const GridPoint> ring) {
    const std::size_t n = ring.size();
    normals_.resize(n);
    lengths_.resize(n);
    used_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const GridPoint a = ring[i], b = ring[i + 1 < n ? i + 1 : 0];
      const double dx = b.x - a.x, dy = b.y - a.y;
      lengths_[i] = std::sqrt(dx * dx + dy * dy);
      normals_[i] = {dy / lengths_[i], -dx / lengths_[i]};
    }
    for (std::size_t i = 0, before = n - 1; i < n; before = i++)
      used_[i] = used_at_corner(normals_[before], normals_[i]);
    // What is left of the moved edges, if every corner is one point.
    for (std::size_t i = 0; i < n; ++i) lengths_[i] -= used_[i] + used_[i + 1 < n ? i + 1 : 0];
    curve_.begin_ring({1, 0});
    for (std::size_t i = 0, before = n - 1; i < n; before = i++) join(ring[i], before, i);
    curve_.end_ring();
  }

  [[nodiscard]] GridRings take() { return std::move(curve_); }

 private:
  /// By how much the moved edges about a corner are shorter if they end where they cross; negative
  /// if they are longer.
  [[nodiscard]] double used_at_corner(Vector u, Vector v) const {
    const double sine = u.x * v.y - u.y * v.x, cosine = u.x * v.x + u.y * v.y;
    return 1 + cosine < kShortestMitre ? 0 : -distance_ * sine / (1 + cosine);
  }

  /// The curve about the point between two edges.
  void join(GridPoint p, std::size_t before, std::size_t after) {
    const Vector u = normals_[before], v = normals_[after];
    const double sine = u.x * v.y - u.y * v.x, cosine = u.x * v.x + u.y * v.y;
    const auto go_to = [&](Vector by) {
      curve_.add(moved(p, {distance_ * by.x, distance_ * by.y}));
    };
    const double mitre = 1 / (1 + cosine);
    const Vector tip{(u.x + v.x) * mitre, (u.y + v.y) * mitre};
    if (std::abs(sine * distance_) < 1 && cosine > 0) {
      go_to(u);
    } else if (sine * distance_ < 0) {
      // The moved edges cross. Where neither is used up by that, only their crossing matters.
      if (1 + cosine >= kShortestMitre && lengths_[before] >= 0 && lengths_[after] >= 0)
        return go_to(tip);
      go_to(u);
      curve_.add(p);
      go_to(v);
    } else if (1 + cosine >= kShortestMitre) {
      go_to(tip);
    } else {
      const double cut =
          std::tan(std::atan2(std::abs(sine), cosine) / 4) * (distance_ < 0 ? -1 : 1);
      go_to({u.x - u.y * cut, u.y + u.x * cut});
      go_to({v.x + v.y * cut, v.y - v.x * cut});
    }
  }

  static constexpr double kShortestMitre = 0.5;  // 1 + cosine of the turn: a mitre of twice

  double distance_;
  GridRings curve_;
  std::vector<Vector> normals_;
  std::vector<double> lengths_;  // of edges
  std::vector<double> used_;     // at corners
};

/// Takes the points away that lie next to their neighbours or to the line between them.
class Cleaner {
 public:
  explicit Cleaner(double reach) : reach2_(reach * reach) {}

  /// True if the ring has lost points. It may be left with none.
  bool clean(GridRing& ring) {
    const std::size_t n = ring.size();
    next_.resize(n);
    previous_.resize(n);
    settled_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      next_[i] = i + 1 < n ? i + 1 : 0;
      previous_[i] = i > 0 ? i - 1 : n - 1;
    }
    std::size_t size = n, at = 0;
    while (size > 2 && settled_[at] == 0) {
      const GridPoint before = ring[previous_[at]], here = ring[at], after = ring[next_[at]];
      if (are_near(here, before) || is_near_line(before, here, after)) {
        at = remove(at);
        --size;
      } else if (are_near(before, after)) {
        remove(next_[at]);
        at = remove(at);
        size -= 2;
      } else {
        settled_[at] = 1;
        at = next_[at];
      }
    }
    moved_.clear();
    if (size == n) {
      moved_.resize(n, 0);
      return false;
    }
    if (size < 3) {
      ring.clear();
      return true;
    }
    GridRing kept;
    kept.reserve(size);
    for (std::size_t i = 0; i < size; ++i, at = next_[at]) {
      kept.push_back(ring[at]);
      moved_.push_back(next_[at] == (at + 1 < n ? at + 1 : 0) ? 0 : 1);
    }
    ring = std::move(kept);
    return true;
  }

  /// Of the edges that the last ring has been left with: 1 where points between are gone.
  [[nodiscard]] const std::vector<std::uint8_t>& moved() const { return moved_; }

 private:
  /// Returns the point before, which has to be looked at again.
  std::size_t remove(std::size_t at) {
    next_[previous_[at]] = next_[at];
    previous_[next_[at]] = previous_[at];
    settled_[previous_[at]] = 0;
    return previous_[at];
  }

  [[nodiscard]] bool are_near(GridPoint a, GridPoint b) const {
    const double dx = a.x - b.x, dy = a.y - b.y;
    return dx * dx + dy * dy <= reach2_;
  }

  /// Whether the middle one of three points, in whichever order they lie, is near the line through
  /// the others.
  [[nodiscard]] bool is_near_line(GridPoint a, GridPoint b, GridPoint c) const {
    const double twice_area = static_cast<double>(turn(a, b, c));
    const auto square = [](GridPoint p, GridPoint q) {
      const double dx = p.x - q.x, dy = p.y - q.y;
      return dx * dx + dy * dy;
    };
    const double longest2 = std::max({square(a, b), square(b, c), square(a, c)});
    return twice_area * twice_area < reach2_ * longest2;
  }

  double reach2_;
  std::vector<std::size_t> next_, previous_;
  std::vector<std::uint8_t> settled_;
  std::vector<std::uint8_t> moved_;
};

}  // namespace

std::optional<std::vector<GridPolygon>> offset_rings(const GridRings& rings, double distance,
                                                     double clean) {
  Cleaner smoother(clean), cleaner(clean);
  MovedBoundary boundary(distance, rings.size());
  for (std::uint32_t i = 0; i < rings.rings(); ++i) {
    const std::span<const GridPoint> points = rings.ring(i);
    GridRing ring(points.begin(), points.end());
    smoother.clean(ring);  // points as near as this make mitres that are noise
    if (!ring.empty()) boundary.add(ring);
  }
  std::optional<std::vector<GridPolygon>> grown = overlay(boundary.take(), Inside::kFirstPositive);
  if (!grown) return std::nullopt;

  GridRings cleaned;
  std::vector<std::uint8_t> moved;
  bool any_moved = false;
  const auto clean_ring = [&](GridRing& ring) {
    any_moved |= cleaner.clean(ring);
    if (ring.empty()) return;
    cleaned.begin_ring({1, 0});
    for (const GridPoint p : ring) cleaned.add(p);
    cleaned.end_ring();
    moved.insert(moved.end(), cleaner.moved().begin(), cleaner.moved().end());
  };
  for (GridPolygon& polygon : *grown) {
    clean_ring(polygon.outer);
    for (GridRing& hole : polygon.holes) clean_ring(hole);
    std::erase_if(polygon.holes, [](const GridRing& hole) { return hole.empty(); });
  }
  std::erase_if(*grown, [](const GridPolygon& polygon) { return polygon.outer.empty(); });
  if (!any_moved || grown->empty()) return grown;
  // Cleaning moves edges, so rings may overlap by as much.
  if (!PlanarEdges(cleaned, moved).any_meets()) return grown;
  return overlay(cleaned, Inside::kFirstNonZero);
}

}  // namespace routebench::overlay
