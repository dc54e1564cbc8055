#pragma once
/// A mesh in a container of cells, two bits each: does the surface run through it, is it outside?

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::slicing {

/// Where the cells lie, and how many. The outermost ones along every axis are never touched by the
/// surface.
struct VoxelFrame {
  Point3 first;  ///< centre of the cell (0, 0, 0), mm
  Point3 pitch;  ///< from centre to centre, mm
  std::array<std::int64_t, 3> count{};

  /// 64 cells of a row are a word.
  [[nodiscard]] std::size_t row_words() const noexcept {
    return (static_cast<std::size_t>(count[0]) + 63) / 64;
  }
  [[nodiscard]] std::size_t rows() const noexcept {
    return static_cast<std::size_t>(count[1]) * static_cast<std::size_t>(count[2]);
  }
  [[nodiscard]] std::size_t words() const noexcept { return row_words() * rows(); }
  /// What a VoxelGrid takes: two bits a cell, whole words a row.
  [[nodiscard]] double bytes() const noexcept {
    const double words = std::ceil(static_cast<double>(count[0]) / 64);
    return 16 * words * static_cast<double>(count[1]) * static_cast<double>(count[2]);
  }
  [[nodiscard]] std::size_t row(std::int64_t y, std::int64_t z) const noexcept {
    return static_cast<std::size_t>(z * count[1] + y);
  }
};

/// A place, or a direction, in cells: whole numbers are centres.
using CellPoint = std::array<double, 3>;
using Cell = std::array<std::int64_t, 3>;

class VoxelGrid {
 public:
  explicit VoxelGrid(const VoxelFrame& frame);

  /// Draws triangles: the longest edge by Bresenham's line, then from each of its cells a line to
  /// the opposite corner. Where these lines part they would leave pinholes. So in addition every
  /// line from centre to centre along an axis that meets the triangle marks the cell nearest to
  /// where: no way from neighbour to neighbour through unmarked cells crosses the surface.
  ///
  /// Cost   linear in the cells of the triangle, and in its edges.
  /// Source K. De Keyser, 2016, Cartesian algorithm; closing it is ours, by the crosshairs of
  ///        S. Laine, 2013.
  void draw(const Mesh& mesh);

  /// Finds the cells that can be reached from the container's border without touching the surface.
  /// Cost   linear in words for each time that a row is reached anew, a few in practice.
  void flood_outside();

  /// Whether a cell is surface or enclosed by it. Takes a cell of the container.
  [[nodiscard]] bool is_material(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
    const std::size_t word =
        frame_.row(y, z) * frame_.row_words() + static_cast<std::size_t>(x) / 64;
    return (outside_[word] >> (static_cast<std::size_t>(x) % 64) & 1U) == 0;
  }

  [[nodiscard]] const VoxelFrame& frame() const noexcept { return frame_; }

 private:
  [[nodiscard]] CellPoint in_cells(const Point3& p) const;
  /// Marks the cell nearest to a place; those beyond the inner cells count as on their border.
  void mark(const CellPoint& p);
  void mark(const Cell& cell);
  template <typename Visit>
  void visit_line(Cell from, const Cell& to, Visit&& visit);
  void draw_as_published(const std::array<CellPoint, 3>& corners);
  /// Marks where lines along `axis` meet the triangle.
  void close_pinholes(const std::array<CellPoint, 3>& corners, std::size_t axis);
  bool flood_row(std::size_t row);

  VoxelFrame frame_;
  std::vector<std::uint64_t> surface_;
  std::vector<std::uint64_t> outside_;
};

}  // namespace routebench::slicing
