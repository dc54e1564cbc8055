#pragma once
/// Closed walks that visit cells of a grid once each.

#include <cstdint>
#include <functional>
#include <vector>

#include "routebench/planning/cell_grid.hpp"

namespace routebench {

/// Answers whether one may go straight from the centre of a cell to that of another one that
/// touches it in a corner.
using DiagonalIsClear = std::function<bool(std::uint32_t, std::uint32_t)>;

/// Makes one circuit of every part of the region that two by two cells can be moved through, and
/// takes in what cells beside it can be reached by a detour. No cell is visited twice. Blocks of
/// two by two cells are circuits of four; neighbouring circuits become one by exchanging a pair of
/// parallel links, so the whole goes once round a spanning tree of the blocks: the Euler circuit of
/// the tree with every edge doubled.
///
/// Takes   cells of which only those with `free` set are used, for example the inner ones.
/// Returns circuits as cells in their order, the first not repeated, by their lowest cell. `free`
///         is cleared for the cells used: what is left lies in places one cell wide or has no
///         neighbour that would take it.
/// Cost    near linear in cells; about six bytes a cell.
/// Source  Y. Gabriely and E. Rimon, 2001 (spanning tree coverage).
[[nodiscard]] std::vector<std::vector<std::uint32_t>> cell_circuits(const CellMap& map,
                                                                    std::vector<bool>& free,
                                                                    const DiagonalIsClear& clear);

}  // namespace routebench
