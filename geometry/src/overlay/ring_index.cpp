#include "overlay/ring_index.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace routebench::overlay {
namespace {

/// More than two cuts can move what they cut.
constexpr std::int32_t kNear = 4;

/// Not beyond the grid, where boxes lie that are not set.
GridBox grown(const GridBox& box) {
  const auto least = [](std::int32_t at) { return std::max(at - kNear, -kMaxUnits); };
  const auto most = [](std::int32_t at) { return std::min(at + kNear, kMaxUnits); };
  return {{least(box.lower.x), least(box.lower.y)}, {most(box.upper.x), most(box.upper.y)}};
}

bool are_near(const Edge& edge, GridPoint p) {
  const std::int64_t x = edge.to.x - edge.from.x, y = edge.to.y - edge.from.y;
  return grown(box_of(edge)).meets({p, p}) &&
         std::abs(turn(edge.from, edge.to, p)) <= kNear * (std::abs(x) + std::abs(y));
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
      box_(box_of(rings_.points())),
      next_(next_points(rings_)),
      boxes_(rings_.size(), rings_.memory()) {
  for (std::uint32_t e = 0; e < rings_.size(); ++e) boxes_.set(e, box_of(edge(e)));
  if (rings_.size() <= kFewEdges) return;
  cells_.emplace(
      rings_.size(), [this](std::uint32_t e) { return edge(e); }, rings_.memory());
  for (std::uint32_t e = 0; e < rings_.size(); ++e) cells_->add(e, edge(e), [](std::uint32_t) {});
}

bool RingIndex::holds(GridPoint p) const {
  if (!box_.meets({p, p})) return false;
  LeftRay ray(
      p, [this](std::uint32_t e) { return edge(e); }, [](std::uint32_t) { return true; });
  if (cells_)
    cells_->trace(ray);
  else
    boxes_.visit_meeting({{-kMaxUnits, p.y}, p}, rings_.size(),
                         [&](std::uint32_t e) { ray.look(e); });
  const std::uint32_t hit = ray.first();
  if (hit == kNone) return false;
  // The inside lies to the left of every edge.
  return edge(hit).to.y < edge(hit).from.y;
}

bool RingIndex::meets_any_of(const RingIndex& other) const {
  if (!cells_)
    return other.boxes_.any_meeting_pair(boxes_, [&](std::uint32_t e, std::uint32_t own) {
      return edges_meet(other.edge(e), edge(own));
    });
  for (std::uint32_t e = 0; e < other.rings_.size(); ++e) {
    const Edge it = other.edge(e);
    if (!cells_->cover(it.from) || !cells_->cover(it.to)) return true;
    if (cells_->any_near(it, [&](std::uint32_t own) { return edges_meet(it, edge(own)); }))
      return true;
  }
  return false;
}

bool RingIndex::comes_near(const RingIndex& other) const {
  EdgeBoxes around(rings_.size(), rings_.memory());
  for (std::uint32_t e = 0; e < rings_.size(); ++e) around.set(e, grown(boxes_[e]));
  return other.boxes_.any_meeting_pair(around, [&](std::uint32_t f, std::uint32_t e) {
    const Edge a = edge(e), b = other.edge(f);
    return edges_meet(a, b) || are_near(a, b.from) || are_near(a, b.to) || are_near(b, a.from) ||
           are_near(b, a.to);
  });
}

bool RingIndex::holds_all_of(const RingIndex& other) const {
  if (meets_any_of(other)) return false;
  // Nothing crosses: every ring lies on one side of all others.
  for (std::uint32_t ring = 0; ring < other.rings_.rings(); ++ring)
    if (!holds(other.rings_.ring(ring).front())) return false;
  for (std::uint32_t ring = 0; ring < rings_.rings(); ++ring)
    if (other.holds(rings_.ring(ring).front())) return false;
  return true;
}

}  // namespace routebench::overlay
