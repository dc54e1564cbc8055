#include "overlay/ring_index.hpp"

#include <utility>

namespace routebench::overlay {
namespace {

bool segments_meet(const Edge& a, const Edge& b) {
  if (std::max(a.from.x, a.to.x) < std::min(b.from.x, b.to.x) ||
      std::max(b.from.x, b.to.x) < std::min(a.from.x, a.to.x) ||
      std::max(a.from.y, a.to.y) < std::min(b.from.y, b.to.y) ||
      std::max(b.from.y, b.to.y) < std::min(a.from.y, a.to.y))
    return false;
  const auto apart = [](std::int64_t s, std::int64_t t) {
    return (s > 0 && t > 0) || (s < 0 && t < 0);
  };
  return !apart(turn(a.from, a.to, b.from), turn(a.from, a.to, b.to)) &&
         !apart(turn(b.from, b.to, a.from), turn(b.from, b.to, a.to));
}

std::pmr::vector<std::uint32_t> next_points(const GridRings& rings) {
  std::pmr::vector<std::uint32_t> next(rings.size(), rings.memory());
  for (std::uint32_t ring = 0; ring < rings.rings(); ++ring) {
    const std::uint32_t begin = rings.begin(ring), end = rings.end(ring);
    for (std::uint32_t i = begin; i < end; ++i) next[i] = i + 1 < end ? i + 1 : begin;
  }
  return next;
}

}  // namespace

RingIndex::RingIndex(GridRings rings)
    : rings_(std::move(rings)),
      next_(next_points(rings_)),
      cells_(
          rings_.size(), [this](std::uint32_t e) { return edge(e); }, rings_.memory()) {
  for (std::uint32_t e = 0; e < rings_.size(); ++e) cells_.add(e, edge(e), [](std::uint32_t) {});
}

bool RingIndex::holds(GridPoint p) const {
  if (!cells_.cover(p)) return false;
  LeftRay ray(
      p, [this](std::uint32_t e) { return edge(e); }, [](std::uint32_t) { return true; });
  cells_.trace(ray);
  const std::uint32_t hit = ray.first();
  if (hit == kNone) return false;
  // The inside lies to the left of every edge.
  return edge(hit).to.y < edge(hit).from.y;
}

bool RingIndex::meets(const Edge& other) const {
  if (!cells_.cover(other.from) || !cells_.cover(other.to)) return true;
  return cells_.any_near(other, [&](std::uint32_t e) { return segments_meet(edge(e), other); });
}

bool RingIndex::holds_all_of(const RingIndex& other) const {
  for (std::uint32_t i = 0; i < other.rings_.size(); ++i)
    if (meets(other.edge(i))) return false;
  // Nothing crosses: every ring lies on one side of all others.
  for (std::uint32_t ring = 0; ring < other.rings_.rings(); ++ring)
    if (!holds(other.rings_.ring(ring).front())) return false;
  for (std::uint32_t ring = 0; ring < rings_.rings(); ++ring)
    if (other.holds(rings_.ring(ring).front())) return false;
  return true;
}

}  // namespace routebench::overlay
