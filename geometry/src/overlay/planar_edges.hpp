#pragma once
/// Where the edges of rings meet, and rings cut there.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "overlay/edge_boxes.hpp"
#include "overlay/edge_cells.hpp"
#include "overlay/grid_rings.hpp"

namespace routebench::overlay {

/// An edge passes through the place of the grid that is nearest to where it meets another one.
struct Cut {
  std::uint32_t edge;
  GridPoint at;
  std::int64_t squared_way;  ///< from the edge's first point
};

/// The edges of rings, and where they meet. Edge i runs from point i to the next point of its ring.
/// Where edges cross, both can be cut at the nearest place of the grid, and with them all that pass
/// within half a unit of it: so edges that nearly coincide become one, where they would cross each
/// other over and over. That moves edges by less than a unit, and what they then meet is cut again.
/// Source: J. Hobby, Practical segment intersection with finite precision output, 1999.
class PlanarEdges {
 public:
  /// Takes at least one ring. Nothing is cut yet.
  /// Cost  linear in edges and in pairs that come near each other.
  explicit PlanarEdges(const GridRings& rings);

  /// As above, of rings that met nowhere before some of their edges were moved: only pairs with one
  /// of these are looked at.
  PlanarEdges(const GridRings& rings, std::span<const std::uint8_t> moved);

  /// Whether any two rings, or parts of one, meet.
  [[nodiscard]] bool any_meets() const { return any_touches_ || !crossings().empty(); }
  /// Whether any meet where one of them has a point.
  [[nodiscard]] bool any_touches() const { return any_touches_; }
  /// Before edges are cut: of each two that cross, both, one after the other.
  [[nodiscard]] std::span<const Cut> crossings() const { return cuts_; }

  /// Cuts edges where they meet, so that they share nothing but ends.
  /// Returns false if cuts led to new cuts again and again, which has not been seen.
  [[nodiscard]] bool cut();

  [[nodiscard]] std::pmr::memory_resource* memory() const { return rings_.memory(); }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size()); }
  [[nodiscard]] GridPoint point(std::uint32_t i) const { return points_[i]; }
  [[nodiscard]] std::uint32_t next(std::uint32_t point) const { return next_[point]; }
  [[nodiscard]] Edge edge(std::uint32_t i) const { return {points_[i], points_[next_[i]]}; }
  /// Whether another point may lie at this one.
  [[nodiscard]] bool meets(std::uint32_t point) const { return meets_[point] != 0; }

  [[nodiscard]] std::uint32_t rings() const { return rings_.rings(); }
  [[nodiscard]] std::uint32_t first_point(std::uint32_t ring) const { return rings_.begin(ring); }
  /// The points of a ring, without cuts.
  [[nodiscard]] std::span<const GridPoint> ring(std::uint32_t ring) const {
    return rings_.ring(ring);
  }
  [[nodiscard]] Winding winding(std::uint32_t ring) const { return rings_.winding(ring); }

  /// See LeftRay.
  template <typename Counts>
  [[nodiscard]] std::uint32_t first_to_the_left(GridPoint p, Counts&& counts) const {
    LeftRay ray(
        p, [this](std::uint32_t e) { return edge(e); }, counts);
    if (cells_)
      cells_->trace(ray);
    else
      boxes_.visit_meeting({{-kMaxUnits, p.y}, p}, size(), [&](std::uint32_t e) { ray.look(e); });
    return ray.first();
  }

 private:
  /// Edges, of which none is looked at with another one yet.
  struct Unmet {};
  PlanarEdges(const GridRings& rings, Unmet unmet);

  void link();
  void set_box(std::uint32_t edge);
  void make_cells();
  void make_cells_without(std::span<const std::uint32_t> pieces);
  /// Cuts whatever passes through the pixel of a cut there too.
  void cut_all_at_cuts();
  std::pmr::vector<std::uint32_t> apply_cuts();
  /// Finds where two edges, not neighbours of one ring, meet.
  void look(std::uint32_t e, std::uint32_t f);
  bool share_one_end(std::uint32_t e, std::uint32_t f);
  void look_at_fold(std::uint32_t e, std::uint32_t f);
  void touch_by(std::uint32_t edge, std::uint32_t point);
  void touch(std::uint32_t edge, GridPoint p);
  void meet(std::uint32_t point);
  [[nodiscard]] bool are_neighbours(std::uint32_t e, std::uint32_t f) const {
    return next_[e] == f || next_[f] == e;
  }
  /// Calls near(f) for edges whose box meets that of an edge: without cells for those of the first
  /// `others`, with cells for those added before, and adds the edge.
  template <typename Near>
  void visit_near(std::uint32_t e, std::uint32_t others, Near&& near);

  const GridRings& rings_;
  std::pmr::vector<GridPoint> points_;  // those of the rings, then cuts
  std::pmr::vector<std::uint32_t> next_;
  std::pmr::vector<std::uint8_t> meets_;
  EdgeBoxes boxes_;
  std::optional<EdgeCells> cells_;  // of many edges
  std::uint32_t cells_made_for_ = 0;
  // Cells may hold an edge several times; with them, edges remember the last visit.
  std::pmr::vector<std::uint32_t> seen_;
  std::uint32_t visits_ = 0;
  std::pmr::vector<Cut> cuts_;
  bool any_touches_ = false;
};

}  // namespace routebench::overlay
