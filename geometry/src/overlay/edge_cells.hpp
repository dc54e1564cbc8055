#pragma once
/// A uniform grid over edges: which of them come near each other.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory_resource>
#include <span>
#include <vector>

#include "overlay/grid_rings.hpp"

namespace routebench::overlay {

struct Edge {
  GridPoint from;
  GridPoint to;
};

[[nodiscard]] inline GridBox box_of(const Edge& edge) {
  // Not by std::minmax, which compilers turn into branches that nobody can foresee.
  const GridPoint a = edge.from, b = edge.to;
  return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
}

/// Whether edges have a point in common.
[[nodiscard]] inline bool edges_meet(const Edge& a, const Edge& b) {
  if (!box_of(a).meets(box_of(b))) return false;
  const auto apart = [](std::int64_t s, std::int64_t t) {
    return (s > 0 && t > 0) || (s < 0 && t < 0);
  };
  return !apart(turn(a.from, a.to, b.from), turn(a.from, a.to, b.to)) &&
         !apart(turn(b.from, b.to, a.from), turn(b.from, b.to, a.to));
}

/// Lists of the edges that run through each cell. A few cells an edge.
/// Cost   to add an edge: linear in the cells that it runs through and in the edges there.
class EdgeCells {
 public:
  /// Cells for so many edges of rings, at least one, and others within their bounds; none of them
  /// is added.
  template <typename EdgeOf>
  EdgeCells(std::uint32_t edges, EdgeOf&& edge_of, std::pmr::memory_resource* memory)
      : head_(memory), items_(memory) {
    lower_ = upper_ = edge_of(0).from;
    double extents = 0;
    for (std::uint32_t e = 0; e < edges; ++e) {
      const Edge edge = edge_of(e);
      const GridPoint p = edge.from, q = edge.to;
      lower_ = {std::min(lower_.x, p.x), std::min(lower_.y, p.y)};
      upper_ = {std::max(upper_.x, p.x), std::max(upper_.y, p.y)};
      extents += std::max(std::abs(p.x - q.x), std::abs(p.y - q.y));
    }
    make_cells(edges, extents / edges);
  }

  /// Adds an edge by its number; calls near(other's number) for each that is in one of its cells,
  /// possibly several times.
  template <typename Near>
  void add(std::uint32_t number, const Edge& edge, Near&& near) {
    visit_cells(edge, [&](std::uint32_t cell) {
      for (std::uint32_t i = head_[cell]; i != kNone; i = items_[i].next) near(items_[i].edge);
      items_.push_back({number, head_[cell]});
      head_[cell] = static_cast<std::uint32_t>(items_.size() - 1);
    });
  }

  /// Whether a point lies within the bounds.
  [[nodiscard]] bool cover(GridPoint p) const {
    return lower_.x <= p.x && p.x <= upper_.x && lower_.y <= p.y && p.y <= upper_.y;
  }

  /// Calls visit(number) for each edge in the cell of a point within the bounds, possibly several
  /// times.
  template <typename Visit>
  void visit_near(GridPoint p, Visit&& visit) const {
    for (std::uint32_t i = head_[row(p.y) * columns_ + column(p.x)]; i != kNone; i = items_[i].next)
      visit(items_[i].edge);
  }

  /// Whether `is_it` holds for any edge in the cells that another one, within the bounds, runs
  /// through.
  template <typename IsIt>
  [[nodiscard]] bool any_near(const Edge& edge, IsIt&& is_it) const {
    bool found = false;
    visit_cells(edge, [&](std::uint32_t cell) {
      for (std::uint32_t i = head_[cell]; i != kNone && !found; i = items_[i].next)
        found = is_it(items_[i].edge);
    });
    return found;
  }

  /// Lets a ray from a point within the bounds look at the edges that may be the first.
  template <typename Ray>
  void trace(Ray& ray) const;

 private:
  void make_cells(std::uint32_t edges, double mean_extent);

  struct Item {
    std::uint32_t edge;
    std::uint32_t next;
  };

  [[nodiscard]] std::uint32_t column(std::int32_t x) const {
    return static_cast<std::uint32_t>(x - lower_.x) >> shift_;
  }
  [[nodiscard]] std::uint32_t row(std::int32_t y) const {
    return static_cast<std::uint32_t>(y - lower_.y) >> shift_;
  }
  template <typename Visit>
  void visit_cells(const Edge& edge, Visit&& visit) const;

