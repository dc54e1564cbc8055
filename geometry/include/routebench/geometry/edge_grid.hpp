#pragma once
/// Questions about where a segment runs with respect to polygons, answered in time that does not
/// depend on their size.

#include <cstdint>
#include <optional>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Uniform grid over the edges of polygons. Immutable after construction; queries are const and
/// safe from any thread. Cost   construction linear in edges; a query proportional to the cells
/// that the segment runs through.
class EdgeGrid {
 public:
  explicit EdgeGrid(const Polygons& polygons);

  /// True for points inside or on the boundary.
  [[nodiscard]] bool contains(Point2 p) const;

  /// Length of segment ab that lies outside the polygons, mm. Running along an edge counts as
  /// inside.
  [[nodiscard]] double outside_length_mm(Point2 a, Point2 b) const;

  /// Where the boundary crosses or touches segment ab, as sorted shares of its length in [0, 1],
  /// each once.
  [[nodiscard]] std::vector<double> crossings(Point2 a, Point2 b) const;

  /// True if the boundary crosses or touches segment ab (within a few grid units): wherever
  /// crossings() finds a place, at less cost.
  [[nodiscard]] bool meets(Point2 a, Point2 b) const;

  /// True if the whole segment lies inside or on the boundary (within a few grid units).
  [[nodiscard]] bool covers(Point2 a, Point2 b) const;

  /// Distance to the nearest edge if that is at most limit_mm.
  [[nodiscard]] std::optional<double> distance_to_edge_mm(Point2 p, double limit_mm) const;

 private:
  struct Edge {
    Point2 a, b;
    double per_squared_length;  // 1 / mm2
  };
  /// Index lists of many buckets in one array: bucket i holds items[begin[i] .. begin[i + 1]).
  struct Buckets {
    std::vector<std::uint32_t> begin;
    std::vector<std::uint32_t> items;
  };
  struct Cells {
    std::int64_t first_column, last_column;
    std::int64_t first_row, last_row;
  };
  /// The cells that a box meets, or else those nearest to it.
  [[nodiscard]] Cells cells_of(double lower_x, double lower_y, double upper_x,
                               double upper_y) const;
  /// Calls visit(cell) for every cell that comes within margin_mm of segment ab.
  template <typename Visit>
  void visit_cells(Point2 a, Point2 b, double margin_mm, Visit&& visit) const;
  /// Edges in the cells that come within margin_mm of segment ab, each once, ascending.
  [[nodiscard]] std::vector<std::uint32_t> edges_near(Point2 a, Point2 b, double margin_mm) const;
  [[nodiscard]] std::int64_t column(double x) const;
  [[nodiscard]] std::int64_t row(double y) const;

  std::vector<Edge> edges_;
  Buckets cells_;  // row by row
  Buckets rows_;   // every edge that a horizontal line through the row may meet
  Point2 lower_{};
  Point2 upper_{};
  double cell_mm_ = 1;
  std::int64_t column_count_ = 0;
  std::int64_t row_count_ = 0;
};

}  // namespace routebench
