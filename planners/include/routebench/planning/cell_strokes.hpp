#pragma once
/// Polylines through the cells of a region.

#include <cstdint>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/planning/cell_grid.hpp"

namespace routebench {

/// Where the outline's cells are laid.
enum class RimPlace {
  kOutline,  ///< along the outline itself
  kCentres,  ///< from centre to centre
};

/// Goes along the outline, ring by ring, and lays every cell of it once: what comes into a cell
/// that was laid before, by another ring or some cells earlier, is left out.
///
/// Returns closed lines where a whole ring is laid; else the stretches of it, those shorter than
///         min_length_mm left out.
/// Cost    linear in the outline's cells; four bytes a cell.
[[nodiscard]] std::vector<std::vector<Point2>> rim_lines(const CellMap& map, RimPlace place,
                                                         double min_length_mm,
                                                         const PlanContext& context);

/// Where a row ends.
enum class RowEnds {
  kCentres,    ///< in the centre of its last cell
  kBesideRim,  ///< rim_distance_mm short of the outline, at most half a cell beyond that centre
  kBoundary,   ///< at the region's boundary
};

/// How rows are laid.
struct RowRule {
  std::uint32_t every = 1;  ///< which rows: those whose number from y = 0 is a multiple of this
  RowEnds ends = RowEnds::kCentres;
  double rim_distance_mm = 0;  ///< for kBesideRim
  double max_link_mm = 0;      ///< longest joint between neighbouring rows
};

/// Lays the cells for which `use` is set, row by row: every unbroken run of them is one level line,
/// and lines of neighbouring rows are joined straight, to and fro, where the joint stays inside.
///
/// Takes   edges of the region.
/// Returns polylines; a run of one cell alone is half a cell long.
/// Cost    linear in cells and runs; a joint costs a question to the edges.
[[nodiscard]] std::vector<std::vector<Point2>> row_lines(const CellMap& map,
                                                         const std::vector<bool>& use,
                                                         const EdgeGrid& edges, const RowRule& rule,
                                                         const PlanContext& context);

/// The closed line through the centres of cells, without the points where it runs straight on.
[[nodiscard]] std::vector<Point2> closed_line(const CellGrid& grid,
                                              const std::vector<std::uint32_t>& cells);

}  // namespace routebench
