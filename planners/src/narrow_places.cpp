#include "narrow_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

// Of 1 + the cosine of a corner's turn: 120 degrees. Offsets cut sharper corners off.
constexpr double kSharpest = 0.5;
constexpr double kFarthestTimes = 2;  // the distance: so far the inset is from such a corner
// The inset of a corner begins at half the tangent of its turn from it, which is about this much.
constexpr double kCornerDistances = 2;
constexpr std::size_t kLookAhead = 3;  // edges: a few small ones may lead away at first
constexpr int kSearches = 8;           // over the whole inset, for one ring of the area
// With more places in doubt, and that share of all corners, the whole area is.
constexpr std::size_t kManyDoubts = 32;
constexpr std::size_t kLargeShare = 8;
// What is no larger is looked at as a whole: not much of it would be left out about one place.
constexpr double kSmallMargins = 3;

/// A place that follows a point along rings.
class Follower {
 public:
  explicit Follower(const Polygons& polygons) {
    const auto add = [this](const Ring& ring) {
      rings_.push_back(&ring);
      boxes_.push_back(bounding_box(ring));
    };
    for (const Polygon& polygon : polygons) {
      add(polygon.outer);
      for (const Ring& hole : polygon.holes) add(hole);
    }
  }

  [[nodiscard]] bool is_somewhere() const { return ring_ != nullptr; }

  /// Whether the edge where it is comes as near to p as that.
  [[nodiscard]] bool reaches(Point2 p, double within_squared) const {
    return ring_ != nullptr && is_within(p, edge_, within_squared);
  }

  /// Whether the edge where it is, or the next one, comes as near as that to all between two
  /// points. Moves on to it.
  bool runs_beside(Point2 a, Point2 b, double within_squared) {
    if (ring_ == nullptr) return false;
    for (const std::size_t edge : {after(edge_, 1), edge_}) {
      // What is near a segment is convex.
      if (!is_within(b, edge, within_squared) || !is_within(a, edge, within_squared)) continue;
      edge_ = edge;
      return true;
    }
    return false;
  }

  /// Moves on along the ring as long as that leads nearer to p, until it is near enough; the
  /// squared distance there.
  double follow(Point2 p, double enough_squared) {
    double nearest = squared_to(p, edge_);
    for (std::size_t ahead = 1; ahead <= kLookAhead && nearest > enough_squared; ++ahead) {
      const std::size_t next = after(edge_, ahead);
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

  /// Goes to a place within a distance, if there is one: the nearest of a ring, of all that have
  /// one the first after the ring where it is.
  bool search(Point2 p, double within_squared) {
    for (std::size_t n = 0; n < rings_.size(); ++n) {
      const std::size_t r = (index_ + n) % rings_.size();
      const Point2 in_box{std::clamp(p.x, boxes_[r].lower.x, boxes_[r].upper.x),
                          std::clamp(p.y, boxes_[r].lower.y, boxes_[r].upper.y)};
      if (squared_distance(p, in_box) > within_squared) continue;
      const Ring& ring = *rings_[r];
      double nearest = within_squared;
      std::size_t edge = 0;
      bool found = false;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 foot = nearest_on_segment(p, ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]);
        const double squared = squared_distance(p, foot);
        if (squared > nearest) continue;
        nearest = squared;
        edge = i;
        found = true;
      }
      if (!found) continue;
      edge_ = edge;
      ring_ = &ring;
      index_ = r;
      return true;
    }
    return false;
  }

 private:
  [[nodiscard]] double squared_to(Point2 p, std::size_t edge) const {
    return squared_distance(p, nearest_on_segment(p, (*ring_)[edge], (*ring_)[after(edge, 1)]));
  }

  /// Whether that is no more than `within_squared`, which takes no division to tell.
  [[nodiscard]] bool is_within(Point2 p, std::size_t edge, double within_squared) const {
    const Point2 from = (*ring_)[edge], to = (*ring_)[after(edge, 1)];
    const Point2 way = to - from, at = p - from;
    const double along = dot(at, way), length_squared = dot(way, way);
    if (along <= 0) return dot(at, at) <= within_squared;
    if (along >= length_squared) return squared_distance(p, to) <= within_squared;
    const double across = cross(way, at);
    return across * across <= within_squared * length_squared;
  }

