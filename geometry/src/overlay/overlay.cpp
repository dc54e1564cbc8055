#include "overlay/overlay.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "overlay/chains.hpp"
#include "overlay/crossed_rings.hpp"
#include "overlay/monotone_runs.hpp"

namespace routebench::overlay {

bool is_inside(Winding w, Inside inside) {
  switch (inside) {
    case Inside::kFirstPositive:
      return w.first > 0;
    case Inside::kFirstNonZero:
      return w.first != 0;
    case Inside::kFirstOdd:
      return w.first % 2 != 0;
    case Inside::kEither:
      return w.first != 0 || w.second != 0;
    case Inside::kBoth:
      return w.first != 0 && w.second != 0;
    case Inside::kFirstOnly:
      return w.first != 0 && w.second == 0;
  }
  return false;
}

namespace {

/// Takes points away that lie on the line between their neighbours.
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

/// Collects the boundaries of what is inside, face by face.
class FaceTracer {
 public:
  FaceTracer(const PlanarEdges& planar, const ChainGraph& graph, Inside inside)
      : planar_(planar), graph_(graph), memory_(planar.memory()) {
    const std::pmr::vector<Chain>& chains = graph.chains();
    way_.resize(chains.size(), Way::kNone);
    boundary_of_.resize(chains.size(), kNone);
    for (std::size_t c = 0; c < chains.size(); ++c) {
      if (chains[c].is_copy) continue;
      const bool left = is_inside(chains[c].left(), inside);
      if (left != is_inside(chains[c].right, inside)) way_[c] = left ? Way::kOn : Way::kBack;
    }
  }

  std::vector<GridPolygon> run() {
    for (std::uint32_t c = 0; c < way_.size(); ++c) {
      if (way_[c] == Way::kNone || boundary_of_[c] != kNone) continue;
      boundaries_.push_back({rings_.size()});
      if (graph_.chains()[c].is_closed()) {
        path_.push_back(c);
        boundary_of_[c] = static_cast<std::uint32_t>(boundaries_.size() - 1);
        close_ring(0);
      } else {
        walk(c);
      }
    }
    return assemble();
  }

 private:
  enum class Way : std::uint8_t { kNone, kOn, kBack };

  struct TracedRing {
    GridRing points;
    bool is_outer;
  };
  /// All rings of one walk round a face.
  struct Boundary {
    std::size_t first_ring;
    bool has_outer = false;
    std::uint32_t leftmost = kNone;  // point
    std::uint32_t polygon = kNone;
  };

  /// Follows what is inside, which lies to the left, until it comes round.
  void walk(std::uint32_t chain) {
    if (place_.empty()) place_.assign(graph_.nodes(), kNone);
    const std::uint32_t start = begin_of(chain);
    place_[start] = 0;
    while (boundary_of_[chain] == kNone) {
      boundary_of_[chain] = static_cast<std::uint32_t>(boundaries_.size() - 1);
      path_.push_back(chain);
      const bool on = way_[chain] == Way::kOn;
      const std::uint32_t node = on ? graph_.chains()[chain].to : graph_.chains()[chain].from;
      // Where the walk meets itself the loop is a ring of its own.
      if (place_[node] != kNone)
        close_ring(place_[node]);
      else
        place_[node] = static_cast<std::uint32_t>(path_.size());
      chain = next_chain(node, {chain, !on});
    }
    place_[start] = kNone;
    path_.clear();
  }

  [[nodiscard]] std::uint32_t begin_of(std::uint32_t chain) const {
    return way_[chain] == Way::kOn ? graph_.chains()[chain].from : graph_.chains()[chain].to;
  }

  /// The first boundary clockwise from where the walk came.
  [[nodiscard]] std::uint32_t next_chain(std::uint32_t node, ChainEnd arrival) const {
    const std::span<const ChainEnd> around = graph_.ends(node);
    std::size_t i = graph_.place(arrival);
    do {
      i = i == 0 ? around.size() - 1 : i - 1;
    } while (way_[around[i].chain] == Way::kNone);
    return around[i].chain;
  }

