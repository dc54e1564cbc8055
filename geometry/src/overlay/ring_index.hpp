#pragma once
/// Rings that can be asked what they hold.

#include <optional>

#include "overlay/edge_boxes.hpp"
#include "overlay/edge_cells.hpp"
#include "overlay/grid_rings.hpp"

namespace routebench::overlay {

/// Rings of polygons, which share nothing but points, with boxes around their edges and, over many,
/// cells.
class RingIndex {
 public:
  /// Takes at least one ring.
  explicit RingIndex(GridRings rings);

  [[nodiscard]] const GridRings& rings() const { return rings_; }

  /// Whether a point lies inside; on the boundary it may be either.
  [[nodiscard]] bool holds(GridPoint p) const;

  /// Whether other rings lie inside, clear of the boundary and of all holes.
  /// Cost  linear in the other's edges and in the number of own rings, where edges are spread
  ///       evenly; up to kFewEdges own edges at most their product, eight at a time.
  [[nodiscard]] bool holds_all_of(const RingIndex& other) const;

  /// Whether boundaries come as near to each other as cuts move them.
  /// Cost  as above, of few edges.
  [[nodiscard]] bool comes_near(const RingIndex& other) const;

 private:
  [[nodiscard]] Edge edge(std::uint32_t i) const {
    return {rings_.points()[i], rings_.points()[next_[i]]};
  }
  /// Whether edges of others meet the boundary; of many, also whether they leave the box around it.
  [[nodiscard]] bool meets_any_of(const RingIndex& other) const;

  GridRings rings_;
  GridBox box_;  // around all
  std::pmr::vector<std::uint32_t> next_;
  EdgeBoxes boxes_;
  std::optional<EdgeCells> cells_;  // of many edges
};

}  // namespace routebench::overlay
