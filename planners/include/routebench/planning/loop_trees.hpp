#pragma once
/// Loops of concentric insets, and which of them lie side by side.

#include <cstdint>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

/// A ring of an inset as a node of a tree.
struct InsetLoop {
  Ring ring;
  bool is_root = true;
  std::vector<std::uint32_t> children{};  ///< those over which most loops are reached first
};

/// Joins loops that lie side by side to trees: first those of neighbouring insets, then those of
/// one inset that face each other across a corridor; always those first that do so longest.
///
/// Takes   insets from the outermost inwards, step_mm apart.
/// Returns their rings, inset by inset; the first loop of a tree is its root.
/// Cost    linear in points while a loop has few neighbours; boxes of loops of neighbouring insets
///         are compared in pairs.
/// Source  spiral-contour tree, H. Zhao et al., 2016.
[[nodiscard]] std::vector<InsetLoop> loop_trees(const std::vector<Polygons>& insets, double step_mm,
                                                const PlanContext& context);

}  // namespace routebench