  /// Makes a ring of the path from a place on.
  void close_ring(std::uint32_t place) {
    const auto at = [&](std::uint32_t i) { return planar_.point(i); };
    Boundary& boundary = boundaries_.back();
    GridRing& ring = ring_;
    ring.clear();
    for (std::size_t i = place; i < path_.size(); ++i) {
      const Chain& chain = graph_.chains()[path_[i]];
      if (!chain.is_closed() && i > place) place_[begin_of(path_[i])] = kNone;
      const std::size_t before = ring.size();
      const std::uint32_t end = planar_.next(chain.last);
      const bool back = way_[path_[i]] == Way::kBack;
      std::uint32_t point = back ? planar_.next(chain.first) : chain.first;
      const std::uint32_t stop = back ? planar_.next(end) : end;
      do {
        ring.push_back(at(point));
        if (boundary.leftmost == kNone || at(point) < at(boundary.leftmost))
          boundary.leftmost = point;
        point = planar_.next(point);
      } while (point != stop);
      if (back) std::reverse(ring.begin() + static_cast<std::ptrdiff_t>(before), ring.end());
    }
    path_.resize(place);
    drop_straight_points(ring);
    const double area = twice_area(ring);
    if (area == 0) return;
    rings_.push_back({GridRing(ring, memory_), area > 0});
    if (area > 0) boundary.has_outer = true;
  }

  std::vector<GridPolygon> assemble() {
    std::vector<GridPolygon> polygons;
    std::pmr::vector<std::uint32_t> inner(memory_);
    for (std::uint32_t b = 0; b < boundaries_.size(); ++b) {
      Boundary& boundary = boundaries_[b];
      if (!boundary.has_outer) {
        if (!rings_of(b).empty()) inner.push_back(b);
        continue;
      }
      boundary.polygon = static_cast<std::uint32_t>(polygons.size());
      for (TracedRing& ring : rings_of(b))
        if (ring.is_outer) polygons.push_back({std::move(ring.points), {}});
      add_holes(b, polygons);
    }
    // To the left of a hole lies its polygon, up to the outer ring or another hole.
    const auto at = [&](std::uint32_t i) { return planar_.point(i); };
    std::sort(inner.begin(), inner.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::tuple(at(boundaries_[a].leftmost), a) <
             std::tuple(at(boundaries_[b].leftmost), b);
    });
    for (const std::uint32_t b : inner) {
      Boundary& boundary = boundaries_[b];
      const std::uint32_t edge = planar_.first_to_the_left(
          at(boundary.leftmost),
          [&](std::uint32_t e) { return way_[graph_.chain_of(e)] != Way::kNone; });
      if (edge == kNone) continue;
      boundary.polygon = boundaries_[boundary_of_[graph_.chain_of(edge)]].polygon;
      if (boundary.polygon != kNone) add_holes(b, polygons);
    }
    return polygons;
  }

  [[nodiscard]] std::span<TracedRing> rings_of(std::uint32_t boundary) {
    const bool is_last = boundary + 1 == boundaries_.size();
    return std::span(rings_).subspan(
        boundaries_[boundary].first_ring,
        (is_last ? rings_.size() : boundaries_[boundary + 1].first_ring) -
            boundaries_[boundary].first_ring);
  }

  /// To its polygon.
  void add_holes(std::uint32_t boundary, std::vector<GridPolygon>& polygons) {
    for (TracedRing& ring : rings_of(boundary))
      if (!ring.is_outer)
        polygons[boundaries_[boundary].polygon].holes.push_back(std::move(ring.points));
  }