  [[nodiscard]] std::size_t after(std::size_t edge, std::size_t ahead) const {
    edge += ahead;
    while (edge >= ring_->size()) edge -= ring_->size();
    return edge;
  }

  std::vector<const Ring*> rings_;
  std::vector<Box2> boxes_;
  const Ring* ring_ = nullptr;
  std::size_t index_ = 0;  // of the ring
  std::size_t edge_ = 0;
  std::size_t steps_ = 0;
};

/// One ring of the area, and how far from its places their inset may be.
class RingProof {
 public:
  RingProof(const Ring& ring, double distance_mm, double slack_mm, Follower& inset)
      : ring_(ring), distance_mm_(distance_mm), slack_mm_(slack_mm), inset_(inset) {}

  /// Calls visit(p, has_inset) for places of the ring one after the other, until that is false.
  template <typename Visit>
  bool look(Visit&& visit) {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const Point2 corner = ring_[i], next = ring_[after(i)];
      if (searches_ > 0 && inset_.runs_beside(corner, next, squared_reach(1))) continue;
      if (!visit(corner, has_inset_beside(corner, i))) return false;
      // Between corners too, as near to them as a stub is long that has room for a line.
      const int pieces =
          static_cast<int>(distance(corner, next) / ((distance_mm_ + slack_mm_) / 2)) + 1;
      const auto place = [&](int k) { return lerp(corner, next, static_cast<double>(k) / pieces); };
      for (int k = 1; k < pieces; ++k) {
        if (!visit(place(k), has_inset_beside(place(k), i))) return false;
        // What is beside one edge of the inset at two places is so between them.
        if (inset_.reaches(place(k), squared_reach(1)) &&
            inset_.reaches(place(pieces - 1), squared_reach(1)))
          break;
      }
    }
    return true;
  }

 private:
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 < ring_.size() ? i + 1 : 0; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i > 0 ? i - 1 : ring_.size() - 1; }

  /// Asks for a place on edge i, from its first point on.
  bool has_inset_beside(Point2 p, std::size_t i) {
    const bool is_placed = searches_ > 0;
    if (is_placed && inset_.reaches(p, squared_reach(1))) return true;
    const double nearest = is_placed && inset_.is_somewhere()
                               ? inset_.follow(p, squared_reach(1))
                               : std::numeric_limits<double>::infinity();
    if (nearest <= squared_reach(1)) return true;
    if (nearest > squared_reach(kFarthestTimes) && searches_ > kSearches) return false;
    const double reach = squared_reach(corner_reach(p, i));
    if (nearest <= reach) return true;
    return ++searches_ <= kSearches && inset_.search(p, reach);
  }

  /// How far away the inset may be if it may be so many times the distance away.
  [[nodiscard]] double squared_reach(double times) const {
    const double mm = times * distance_mm_ + slack_mm_;
    return mm * mm;
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
    const double wide = reach_between(first, last, 0);
    return p == ring_[i] ? std::max(wide, reach_between(before(i), i, distance_mm_)) : wide;
  }

  /// The same at a corner between two edges; 1 if they are shorter than its inset takes of them
  /// where it is `full_mm` away.
  [[nodiscard]] double reach_between(std::size_t first, std::size_t last, double full_mm) const {
    const Point2 in = ring_[after(first)] - ring_[first], out = ring_[after(last)] - ring_[last];
    const double sine = cross(in, out), cosine = dot(in, out);
    if (sine <= 0) return 1;  // towards the inside, or straight
    const double in2 = dot(in, in), out2 = dot(out, out), scale = std::sqrt(in2 * out2);
    // 1 / cos(t / 2) of the turn t, as cos(t) = 2 cos(t / 2)^2 - 1
    const double share = 1 + cosine / scale;
    if (share <= kSharpest) return 1;
    const double used_mm = full_mm * sine / (scale + cosine);  // tan(t / 2)
    return std::min(in2, out2) >= used_mm * used_mm ? std::sqrt(2 / share) : 1;
  }

  const Ring& ring_;
  double distance_mm_;
  double slack_mm_;
  Follower& inset_;
  int searches_ = 0;
};

