#pragma once
/// What lies inside rings that cross each other, without cutting all of them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "overlay/grid_rings.hpp"
#include "overlay/overlay.hpp"
#include "overlay/planar_edges.hpp"

namespace routebench::overlay {

/// Rings that meet only by crossing, and how often they run round what lies beside them. From
/// crossing to crossing a ring has one winding number on either side, and a crossing tells those
/// after it from those before; so every ring is gone along once, and what is no boundary, as most
/// of a curve's loops are, is never touched again. Crossings are put to the nearest place of the
/// grid; it is looked at whether the boundary still meets nothing then.
class CrossedRings {
 public:
  /// Takes edges that are not cut and outlive it.
  /// Cost  linear in points and, up to its logarithm, in crossings, and for each set of rings that
  ///       cross each other the points of those round about it, up to a number of steps a point.
  explicit CrossedRings(const PlanarEdges& edges);

  /// The boundary of what is inside, to its left the inside: rings that meet nowhere and lie where
  /// the edges do. Nothing if that cannot be said: where edges touch, crossings lie so close to
  /// each other that rounding may change their order, the boundary meets itself at one, or is a
  /// sliver. Then edges have to be cut.
  /// Cost  linear.
  [[nodiscard]] std::optional<GridRings> boundary(Inside inside) const;

 private:
  /// Where a ring runs through a crossing, and the stretch of it up to the next one. Strands are
  /// numbered as cuts, so those of one crossing differ in the last bit.
  struct Strand {
    std::uint32_t ring;
    std::uint32_t next;
    std::uint32_t previous;
    bool leftwards;  ///< it passes to the left of the other one
    Winding right;   ///< of the stretch
  };
  struct Ring {
    GridBox box;
    std::uint32_t leftmost;   ///< point; of several the lowest
    std::uint32_t first_cut;  ///< in the order along rings
    std::uint32_t end_cut;
    Winding right = {};  ///< of one that crosses nothing
    bool is_known = false;
  };
  class Tracer;

  void sort_by_edges();
  bool put_in_order();
  bool find_windings();
  [[nodiscard]] Winding winding_around(std::uint32_t ring);
  [[nodiscard]] std::uint32_t strand_at(const Ring& ring) const;
  void go_along(std::uint32_t begin);

  const PlanarEdges& edges_;
  std::span<const Cut> cuts_;
  std::pmr::vector<std::uint32_t> order_;  // of strands along rings
  std::pmr::vector<Strand> strands_;
  std::pmr::vector<Ring> rings_;
  std::pmr::vector<std::uint32_t> begun_;  // strands
  std::size_t steps_ = 0;
  bool are_known_ = false;
};

}  // namespace routebench::overlay
