#include "overlay/overlay.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "overlay/apart_rings.hpp"
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
  const bool may_be_apart = rings.rings() <= kMostApart;
  const auto apart = [&](Inside inside) { return faces_apart(rings, inside); };
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