  GridPoint lower_;
  GridPoint upper_;
  std::uint32_t shift_ = 0;
  std::uint32_t columns_ = 0;
  std::pmr::vector<std::uint32_t> head_;  // of each cell's list, row by row
  std::pmr::vector<Item> items_;
};

/// Where two edges that cross do so, to the nearest unit; the same whichever way they are given.
[[nodiscard]] GridPoint crossing_of(Edge e, Edge f);

/// Whether edge e meets a height more to the right than edge f. Both span the height; they may meet
/// in an end but do not cross.
[[nodiscard]] bool is_right_of(const Edge& e, const Edge& f);

/// A ray from a point to the left, and the first edge that it meets of those that it has looked at
/// and that count. The ray runs infinitesimally above the point's height, so that it meets no
/// vertex. Edges must not cross each other.
template <typename EdgeOf, typename Counts>
class LeftRay {
 public:
  LeftRay(GridPoint from, EdgeOf edge_of, Counts counts)
      : from_(from), edge_of_(edge_of), counts_(counts) {}

  void look(std::uint32_t e) {
    const Edge edge = edge_of_(e);
    const bool rises = edge.from.y < edge.to.y;
    const GridPoint low = rises ? edge.from : edge.to, high = rises ? edge.to : edge.from;
    if (low.y > from_.y || high.y <= from_.y || e == first_) return;
    if (turn(low, high, from_) >= 0 || !counts_(e)) return;  // the point must lie to its right
    if (first_ == kNone || is_right_of(edge, edge_of_(first_))) first_ = e;
  }

  [[nodiscard]] GridPoint from() const { return from_; }
  /// kNone if there is none.
  [[nodiscard]] std::uint32_t first() const { return first_; }
  /// The x at which the ray meets it.
  [[nodiscard]] double meets_at() const {
    const Edge edge = edge_of_(first_);
    const double share = static_cast<double>(from_.y - edge.from.y) / (edge.to.y - edge.from.y);
    return edge.from.x + share * (edge.to.x - edge.from.x);
  }

 private:
  GridPoint from_;
  EdgeOf edge_of_;
  Counts counts_;
  std::uint32_t first_ = kNone;
};

template <typename Visit>
void EdgeCells::visit_cells(const Edge& edge, Visit&& visit) const {
  const auto [lower, upper] = box_of(edge);
  const auto [x0, y0] = lower;
  const auto [x1, y1] = upper;
  const std::uint32_t c0 = column(x0), c1 = column(x1), r0 = row(y0), r1 = row(y1);
  if (c0 == c1 || r0 == r1) {
    for (std::uint32_t r = r0; r <= r1; ++r)
      for (std::uint32_t c = c0; c <= c1; ++c) visit(r * columns_ + c);
    return;
  }
  const double slope = static_cast<double>(edge.to.x - edge.from.x) / (edge.to.y - edge.from.y);
  for (std::uint32_t r = r0; r <= r1; ++r) {
    const double low =
        std::max<double>(y0, lower_.y + static_cast<double>(std::int64_t{r} << shift_));
    const double high =
        std::min<double>(y1, lower_.y + static_cast<double>(std::int64_t{r + 1} << shift_));
    const double xa = edge.from.x + slope * (low - edge.from.y);
    const double xb = edge.from.x + slope * (high - edge.from.y);
    // A unit more on either side, for what arithmetic and cutting have rounded.
    const auto left = static_cast<std::int32_t>(std::max<double>(x0, std::min(xa, xb) - 1));
    const auto right = static_cast<std::int32_t>(std::min<double>(x1, std::max(xa, xb) + 1));
    for (std::uint32_t c = column(left); c <= column(right); ++c) visit(r * columns_ + c);
  }
}

template <typename Ray>
void EdgeCells::trace(Ray& ray) const {
  const GridPoint p = ray.from();
  const std::uint32_t first_cell = row(p.y) * columns_;
  for (std::uint32_t c = column(p.x) + 1; c-- > 0;) {
    for (std::uint32_t i = head_[first_cell + c]; i != kNone; i = items_[i].next)
      ray.look(items_[i].edge);
    // An edge of a cell further left may still be nearer if the best one lies left of this cell.
    if (ray.first() != kNone &&
        ray.meets_at() > lower_.x + static_cast<double>(std::int64_t{c} << shift_) + 2)
      break;
  }
}

}  // namespace routebench::overlay
