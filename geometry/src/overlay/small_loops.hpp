#pragma once
/// Small loops in the boundary of polygons that grow or shrink.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "overlay/grid_rings.hpp"

namespace routebench::overlay {

/// A point of a moved boundary.
struct DrawnPoint {
  GridPoint at;
  bool ends_side = true;  ///< a moved side leads here, not the way to a corner or back from there
  bool is_far = false;    ///< farther from the unmoved boundary than the distance: a mitre's tip
};

/// Takes loops of a few edges out of a moved boundary that run round places which are nearer to
/// the unmoved one than the distance, as they are about corners whose sides are shorter than the
/// distance. Of each the point is left where it crosses itself. Whatever else crosses stays, so
/// that it takes an overlay to tell what is inside; but most curves cross nowhere after that.
///
/// Where the boundary moves inwards such loops turn right, and have the inside on neither hand; so
/// do others that turn right and lie apart from the rest, however large. Outwards they turn left,
/// and are inside what the rest encloses.
class SmallLoops {
 public:
  /// Takes whether the boundary is one ring.
  SmallLoops(bool moves_outwards, bool is_only_ring, std::pmr::memory_resource* memory)
      : turns_left_(moves_outwards), is_only_ring_(is_only_ring), kept_(memory), corners_(memory) {}

  /// Cost  some ten comparisons for each edge that follows soon after a way to a corner; in a
  ///       curve of a few hundred points, some for each point and loop.
  void drop_from(std::pmr::vector<DrawnPoint>& curve);

 private:
  struct Loop {
    std::size_t begin;  ///< of the edges kept
    GridPoint crossing;
    double twice_area;  ///< positive to the left
    bool is_far;        ///< some point of it is
  };

  [[nodiscard]] std::optional<Loop> loop_closed_by(const DrawnPoint& end) const;
  [[nodiscard]] bool winds_right(const Loop& loop, GridPoint end) const;
  [[nodiscard]] bool lies_outside(const Loop& loop, std::span<const DrawnPoint> ahead) const;
  void keep(const DrawnPoint& point);
  void cut_off(const Loop& loop);

  bool turns_left_;
  bool is_only_ring_;
  std::pmr::vector<DrawnPoint> kept_;
  std::pmr::vector<std::size_t> corners_;  ///< of the points kept those that end no side
  std::size_t first_ = 0;                  ///< edge kept from which on loops may go
};

}  // namespace routebench::overlay
