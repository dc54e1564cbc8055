#pragma once
/// A region as cells of a grid: its outline drawn, its inside filled.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"
#include "routebench/planning/ring_path.hpp"

namespace routebench {

/// Where the cells lie. Cells are numbered row by row, from the lowest row upwards.
struct CellGrid {
  Point2 first;     ///< centre of cell 0
  Point2 pitch_mm;  ///< from centre to centre, along x and along y
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;

  [[nodiscard]] std::size_t size() const noexcept { return std::size_t{columns} * rows; }
  [[nodiscard]] std::uint32_t cell(std::uint32_t column, std::uint32_t row) const noexcept {
    return row * columns + column;
  }
  [[nodiscard]] std::uint32_t column(std::uint32_t cell) const noexcept { return cell % columns; }
  [[nodiscard]] std::uint32_t row(std::uint32_t cell) const noexcept { return cell / columns; }
  [[nodiscard]] double x(std::uint32_t column) const noexcept {
    return first.x + column * pitch_mm.x;
  }
  [[nodiscard]] double y(std::uint32_t row) const noexcept { return first.y + row * pitch_mm.y; }
  /// On the grid of coordinates.
  [[nodiscard]] Point2 centre(std::uint32_t cell) const noexcept;
};

/// Square cells over a box, their centres at multiples of the pitch, so that those of one region
/// lie over those of another. Throws Error{kBadInput} beyond 2^30 cells.
[[nodiscard]] CellGrid anchored_cells(const Box2& box, double pitch_mm);

/// Cells whose outermost centres lie on the sides of a box: nearly a spacing wide, and never wider
/// than a line. Throws Error{kBadInput} beyond 2^30 cells.
[[nodiscard]] CellGrid fitted_cells(const Box2& box, const PlanContext& context);

/// One cell on the way of a ring, and where the ring comes to it.
struct CellStep {
  std::uint32_t cell = 0;
  RingPlace enter;
};

/// The cells that a ring runs through, in its direction: a closed chain in which neighbours touch
/// in a side or a corner. Along its longer extent an edge has one cell in each column (or row), the
/// one whose centre is nearest to it. Only cells whose centre is half a cell or more from the ring,
/// measured along the row and along the column, are left out.
///
/// Cost   linear in cells and vertices.
/// Source J. Bresenham, 1965; the error begins where the edge does, not in a cell's centre.
[[nodiscard]] std::vector<CellStep> cells_of_ring(const CellGrid& grid, const Ring& ring);

/// What a cell is; flags may be combined.
enum CellFlag : std::uint8_t {
  kRimCell = 1,     ///< the outline runs through it
  kInsideCell = 2,  ///< its centre lies in the region
  kEastLink = 4,    ///< one may go straight from its centre to that of the next column
  kNorthLink = 8,   ///< and to that of the next row
};

/// Cells of a row that lie in the region without a gap, and where the row's line enters and leaves.
struct CellSpan {
  std::uint32_t row = 0;
  std::uint32_t first = 0;  ///< column
  std::uint32_t last = 0;   ///< column, >= first
  double left_mm = 0;
  double right_mm = 0;
};

/// A region as cells.
struct CellMap {
  CellGrid grid;
  std::vector<Ring> rings;                   ///< the outer one first
  std::vector<std::vector<CellStep>> steps;  ///< of each ring
  std::vector<CellSpan> spans;               ///< by row, then along it
  std::vector<std::uint8_t> flags;           ///< of each cell

  /// What the paper numbers 2: inside, and not on the outline.
  [[nodiscard]] bool is_inner(std::uint32_t cell) const noexcept {
    return (flags[cell] & (kRimCell | kInsideCell)) == kInsideCell;
  }
};

/// Draws a region's outline into a grid and fills its inside.
/// Cost   linear in cells, vertices and crossings of rows and columns; a byte a cell.
/// Source K. De Keyser, 2016, Cartesian algorithm, in two dimensions.
[[nodiscard]] CellMap map_cells(const CellGrid& grid, const Polygon& region);

}  // namespace routebench
