#include "island_tree.hpp"

#include <algorithm>
#include <cassert>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

constexpr std::uint32_t kLeafEdges = 8;

double squared_distance_to_box(Point2 p, Point2 lower, Point2 upper) {
  const Point2 inside{std::clamp(p.x, lower.x, upper.x), std::clamp(p.y, lower.y, upper.y)};
  return squared_distance(p, inside);
}

/// Where the horizontal line through y crosses an edge, if it does. No vertex may lie on the line.
std::optional<double> crossing_x(Point2 a, Point2 b, double y) {
  if ((a.y < y) == (b.y < y)) return std::nullopt;
  return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
}

/// A point well inside a polygon, on a height at which nothing on the grid has a vertex.
Point2 inner_point(const Polygon& polygon) {
  const auto [low, high] = std::minmax_element(polygon.outer.begin(), polygon.outer.end(),
                                               [](Point2 a, Point2 b) { return a.y < b.y; });
  const double y = snap((low->y + high->y) / 2) + 0.5 / kGridUnitsPerMm;
  std::vector<double> xs;
  const auto add_ring = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (const auto x = crossing_x(ring[i], ring[(i + 1) % ring.size()], y)) xs.push_back(*x);
  };
  add_ring(polygon.outer);
  for (const Ring& hole : polygon.holes) add_ring(hole);
  std::sort(xs.begin(), xs.end());
  Point2 best = *low;
  double widest = 0;
  for (std::size_t i = 0; i + 1 < xs.size(); i += 2) {
    if (xs[i + 1] - xs[i] <= widest) continue;
    widest = xs[i + 1] - xs[i];
    best = {(xs[i] + xs[i + 1]) / 2, y};
  }
  return best;
}

/// The islands' indices, so that those which follow each other lie near each other: along a curve
/// that fills the plane. Source: G. M. Morton, 1966.
std::vector<std::uint32_t> near_each_other(const Polygons& islands) {
  const Box2 box = bounding_box(islands);
  const double extent_mm =
      std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, 1 / kGridUnitsPerMm});
  const auto spread = [&](double share) {  // its 16 bits at even places
    auto bits = static_cast<std::uint32_t>(share * 65535);
    for (int shift = 8; shift > 0; shift /= 2)
      bits = (bits | bits << shift) & (0xFFFFFFFFU / ((1U << shift) + 1));
    return bits;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> places;
  for (std::uint32_t i = 0; i < islands.size(); ++i) {
    const Point2 from_corner = islands[i].outer.front() - box.lower;
    places.emplace_back(spread(from_corner.x / extent_mm) | spread(from_corner.y / extent_mm) << 1,
                        i);
  }
  std::sort(places.begin(), places.end());
  std::vector<std::uint32_t> order;
  for (const auto& [place, island] : places) order.push_back(island);
  return order;
}

}  // namespace

IslandTree::IslandTree(const Polygons& islands)
    : taken_(islands.size(), false), leaves_of_(islands.size()) {
  const auto add_ring = [&](const Ring& ring, std::uint32_t island) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges_.push_back({ring[i], ring[(i + 1) % ring.size()], island});
  };
  for (const std::uint32_t i : near_each_other(islands)) {
    add_ring(islands[i].outer, i);
    for (const Ring& hole : islands[i].holes) add_ring(hole, i);
  }
  if (!edges_.empty()) build(0, 0, static_cast<std::uint32_t>(edges_.size()));
}

bool IslandTree::is_leaf(std::size_t node) const {
  return nodes_[node].end - nodes_[node].begin <= kLeafEdges;
}

