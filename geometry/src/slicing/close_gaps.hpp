#pragma once
/// What to do with lines that do not close: cracks between facets, missing facets, surfaces without
/// thickness.

#include <cstddef>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "slicing/chain_segments.hpp"

namespace routebench::slicing {

/// What was done to close the lines of one layer.
struct Closing {
  std::size_t cracks = 0;  ///< gaps up to crack_mm that were bridged
  double widest_crack_mm = 0;
  std::size_t gaps = 0;  ///< wider ones
  double widest_gap_mm = 0;
  std::size_t dropped = 0;  ///< lines left out: to close them, too much would have to be invented
  double longest_dropped_mm = 0;
  std::size_t turned = 0;  ///< lines that had to be joined against their direction

  /// The widest gap beyond crack_mm, bridged or given up, and where it is; 0 if there is none.
  double widest_open_mm = 0;
  Point2 widest_open_at;
};

/// Joins open lines to rings across their gaps, the narrowest gaps first, ends to beginnings where
/// there is a choice, and adds the rings to `rings`. Rings that would consist of gaps wider than
/// crack_mm for a large part are left out.
///
/// The result depends on the lines alone, not on their order among equals elsewhere.
/// Cost about linear in the number of lines and their points.
[[nodiscard]] Closing close_gaps(const std::vector<Chain>& open, double crack_mm,
                                 std::vector<Ring>& rings);

}  // namespace routebench::slicing
