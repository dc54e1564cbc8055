#pragma once
/// Beads that do not keep inside the outline.

#include <vector>

#include "judge/run.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::judging {

struct Bead {
  Point2 a;
  Point2 b;
  double width_mm = 0;
};

/// What leaves a layer's polygons.
struct Strays {
  /// Those of whose centre lines some point lies outside or on the boundary, and those wider than a
  /// line. All of every other bead is inside or less than half a line away from the boundary.
  std::vector<Bead> beads;
  /// Length of centre lines outside, and of beads thinner than a tenth of a line.
  double hollow_mm = 0;
};

/// Looks at every bead. Cost of most of them that of asking for the edges near it: a run that has
/// met no edge since it was last inside is inside still.
[[nodiscard]] Strays strays_of(const std::vector<Run>& runs, const EdgeGrid& outline,
                               double line_width_mm);

}  // namespace routebench::judging
