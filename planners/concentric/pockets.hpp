#pragma once
/// Pockets: loops that are laid without a stop because none of them forks.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "loops.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::concentric {

/// Loops each of which is the only child of the one before.
struct Pocket {
  std::vector<std::uint32_t> loops;
  std::vector<std::uint32_t> children;  ///< other pockets
};

struct PocketForest {
  std::vector<Pocket> pockets;
  std::vector<std::uint32_t> roots;
};

/// The forest with unforked chains drawn together, or with a pocket for every loop.
[[nodiscard]] PocketForest pocket_forest(const LoopForest& loops, bool chains);

/// One stroke over a pocket, from the vertex `start` of its first loop: once round that loop if
/// it is dense, then a spiral from loop to loop, and round the last one. A pocket of one loop is
/// that loop. Where a turn between two loops would leave the area or stray from them, a new stroke
/// begins. Cost   near linear in points.
[[nodiscard]] std::vector<std::vector<Point2>> spirals(const LoopForest& forest,
                                                       const Pocket& pocket, std::size_t start,
                                                       double step_mm, bool dense,
                                                       const EdgeGrid& area);

}  // namespace routebench::concentric