  const PlanarEdges& planar_;
  const ChainGraph& graph_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<Way> way_{memory_};  // chains: which way has the inside to the left
  std::pmr::vector<std::uint32_t> boundary_of_{memory_};  // chains
  std::pmr::vector<Boundary> boundaries_{memory_};
  std::pmr::vector<TracedRing> rings_{memory_};     // boundary by boundary
  GridRing ring_{memory_};                          // the one that is made
  std::pmr::vector<std::uint32_t> path_{memory_};   // chains of the walk that no ring has yet
  std::pmr::vector<std::uint32_t> place_{memory_};  // nodes: where the path leaves them
};

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

  /// Each ring is looked at with each, so more would take longer than to cut them.
  static constexpr std::uint32_t kMostRings = 24;

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
  static constexpr std::size_t kStepsPerPoint = 32;

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
    const auto least =
        static_cast<std::size_t>(std::min_element(points.begin(), points.end()) - points.begin());
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

/// What rings that meet nowhere bound, the inside to their left; nothing if that takes too long.
std::optional<std::vector<GridPolygon>> faces_within(const GridRings& rings) {
  constexpr std::size_t kStepsPerPoint = 32;
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

template <std::size_t N>
using Faces = std::array<std::vector<GridPolygon>, N>;

/// What all of `faces(inside)` find, if they do.
template <std::size_t N, typename Find>
std::optional<Faces<N>> found_for_all(const std::array<Inside, N>& insides, Find&& faces) {
  Faces<N> all;
  for (std::size_t i = 0; i < N; ++i) {
    auto found = faces(insides[i]);
    if (!found) return std::nullopt;
    all[i] = *std::move(found);
  }
  return all;
}

/// The faces for several rules, of which the second and further ones cost little.
template <std::size_t N>
std::optional<Faces<N>> overlays(const GridRings& rings, const std::array<Inside, N>& insides) {
  if (rings.rings() == 0) return Faces<N>{};
  // What is offset or cut from a solid seldom meets itself; of two areas the outlines mostly do.
  const bool is_one_set = insides[0] == Inside::kFirstPositive ||
                          insides[0] == Inside::kFirstNonZero || insides[0] == Inside::kFirstOdd;
  const bool may_be_apart = rings.rings() <= ApartRings::kMostRings;
  const auto apart = [&](Inside inside) { return ApartRings(rings).faces(inside); };
  if (may_be_apart && is_one_set && meet_nowhere(rings))
    if (auto faces = found_for_all(insides, apart)) return faces;
  PlanarEdges planar(rings);
  if (planar.any_meets()) {
    const CrossedRings crossed(planar);
    if (auto faces = found_for_all(insides, [&](Inside inside) {
          const auto boundary = crossed.boundary(inside);
          return boundary ? faces_within(*boundary) : std::nullopt;
        }))
      return faces;
    if (!planar.cut()) return std::nullopt;
  } else if (may_be_apart) {
    if (auto faces = found_for_all(insides, apart)) return faces;
  }
  const ChainGraph graph(planar);
  return found_for_all(insides, [&](Inside inside) {
    return std::optional(FaceTracer(planar, graph, inside).run());
  });
}

}  // namespace

std::optional<std::vector<GridPolygon>> overlay(const GridRings& rings, Inside inside) {
  auto faces = overlays(rings, std::array{inside});
  return faces ? std::optional(std::move(faces->front())) : std::nullopt;
}

std::optional<Divided> divide(const GridRings& rings) {
  auto faces = overlays(rings, std::array{Inside::kBoth, Inside::kFirstOnly});
  return faces ? std::optional(Divided{std::move(faces->front()), std::move(faces->back())})
               : std::nullopt;
}

GridRings rings_of(const std::vector<GridPolygon>& polygons, std::pmr::memory_resource* memory) {
  GridRings rings(memory);
  const auto add = [&](const GridRing& ring) {
    rings.begin_ring({1, 0});
    rings.make_room(ring.size());
    for (const GridPoint p : ring) rings.add(p);
    rings.end_ring();
  };
  for (const GridPolygon& polygon : polygons) {
    add(polygon.outer);
    for (const GridRing& hole : polygon.holes) add(hole);
  }
  return rings;
}

}  // namespace routebench::overlay
