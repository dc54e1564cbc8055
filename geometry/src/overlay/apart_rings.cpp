#include "overlay/apart_rings.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace routebench::overlay {
namespace {

/// By a ray to the left, infinitesimally above the point, which lies on no edge of the ring.
bool lies_in(GridPoint p, std::span<const GridPoint> ring) {
  bool is_in = false;
  GridPoint a = ring.back();
  for (const GridPoint b : ring) {
    if ((a.y <= p.y) != (b.y <= p.y)) is_in ^= a.y < b.y ? turn(a, b, p) < 0 : turn(b, a, p) < 0;
    a = b;
  }
  return is_in;
}

/// The faces of rings that do not meet: every ring is on one side of all others, so one point of it
/// tells how often they run round it.
class ApartRings {
 public:
  explicit ApartRings(const GridRings& rings) : rings_(rings), places_(rings.memory()) {}

  /// Nothing if that takes too long even so.
  std::optional<std::vector<GridPolygon>> faces(Inside inside) {
    for (std::uint32_t i = 0; i < rings_.rings(); ++i) places_.push_back(place_of(i));
    std::vector<GridPolygon> polygons;
    std::pmr::vector<Hole> holes(rings_.memory());
    std::pmr::vector<std::uint32_t> polygon_of(rings_.rings(), kNone, rings_.memory());
    for (std::uint32_t i = 0; i < rings_.rings(); ++i) {
      Place& place = places_[i];
      Winding outside;
      for (std::uint32_t other = 0; other < rings_.rings(); ++other) {
        if (other == i || !lies_in(place.leftmost, other)) continue;
        ++place.depth;
        outside = outside + places_[other].within;
      }
      if (steps_ > kStepsPerPoint * rings_.size()) return std::nullopt;
      const bool is_outer = is_inside(outside + place.within, inside);
      if (is_outer == is_inside(outside, inside)) continue;
      GridRing ring = ring_of(i, is_outer);
      if (ring.empty()) continue;
      if (is_outer) {
        polygon_of[i] = static_cast<std::uint32_t>(polygons.size());
        polygons.push_back({std::move(ring), {}});
      } else {
        holes.push_back({i, std::move(ring)});
      }
    }
    for (Hole& hole : holes) {
      // Of the outer rings about it the innermost.
      std::uint32_t best = kNone;
      for (std::uint32_t outer = 0; outer < rings_.rings(); ++outer)
        if (polygon_of[outer] != kNone &&
            (best == kNone || places_[outer].depth > places_[best].depth) &&
            lies_in(places_[hole.ring].leftmost, outer))
          best = outer;
      if (best != kNone) polygons[polygon_of[best]].holes.push_back(std::move(hole.points));
    }
    return polygons;
  }

 private:
  struct Place {
    GridPoint leftmost;  ///< of several the lowest
    GridBox box;
    bool turns_left = false;
    Winding within;  ///< what the ring adds to places inside it
    int depth = 0;   ///< rings about it
  };
  struct Hole {
    std::uint32_t ring;
    GridRing points;
  };

  [[nodiscard]] Place place_of(std::uint32_t ring) const {
    const std::span<const GridPoint> points = rings_.ring(ring);
    std::size_t least = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      if (order_of(points[i]) < order_of(points[least])) least = i;
    const GridPoint before = points[least == 0 ? points.size() - 1 : least - 1];
    const GridPoint after = points[least + 1 == points.size() ? 0 : least + 1];
    Place place{points[least], box_of(points), turn(before, points[least], after) > 0, {}, 0};
    place.within = place.turns_left ? rings_.winding(ring) : Winding{} - rings_.winding(ring);
    return place;
  }

  bool lies_in(GridPoint p, std::uint32_t ring) {
    if (!places_[ring].box.meets({p, p})) return false;
    steps_ += rings_.ring(ring).size();
    return overlay::lies_in(p, rings_.ring(ring));
  }

  /// What is inside lies to the left of the ring then.
  [[nodiscard]] GridRing ring_of(std::uint32_t ring, bool is_outer) const {
    const std::span<const GridPoint> points = rings_.ring(ring);
    GridRing made(points.begin(), points.end(), rings_.memory());
    if (places_[ring].turns_left != is_outer) std::reverse(made.begin() + 1, made.end());
    drop_straight_points(made);
    return made;
  }

  const GridRings& rings_;
  std::pmr::vector<Place> places_;
  std::size_t steps_ = 0;
};

}  // namespace

void drop_straight_points(GridRing& ring) {
  std::size_t kept = 0;
  const auto is_straight = [&](GridPoint a, GridPoint b, GridPoint c) {
    return turn(a, b, c) == 0;
  };
  for (const GridPoint p : ring) {
    while (kept >= 2 && is_straight(ring[kept - 2], ring[kept - 1], p)) --kept;
    if (kept == 1 && ring[0] == p) continue;
    ring[kept++] = p;
  }
  // Round the end.
  std::size_t first = 0;
  while (kept - first >= 3) {
    if (is_straight(ring[kept - 2], ring[kept - 1], ring[first]))
      --kept;
    else if (is_straight(ring[kept - 1], ring[first], ring[first + 1]))
      ++first;
    else
      break;
  }
  if (kept - first < 3) kept = first;
  ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(kept), ring.end());
  ring.erase(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(first));
}

std::optional<std::vector<GridPolygon>> faces_apart(const GridRings& rings, Inside inside) {
  return ApartRings(rings).faces(inside);
}

std::optional<std::vector<GridPolygon>> faces_within(const GridRings& rings) {
  struct Outer {
    std::uint32_t ring;
    double area;
    GridBox box;
  };
  std::pmr::vector<Outer> outers(rings.memory());
  std::pmr::vector<std::uint32_t> holes(rings.memory());
  for (std::uint32_t i = 0; i < rings.rings(); ++i)
    if (const double area = twice_area(rings.ring(i)); area > 0)
      outers.push_back({i, area, box_of(rings.ring(i))});
    else
      holes.push_back(i);
  if (outers.size() * holes.size() > kStepsPerPoint * rings.size()) return std::nullopt;
  const auto straight = [&](std::uint32_t i) {
    GridRing ring(rings.ring(i).begin(), rings.ring(i).end(), rings.memory());
    drop_straight_points(ring);
    return ring;
  };
  std::vector<GridPolygon> polygons;
  polygons.reserve(outers.size());
  for (const Outer& outer : outers) polygons.push_back({straight(outer.ring), {}});
  std::size_t steps = 0;
  for (const std::uint32_t hole : holes) {
    const GridPoint p = rings.ring(hole).front();
    // The smallest of all round it.
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < outers.size(); ++k) {
      const Outer& outer = outers[k];
      if (outer.area >= least || !outer.box.meets({p, p})) continue;
      if (outers.size() > 1) {
        steps += rings.ring(outer.ring).size();
        if (!lies_in(p, rings.ring(outer.ring))) continue;
      }
      best = k;
      least = outer.area;
    }
    if (steps > kStepsPerPoint * rings.size()) return std::nullopt;
    if (!outers.empty()) polygons[best].holes.push_back(straight(hole));
  }
  return polygons;
}

}  // namespace routebench::overlay
