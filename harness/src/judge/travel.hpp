#pragma once
/// The moves between runs.

#include <cstddef>
#include <optional>
#include <vector>

#include "judge/run.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/harness/task.hpp"

namespace routebench::judging {

struct Travel {
  Point2 from;
  Point2 to;
  double length_mm = 0;
  double outside_mm = 0;   ///< of it, outside the layer's polygons
  bool crosses = false;    ///< leaves the polygons for more than rounding could account for
  bool retracted = false;  ///< by the printer's policy
};

/// The travel before each run but the first, in order. Travels run straight.
[[nodiscard]] std::vector<Travel> travels_between(const std::vector<Run>& runs,
                                                  const EdgeGrid& outline, const Printer& printer);

/// The travel to the first run from where the nozzle was before.
[[nodiscard]] Travel travel_to(Point2 from, Point2 to, const EdgeGrid& outline,
                               const Printer& printer);

}  // namespace routebench::judging
