#pragma once
/// Loops joined to long strokes by short steps.

#include <cstdint>
#include <vector>

#include "loops.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::concentric {

/// Joins the loops of a forest, and its trees where their loops come within two steps of each
/// other (round a hole). Every loop is opened as far as a step is wide, and nothing is laid twice.
class TreeLinker {
 public:
  /// Takes   the forest and the area that joints must not leave; loops lie step_mm apart, openings
  ///         are gap_mm wide.
  TreeLinker(const LoopForest& forest, const EdgeGrid& area, double step_mm, double gap_mm,
             const PlanContext& context);

  /// Strokes over all loops that hang together with `root`, which begins at its vertex `start`. The
  /// first stroke has most of the loops: it ends with the last loop of its longest branch, other
  /// branches are laid on the way, there and back. Further strokes are loops that have no place
  /// for a joint.
  [[nodiscard]] std::vector<std::vector<Point2>> strokes_from(std::uint32_t root,
                                                              std::size_t start) const;

  /// Loops that hang together have the same number.
  [[nodiscard]] std::uint32_t group_of(std::uint32_t loop) const { return group_[loop]; }

 private:
  class Tracer;

  void bridge_trees();

  const LoopForest& forest_;
  const EdgeGrid& area_;
  double step_mm_;
  double gap_mm_;
  const PlanContext& context_;
  std::vector<std::vector<std::uint32_t>> joined_;  // neighbours of a loop
  std::vector<std::uint32_t> group_;
};

}  // namespace routebench::concentric
