#pragma once
/// Points that are sought by nearness and taken away one by one: what most orderings need.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Uniform grid over points with deletion; built anew when a quarter of the points is left. A point
/// is named by its place in the vector given at first.
/// Cost   build linear. Search and deletion constant for points spread evenly; many points in a
///        small part of their box make a search as slow as the fullest cell.
class NearestGrid {
 public:
  explicit NearestGrid(std::vector<Point2> points);

  /// The nearest point that is left; of equally near ones the one with the smallest number. Nothing
  /// if none is left.
  [[nodiscard]] std::optional<std::uint32_t> nearest(Point2 from) const;

  /// Takes a point away. Taking it away again does nothing.
  void remove(std::uint32_t point);

  [[nodiscard]] bool has(std::uint32_t point) const { return slot_[point] != kTaken; }
  [[nodiscard]] std::size_t size() const noexcept { return left_; }

 private:
  static constexpr std::uint32_t kTaken = UINT32_MAX;

  struct Best {
    double squared_mm;
    std::uint32_t point;
  };

  void build();
  [[nodiscard]] std::int64_t column(double x) const;
  [[nodiscard]] std::int64_t row(double y) const;
  [[nodiscard]] std::size_t cell_of(Point2 p) const;
  void look_into(std::int64_t column, std::int64_t row, Point2 from, Best& best) const;

  std::vector<Point2> points_;
  std::vector<std::uint32_t> slot_;        // place of a point in items_, or kTaken
  std::vector<std::uint32_t> items_;       // points, cell by cell
  std::vector<std::uint32_t> cell_begin_;  // of a cell in items_
  std::vector<std::uint32_t> cell_end_;    // behind the last point that is left in the cell
  std::size_t left_ = 0;
  std::size_t built_with_ = 0;
  Point2 lower_{};
  Point2 upper_{};
  double cell_mm_ = 1;
  std::int64_t columns_ = 0;
  std::int64_t rows_ = 0;
};

}  // namespace routebench
