#pragma once
/// Centre lines of parts that are too narrow for two lines side by side.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

/// How wide the strokes of centre lines are.
enum class CentreLineWidth {
  kMean,      ///< as wide as the part on average: the material that it takes
  kInscribed  ///< as wide as the part where it is narrowest: the bead stays inside
};

/// Which centre lines are laid.
struct CentreLineRule {
  double min_width_mm = 0.1;   ///< narrower places get none
  double max_width_mm = 0.6;   ///< wider places get a stroke of this width
  double min_length_mm = 0.2;  ///< shorter lines are left out
  double min_dot_mm = 1e9;     ///< parts without a line, but at least so wide, get a dot
  CentreLineWidth width = CentreLineWidth::kMean;
};

/// Strokes along the middle of narrow polygons. Each has one width, so a line is cut where its
/// width changes by more than a quarter, in long pieces by less; the pieces meet. So do the arms of
/// a fork. Spurs into corners are left out, and a line ends half its width before the end of its
/// part. A compact part, no longer than two of the greatest widths, gets about the largest
/// inscribed stroke on its long axis, if strokes are inscribed. A dot is as short a stroke as fits
/// beside its own width.
///
/// Takes   polygons on the grid, in any frame: moving them moves the strokes by just that.
/// Returns strokes inside the polygons, on the grid, in an order of no meaning.
/// Throws  Error{kStopped} when asked to stop.
/// Cost    O(n log n) in vertices and in the boundary's length over the parts' width.
/// Source  chordal axis: the middles of the chords of a constrained Delaunay triangulation, L.
///         Prasad, 1997.
[[nodiscard]] std::vector<Stroke> centre_lines(const Polygons& thin, const CentreLineRule& rule,
                                               const PlanContext& context);

/// The sides of narrow parts along which something is taken already.
struct TakenSides {
  std::vector<Ring> rings;       ///< directed, the parts to their left, in whatever order
  std::vector<double> taken_mm;  ///< along each ring; all widths are of what is left
};

/// As above, along the middle of what is left between sides.
[[nodiscard]] std::vector<Stroke> centre_lines(TakenSides sides, const CentreLineRule& rule,
                                               const PlanContext& context);

}  // namespace routebench