void IslandTree::build(std::size_t node, std::uint32_t begin, std::uint32_t end) {
  if (nodes_.size() <= node) nodes_.resize(node + 1);
  Node made;
  made.begin = begin;
  made.end = end;
  made.waiting = end - begin;
  const auto reach = [&](Point2 lower, Point2 upper) {
    made.lower = {std::min(made.lower.x, lower.x), std::min(made.lower.y, lower.y)};
    made.upper = {std::max(made.upper.x, upper.x), std::max(made.upper.y, upper.y)};
  };
  nodes_[node] = made;
  if (is_leaf(node)) {
    for (std::uint32_t e = begin; e < end; ++e) {
      for (const Point2 p : {edges_[e].a, edges_[e].b}) reach(p, p);
      std::vector<std::uint32_t>& leaves = leaves_of_[edges_[e].island];
      leaves.push_back(static_cast<std::uint32_t>(node));
    }
  } else {
    // Neighbours along a ring are neighbours in the plane, so there is no need to sort.
    const std::uint32_t middle = begin + (end - begin) / 2;
    build(2 * node + 1, begin, middle);
    build(2 * node + 2, middle, end);
    for (const Node& half : {nodes_[2 * node + 1], nodes_[2 * node + 2]})
      reach(half.lower, half.upper);
  }
  nodes_[node] = made;
}

std::optional<std::size_t> IslandTree::nearest(Point2 p) const {
  std::optional<Nearest> best;
  if (!nodes_.empty()) search_nearest(0, p, best);
  if (!best) return std::nullopt;
  return best->island;
}

void IslandTree::search_nearest(std::size_t node, Point2 p, std::optional<Nearest>& best) const {
  const Node& here = nodes_[node];
  // A box that is exactly as near may still hold an island of a lower index.
  if (here.waiting == 0 ||
      (best && squared_distance_to_box(p, here.lower, here.upper) > best->squared_mm2))
    return;
  if (is_leaf(node)) {
    for (std::uint32_t e = here.begin; e < here.end; ++e) {
      const Edge& edge = edges_[e];
      if (taken_[edge.island]) continue;
      const double d = squared_distance(p, nearest_on_segment(p, edge.a, edge.b));
      if (!best || d < best->squared_mm2 || (d == best->squared_mm2 && edge.island < best->island))
        best = {d, edge.island};
    }
    return;
  }
  std::size_t near = 2 * node + 1;
  std::size_t far = 2 * node + 2;
  if (squared_distance_to_box(p, nodes_[far].lower, nodes_[far].upper) <
      squared_distance_to_box(p, nodes_[near].lower, nodes_[near].upper))
    std::swap(near, far);
  search_nearest(near, p, best);
  search_nearest(far, p, best);
}

void IslandTree::take(std::size_t island) {
  assert(!taken_[island]);
  taken_[island] = true;
  for (std::size_t node : leaves_of_[island]) {
    for (; node != 0; node = (node - 1) / 2) --nodes_[node].waiting;
    --nodes_[0].waiting;
  }
}

std::size_t IslandTree::island_of(const Polygon& region) const {
  // Going left from a place inside an island, the first boundary met is that island's own.
  const Point2 p = inner_point(region);
  std::optional<Hit> hit;
  search_left(0, p, hit);
  if (hit) return hit->island;
  // A sliver that rounding has put beside its island: the nearest boundary is that island's.
  std::optional<Nearest> best;
  for (const Edge& edge : edges_) {
    const double d = squared_distance(p, nearest_on_segment(p, edge.a, edge.b));
    if (!best || d < best->squared_mm2 || (d == best->squared_mm2 && edge.island < best->island))
      best = {d, edge.island};
  }
  assert(best);
  return best->island;
}

void IslandTree::search_left(std::size_t node, Point2 p, std::optional<Hit>& best) const {
  const Node& here = nodes_[node];
  if (here.lower.y > p.y || here.upper.y < p.y || here.lower.x > p.x ||
      (best && here.upper.x < best->x))
    return;
  if (is_leaf(node)) {
    for (std::uint32_t e = here.begin; e < here.end; ++e) {
      const auto x = crossing_x(edges_[e].a, edges_[e].b, p.y);
      if (x && *x <= p.x && (!best || *x > best->x)) best = {*x, edges_[e].island};
    }
    return;
  }
  const bool right_first = nodes_[2 * node + 2].upper.x > nodes_[2 * node + 1].upper.x;
  search_left(2 * node + (right_first ? 2 : 1), p, best);
  search_left(2 * node + (right_first ? 1 : 2), p, best);
}

}  // namespace routebench
