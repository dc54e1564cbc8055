#pragma once
/// Which loops and which centre lines fill a region.

#include <vector>

#include "insets.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::concentric {

struct RingRule {
  Method method = Method::kClipper;
  bool thin = true;         ///< centre lines where two sides of a loop would lie too near
  double min_gap_mm = 0.1;  ///< narrower gaps stay open
};

/// What is laid in a region, before it is put in order.
struct Rings {
  std::vector<Polygons> insets;  ///< their rings are the loops, outermost first
  std::vector<Stroke> centre_lines;
};

/// Loops a line distance apart, the first half a line width inside. With rule.thin their two sides
/// keep a spacing apart; what that leaves, and at density 1 every gap, gets centre lines.
/// Cost   near linear in the points of all loops (see insets).
[[nodiscard]] Rings rings_in(const Polygons& polygons, const RingRule& rule,
                             const PlanContext& context);

}  // namespace routebench::concentric
