#include "inset_proof.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

// Of 1 + the cosine of a corner's turn: 135 degrees. Beyond it there may be room for something.
constexpr double kSharpest = 0.29;
// The inset of a corner begins at half the tangent of its turn from it, which is about this much.
constexpr double kCornerDistances = 2;
constexpr std::size_t kLookAhead = 3;  // edges: a few small ones may lead away at first
constexpr int kSearches = 8;           // over the whole inset, for one ring of the area

/// A place that follows a point along rings.
class Follower {
 public:
  explicit Follower(const Polygons& polygons) {
    for (const Polygon& polygon : polygons) {
      rings_.push_back(&polygon.outer);
      for (const Ring& hole : polygon.holes) rings_.push_back(&hole);
    }
  }

  /// Moves on along the ring as long as that leads nearer to p; the squared distance there.
  double follow(Point2 p) {
    double nearest = squared_to(p, edge_);
    for (std::size_t ahead = 1; ahead <= kLookAhead; ++ahead) {
      const std::size_t next = (edge_ + ahead) % ring_->size();
      const double squared = squared_to(p, next);
      if (squared > nearest) continue;
      nearest = squared;
      edge_ = next;
      ahead = 0;
      if (++steps_ > ring_->size()) break;  // once round
    }
    steps_ = 0;
    return nearest;
  }

  /// Looks at all edges of all rings.
  double search(Point2 p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Ring* ring : rings_)
      for (std::size_t i = 0; i < ring->size(); ++i) {
        const Point2 foot =
            nearest_on_segment(p, (*ring)[i], (*ring)[i + 1 < ring->size() ? i + 1 : 0]);
        const double squared = squared_distance(p, foot);
        if (squared >= nearest) continue;
        nearest = squared;
        ring_ = ring;
        edge_ = i;
      }
    return nearest;
  }

 private:
  [[nodiscard]] double squared_to(Point2 p, std::size_t edge) const {
    const std::size_t end = edge + 1 < ring_->size() ? edge + 1 : 0;
    return squared_distance(p, nearest_on_segment(p, (*ring_)[edge], (*ring_)[end]));
  }

  std::vector<const Ring*> rings_;
  const Ring* ring_ = nullptr;
  std::size_t edge_ = 0;
  std::size_t steps_ = 0;
};

/// One ring of the area, and how far from its places their inset may be.
class RingProof {
 public:
  RingProof(const Ring& ring, double distance_mm, double slack_mm, Follower& inset)
      : ring_(ring), distance_mm_(distance_mm), slack_mm_(slack_mm), inset_(inset) {}

  [[nodiscard]] bool holds() {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const Point2 corner = ring_[i], next = ring_[after(i)];
      if (!has_inset_beside(corner, i)) return false;
      // Between corners too, as near to them as a stub is long that has room for a line.
      const int pieces =
          static_cast<int>(distance(corner, next) / ((distance_mm_ + slack_mm_) / 2)) + 1;
      for (int k = 1; k < pieces; ++k)
        if (!has_inset_beside(lerp(corner, next, static_cast<double>(k) / pieces), i)) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 < ring_.size() ? i + 1 : 0; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i > 0 ? i - 1 : ring_.size() - 1; }

  /// Asks for a place on edge i, from its first point on.
  bool has_inset_beside(Point2 p, std::size_t i) {
    const auto squared = [this](double mm) { return (mm + slack_mm_) * (mm + slack_mm_); };
    double nearest = std::numeric_limits<double>::infinity();
    if (searches_ > 0) nearest = inset_.follow(p);
    if (nearest <= squared(distance_mm_)) return true;
    const double reach = squared(distance_mm_ * corner_reach(p, i));
    if (nearest <= reach) return true;
    return ++searches_ <= kSearches && inset_.search(p) <= reach;
  }

  /// How many times the distance the inset may be away from a place on edge i: 1, but more at a
  /// corner, which may be rounded or cut off by other ones within the distance.
  [[nodiscard]] double corner_reach(Point2 p, std::size_t i) const {
    const double near_mm = kCornerDistances * distance_mm_;
    std::size_t first = p == ring_[i] ? before(i) : i, last = i;
    for (std::size_t k = 0; k < ring_.size() && distance(ring_[first], p) < near_mm; ++k)
      first = before(first);
    for (std::size_t k = 0; k < ring_.size() && distance(ring_[after(last)], p) < near_mm; ++k)
      last = after(last);
    const Point2 in = ring_[after(first)] - ring_[first], out = ring_[after(last)] - ring_[last];
    if (cross(in, out) <= 0) return 1;  // towards the inside, or straight
    // 1 / cos(t / 2) of the turn t, as cos(t) = 2 cos(t / 2)^2 - 1
    const double share = 1 + dot(in, out) / std::sqrt(dot(in, in) * dot(out, out));
    return share > kSharpest ? std::sqrt(2 / share) : 1;
  }

  const Ring& ring_;
  double distance_mm_;
  double slack_mm_;
  Follower& inset_;
  int searches_ = 0;
};

}  // namespace

bool grows_back(const Polygons& inset, const Polygons& area, double distance_mm, double slack_mm) {
  if (inset.empty()) return area.empty();
  Follower follower(inset);
  for (const Polygon& polygon : area) {
    if (!RingProof(polygon.outer, distance_mm, slack_mm, follower).holds()) return false;
    for (const Ring& hole : polygon.holes)
      if (!RingProof(hole, distance_mm, slack_mm, follower).holds()) return false;
  }
  return true;
}

}  // namespace routebench
