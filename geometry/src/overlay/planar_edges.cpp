#include "overlay/planar_edges.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>
#include <utility>

namespace routebench::overlay {
namespace {

constexpr int kMaxRounds = 20;

constexpr std::uint32_t kFewPieces = 16 * kFewEdges;  // which are shorter than edges

constexpr std::size_t kFewCuts = 16;  // most rings have fewer

/// Whether p, on the line through an edge, lies on the edge.
bool within(const Edge& edge, GridPoint p) { return box_of(edge).meets({p, p}); }

/// Whether the line through an edge comes as near to p as half a unit in x or in y.
bool passes_through_pixel(const Edge& edge, GridPoint p) {
  const std::int64_t x = edge.to.x - edge.from.x, y = edge.to.y - edge.from.y;
  return 2 * std::abs(turn(edge.from, edge.to, p)) <= std::abs(x) + std::abs(y);
}

}  // namespace

PlanarEdges::PlanarEdges(const GridRings& rings, Unmet)
    : rings_(rings),
      points_(rings.points(), rings.memory()),
      next_(rings.memory()),
      meets_(rings.memory()),
      boxes_(rings.size(), rings.memory()),
      seen_(rings.memory()),
      cuts_(rings.memory()) {
  cuts_.reserve(kFewCuts);
  link();
  if (size() > kFewEdges) make_cells();  // filled while edges are looked at
}

PlanarEdges::PlanarEdges(const GridRings& rings) : PlanarEdges(rings, Unmet()) {
  const auto look_at = [this](std::uint32_t e, std::uint32_t f) {
    if (!are_neighbours(e, f)) look(e, f);
  };
  if (cells_) {
    for (std::uint32_t e = 0; e < size(); ++e)
      visit_near(e, e, [&](std::uint32_t f) { look_at(e, f); });
    return;
  }
  boxes_.visit_meeting_pairs(size(), look_at);
  for (std::uint32_t ring = 1; ring < this->rings(); ++ring) {
    const std::uint32_t e = rings_.begin(ring);  // the edge before belongs to another ring
    if (boxes_[e].meets(boxes_[e - 1])) look(e, e - 1);
  }
}

PlanarEdges::PlanarEdges(const GridRings& rings, std::span<const std::uint8_t> moved)
    : PlanarEdges(rings, Unmet()) {
  for (std::uint32_t e = 0; e < size(); ++e) {
    const bool every = moved[e] != 0;
    if (!every && !cells_) continue;  // those that are moved look at it
    visit_near(e, size(), [&](std::uint32_t f) {
      const bool counts = every ? f < e || moved[f] == 0 : moved[f] != 0;
      if (counts && !are_neighbours(e, f)) look(e, f);
    });
  }
}

template <typename Near>
void PlanarEdges::visit_near(std::uint32_t e, std::uint32_t others, Near&& near) {
  const GridBox box = boxes_[e];
  if (!cells_) return boxes_.visit_meeting(box, others, near);
  seen_.resize(size(), 0);
  ++visits_;
  cells_->add(e, edge(e), [&](std::uint32_t f) {
    if (seen_[f] == visits_ || !boxes_[f].meets(box)) return;
    seen_[f] = visits_;
    near(f);
  });
}

void PlanarEdges::link() {
  next_.resize(points_.size());
  meets_.assign(points_.size(), 0);
  for (std::uint32_t ring = 0; ring < rings(); ++ring) {
    const std::uint32_t begin = rings_.begin(ring), end = rings_.end(ring);
    std::uint32_t before = end - 1;
    next_[before] = begin;
    GridPoint from = points_[begin];
    std::int64_t x = from.x - points_[before].x, y = from.y - points_[before].y;
    for (std::uint32_t i = begin; i < end; before = i++) {
      const std::uint32_t next = i + 1 < end ? i + 1 : begin;
      const GridPoint to = points_[next];
      next_[i] = next;
      boxes_.set(i, box_of(Edge{from, to}));
      // A ring turns back only where its direction does.
      const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
      if (x * dx + y * dy < 0) look_at_fold(before, i);
      x = dx;
      y = dy;
      from = to;
    }
  }
}

void PlanarEdges::set_box(std::uint32_t i) { boxes_.set(i, box_of(edge(i))); }

bool PlanarEdges::cut() {
  for (int round = 0; round < kMaxRounds && !cuts_.empty(); ++round) {
    cut_all_at_cuts();
    const std::uint32_t uncut = size();
    const std::pmr::vector<std::uint32_t> pieces = apply_cuts();
    if (size() > (cells_ ? 2 * cells_made_for_ : kFewPieces)) make_cells_without(pieces);
    // A piece that keeps its edge's number is in the cells twice, which does no harm. Without cells
    // added pieces look at those before them.
    for (const std::uint32_t e : pieces)
      visit_near(e, std::max(e, uncut), [&](std::uint32_t f) {
        if (e == f) return;
        if (next_[e] == f)
          look_at_fold(e, f);
        else if (next_[f] == e)
          look_at_fold(f, e);
        else
          look(e, f);
      });
  }
  return cuts_.empty();
}

void PlanarEdges::make_cells() {
  cells_.emplace(
      size(), [this](std::uint32_t e) { return edge(e); }, memory());
  cells_made_for_ = size();
}

/// Pieces are shorter than the edges that the cells have been made for.
void PlanarEdges::make_cells_without(std::span<const std::uint32_t> pieces) {
  make_cells();
  std::pmr::vector<std::uint8_t> is_piece(size(), 0, memory());
  for (const std::uint32_t e : pieces) is_piece[e] = 1;
  for (std::uint32_t e = 0; e < size(); ++e)
    if (is_piece[e] == 0) cells_->add(e, edge(e), [](std::uint32_t) {});
}

void PlanarEdges::cut_all_at_cuts() {
  const std::size_t found = cuts_.size();
  for (std::size_t i = 0; i < found; ++i) {
    const GridPoint p = cuts_[i].at;
    if (i > 0 && p == cuts_[i - 1].at) continue;  // of the edge that it crosses
    const auto cut = [&](std::uint32_t e) {
      const Edge a = edge(e);
      if (within(a, p) && passes_through_pixel(a, p)) touch(e, p);
    };
    if (cells_)
      cells_->visit_near(p, cut);
    else
      boxes_.visit_meeting({p, p}, size(), cut);
  }
}

std::pmr::vector<std::uint32_t> PlanarEdges::apply_cuts() {
  any_touches_ = true;
  std::pmr::vector<Cut> cuts(memory());
  cuts.swap(cuts_);
  std::sort(cuts.begin(), cuts.end(), [&](const Cut& a, const Cut& b) {
    return std::tuple(a.edge, a.squared_way, a.at) < std::tuple(b.edge, b.squared_way, b.at);
  });
  const std::size_t most = size() + cuts.size();
  points_.reserve(most);
  meets_.reserve(most);
  next_.reserve(most);
  std::pmr::vector<std::uint32_t> pieces(memory());
  pieces.reserve(2 * cuts.size());
  for (auto cut = cuts.begin(); cut != cuts.end();) {
    const std::uint32_t edge = cut->edge, end = next_[edge];
    std::uint32_t last = edge;
    pieces.push_back(edge);
    for (; cut != cuts.end() && cut->edge == edge; ++cut) {
      if (points_[last] == cut->at) continue;
      const std::uint32_t added = size();
      points_.push_back(cut->at);
      meets_.push_back(1);
      next_.push_back(end);
      pieces.push_back(added);
      next_[last] = added;
      last = added;
    }
  }
  boxes_.resize(size());
  for (const std::uint32_t piece : pieces) set_box(piece);
  return pieces;
}

void PlanarEdges::look(std::uint32_t e, std::uint32_t f) {
  const Edge a = edge(e), b = edge(f);
  if (share_one_end(e, f)) return;
  const std::int64_t from_b = turn(a.from, a.to, b.from), to_b = turn(a.from, a.to, b.to);
  if ((from_b > 0 && to_b > 0) || (from_b < 0 && to_b < 0)) return;
  const std::int64_t from_a = turn(b.from, b.to, a.from), to_a = turn(b.from, b.to, a.to);
  if ((from_a > 0 && to_a > 0) || (from_a < 0 && to_a < 0)) return;
  if (from_b != 0 && to_b != 0 && from_a != 0 && to_a != 0) {
    const GridPoint p = crossing_of(a, b);
    touch(e, p);
    touch(f, p);
    return;
  }
  if (from_b == 0 && within(a, b.from)) touch_by(e, f);
  if (to_b == 0 && within(a, b.to)) touch_by(e, next_[f]);
  if (from_a == 0 && within(b, a.from)) touch_by(f, e);
  if (to_a == 0 && within(b, a.to)) touch_by(f, next_[e]);
}

/// Where edges have an end in common, as pieces mostly do, one more turn tells whether that is all.
bool PlanarEdges::share_one_end(std::uint32_t e, std::uint32_t f) {
  const std::uint32_t e_end = next_[e], f_end = next_[f];
  const auto meet_at = [&](std::uint32_t p, std::uint32_t q, std::uint32_t p_far,
                           std::uint32_t q_far) {
    meet(p);
    meet(q);
    return turn(points_[p], points_[p_far], points_[q_far]) != 0;
  };
  if (points_[e] == points_[f]) return meet_at(e, f, e_end, f_end);
  if (points_[e] == points_[f_end]) return meet_at(e, f_end, e_end, f);
  if (points_[e_end] == points_[f]) return meet_at(e_end, f, e, f_end);
  if (points_[e_end] == points_[f_end]) return meet_at(e_end, f_end, e, f);
  return false;
}

/// Neighbours of one ring meet beyond their common point only where the ring turns back.
void PlanarEdges::look_at_fold(std::uint32_t e, std::uint32_t f) {
  const GridPoint a = points_[e], b = points_[f], c = points_[next_[f]];
  const std::int64_t along =
      std::int64_t{a.x - b.x} * (c.x - b.x) + std::int64_t{a.y - b.y} * (c.y - b.y);
  if (along <= 0 || turn(a, b, c) != 0) return;
  meet(f);
  if (within({a, b}, c)) touch_by(e, next_[f]);
  if (within({b, c}, a)) touch_by(f, e);
}

void PlanarEdges::touch_by(std::uint32_t edge, std::uint32_t point) {
  meet(point);
  touch(edge, points_[point]);
}

void PlanarEdges::touch(std::uint32_t edge, GridPoint p) {
  const std::int64_t x = p.x - points_[edge].x, y = p.y - points_[edge].y;
  const std::int64_t squared_way = x * x + y * y;
  if (p == points_[edge])
    meet(edge);
  else if (p == points_[next_[edge]])
    meet(next_[edge]);
  else
    cuts_.push_back({edge, p, squared_way});
}

void PlanarEdges::meet(std::uint32_t point) {
  meets_[point] = 1;
  any_touches_ = true;
}

}  // namespace routebench::overlay