bool meet(const Box2& a, const Box2& b) {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
         b.lower.y <= a.upper.y;
}

bool holds(const Box2& outer, const Box2& inner) {
  return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y &&
         outer.upper.x >= inner.upper.x && outer.upper.y >= inner.upper.y;
}

/// Adds a box to disjoint ones, as one with all that it meets, which is returned.
Box2 add(Box2 box, std::vector<Box2>& boxes) {
  for (std::size_t i = 0; i < boxes.size();) {
    if (!meet(boxes[i], box)) {
      ++i;
      continue;
    }
    box = around(box, boxes[i]);
    boxes[i] = boxes.back();
    boxes.pop_back();
    i = 0;  // it may meet more now
  }
  boxes.push_back(box);
  return box;
}

/// Cuts a ring off where `depth`, linear in the place, is negative.
template <typename Depth>
void cut_off(Ring& ring, const Depth& depth) {
  if (std::all_of(ring.begin(), ring.end(), [&](Point2 p) { return depth(p) >= 0; })) return;
  Ring kept;
  kept.reserve(ring.size() + 4);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[i + 1 < ring.size() ? i + 1 : 0];
    const double in_a = depth(a), in_b = depth(b);
    if (in_a >= 0) kept.push_back(a);
    if ((in_a > 0 && in_b < 0) || (in_a < 0 && in_b > 0))
      kept.push_back(snap(lerp(a, b, in_a / (in_a - in_b))));
  }
  ring = std::move(kept);
}

/// What of a ring lies in a box; empty if nothing does.
Ring cut_to(Ring ring, const Box2& box) {
  cut_off(ring, [&](Point2 p) { return p.x - box.lower.x; });
  cut_off(ring, [&](Point2 p) { return box.upper.x - p.x; });
  cut_off(ring, [&](Point2 p) { return p.y - box.lower.y; });
  cut_off(ring, [&](Point2 p) { return box.upper.y - p.y; });
  if (ring.size() < 3) ring.clear();
  return ring;
}

}  // namespace

std::vector<Box2> doubtful_places(const Polygons& inset, const Polygons& area, double distance_mm,
                                  double slack_mm, double margin_mm) {
  if (area.empty()) return {};
  std::vector<Box2> boxes;
  const Point2 margin{margin_mm, margin_mm};
  const Box2 bounds = bounding_box(area);
  const bool is_small = std::max(bounds.upper.x - bounds.lower.x, bounds.upper.y - bounds.lower.y) <
                        kSmallMargins * margin_mm;
  const auto all = [&]() -> std::vector<Box2> {
    return {{snap(bounds.lower - margin), snap(bounds.upper + margin)}};
  };
  if (inset.empty()) return all();
  std::size_t corners = 0, doubts = 0;
  for (const Polygon& polygon : area) {
    corners += polygon.outer.size();
    for (const Ring& hole : polygon.holes) corners += hole.size();
  }
  const auto visit = [&](Point2 p, bool has_inset) {
    if (has_inset) return true;
    if (is_small) return false;
    if (holds(add({snap(p - margin), snap(p + margin)}, boxes), bounds)) return false;
    return ++doubts < kManyDoubts || doubts * kLargeShare < corners;
  };
  Follower follower(inset);
  for (const Polygon& polygon : area) {
    if (!RingProof(polygon.outer, distance_mm, slack_mm, follower).look(visit)) return all();
    for (const Ring& hole : polygon.holes)
      if (!RingProof(hole, distance_mm, slack_mm, follower).look(visit)) return all();
  }
  return boxes;
}

Polygons clipped(const Polygons& polygons, const Box2& box) {
  Polygons kept;
  for (const Polygon& polygon : polygons) {
    const Box2 bounds = bounding_box(polygon);
    if (!meet(box, bounds)) continue;
    if (holds(box, bounds)) {
      kept.push_back(polygon);
      continue;
    }
    Polygon part{cut_to(polygon.outer, box), {}};
    if (part.outer.empty()) continue;
    for (const Ring& hole : polygon.holes)
      if (Ring rest = cut_to(hole, box); !rest.empty()) part.holes.push_back(std::move(rest));
    kept.push_back(std::move(part));
  }
  return kept;
}

}  // namespace routebench
