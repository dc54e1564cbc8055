#pragma once
/// One closed stroke over everything: round a spanning tree at half a cell's distance.

#include <vector>

#include "eulerian/lattice.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::eulerian {

/// Which edges the spanning tree takes first.
enum class TreeOrder {
  kRows,     ///< rows as long as can be, then one edge from row to row
  kColumns,  ///< the same, turned by 90 degrees
  kFirst,    ///< by place, whatever direction they have
};

/// Strokes over a lattice.
struct TreeStrokes {
  std::vector<std::vector<Point2>> loops;  ///< each repeats its first point
  std::vector<std::vector<Point2>> lines;  ///< where the region is too narrow for a loop
};

/// Visits every node of a lattice once.
///
/// Four nodes make a cell. A spanning tree over the cells, each of its edges doubled, has an Euler
/// circuit; led at half a cell's distance from the tree it passes all nodes of all cells once. It
/// is built as it is walked: each cell is a loop of four nodes, and a tree edge joins two loops to
/// one. Nodes beyond the cells are taken into a loop that passes by, two at a time or one. Of
/// chains of nodes that are left, where the region is too narrow for a loop, those of one or two
/// nodes are walked there and back by the loop at their end; longer ones become lines.
///
/// Returns one loop for each part of the lattice that cells hold together. A node without any
///         neighbour is left out.
/// Cost    near linear in places.
/// Source  Y. Gabriely and E. Rimon, 2001, spanning-tree coverage; cells that the region cuts, and
///         following the wall, are our additions.
[[nodiscard]] TreeStrokes cover_by_tree(const Lattice& lattice, TreeOrder order,
                                        const PlanContext& context);

}  // namespace routebench::eulerian
