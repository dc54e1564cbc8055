#pragma once
/// The loops of concentric insets as a forest.

#include <cstdint>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"
#include "routebench/planning/ring_path.hpp"

namespace routebench::concentric {

inline constexpr std::uint32_t kNoLoop = UINT32_MAX;

/// A ring of an inset. Its parent is the nearest loop of the inset around it.
struct Loop {
  Ring ring;
  std::uint32_t parent = kNoLoop;
  std::vector<std::uint32_t> children;
  std::uint32_t region = 0;  ///< the polygon that it bounds, of all insets' polygons
};

/// All loops, from the outermost inset inwards; parents come before their children.
struct LoopForest {
  std::vector<Loop> loops;
  std::vector<std::uint32_t> roots;
};

/// Takes   insets from the outermost inwards, step_mm apart.
/// Cost    linear in points while a region has few holes.
[[nodiscard]] LoopForest loop_forest(const std::vector<Polygons>& insets, double step_mm,
                                     const PlanContext& context);

}  // namespace routebench::concentric
