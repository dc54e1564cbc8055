#include "overlay/overlay.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "overlay/chains.hpp"

namespace routebench::overlay {
namespace {

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

double twice_area(const GridRing& ring) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    sum += static_cast<double>(turn(ring[0], ring[i], ring[i + 1]));
  return sum;
}

/// Collects the boundaries of what is inside, face by face.
class FaceTracer {
 public:
  FaceTracer(const PlanarEdges& planar, const ChainGraph& graph, Inside inside)
      : planar_(planar), graph_(graph) {
    const std::vector<Chain>& chains = graph.chains();
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
      boundaries_.emplace_back();
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

  /// All rings of one walk round a face.
  struct Boundary {
    std::vector<GridRing> outers, holes;
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
    GridRing ring;
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
    if (area > 0) boundary.outers.push_back(std::move(ring));
    if (area < 0) boundary.holes.push_back(std::move(ring));
  }

  std::vector<GridPolygon> assemble() {
    std::vector<GridPolygon> polygons;
    std::vector<std::uint32_t> inner;
    for (std::uint32_t b = 0; b < boundaries_.size(); ++b) {
      Boundary& boundary = boundaries_[b];
      if (boundary.outers.empty()) {
        if (!boundary.holes.empty()) inner.push_back(b);
        continue;
      }
      boundary.polygon = static_cast<std::uint32_t>(polygons.size());
      for (GridRing& outer : boundary.outers) polygons.push_back({std::move(outer), {}});
      polygons[boundary.polygon].holes = std::move(boundary.holes);
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
      if (boundary.polygon == kNone) continue;
      for (GridRing& hole : boundary.holes)
        polygons[boundary.polygon].holes.push_back(std::move(hole));
    }
    return polygons;
  }

  const PlanarEdges& planar_;
  const ChainGraph& graph_;
  std::vector<Way> way_;                    // chains: which way has the inside to the left
  std::vector<std::uint32_t> boundary_of_;  // chains
  std::vector<Boundary> boundaries_;
  std::vector<std::uint32_t> path_;   // chains of the walk that no ring has yet
  std::vector<std::uint32_t> place_;  // nodes: where the path leaves them
};

}  // namespace

std::optional<std::vector<GridPolygon>> overlay(const GridRings& rings, Inside inside) {
  if (rings.rings() == 0) return std::vector<GridPolygon>{};
  const PlanarEdges planar(rings);
  if (!planar.are_planar()) return std::nullopt;
  return faces_of(planar, inside);
}

std::vector<GridPolygon> faces_of(const PlanarEdges& planar, Inside inside) {
  const ChainGraph graph(planar);
  return FaceTracer(planar, graph, inside).run();
}

}  // namespace routebench::overlay
