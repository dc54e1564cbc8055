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

  /// True if the whole segment lies inside or on the boundary (within a few grid units).
  [[nodiscard]] bool covers(Point2 a, Point2 b) const;

  /// Distance to the nearest edge if that is at most limit_mm.
  [[nodiscard]] std::optional<double> distance_to_edge_mm(Point2 p, double limit_mm) const;

 private:
  struct Edge {
    Point2 a, b;
  };
  template <typename Visit>
  void visit_edges(Point2 a, Point2 b, double margin_mm, Visit&& visit) const;
  [[nodiscard]] std::int64_t column(double x) const;
  [[nodiscard]] std::int64_t row(double y) const;

  std::vector<Edge> edges_;
  std::vector<std::uint32_t>
      cell_begin_;  // edges of cell c: cell_edges_[cell_begin_[c] .. cell_begin_[c + 1])
  std::vector<std::uint32_t> cell_edges_;
  Point2 origin_{};
  double cell_mm_ = 1;
  std::int64_t columns_ = 0;
  std::int64_t rows_ = 0;
};

}  // namespace routebench
