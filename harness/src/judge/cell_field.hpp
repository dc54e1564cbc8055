#pragma once
/// A quantity spread over square cells, and its average over a neighbourhood.

#include <cstddef>
#include <span>
#include <vector>

namespace routebench::judging {

/// Cells of a row, from the first to before the end.
struct Columns {
  std::size_t first = 0;
  std::size_t end = 0;

  [[nodiscard]] bool empty() const noexcept { return first >= end; }
};

class CellField {
 public:
  CellField(std::size_t columns, std::size_t rows)
      : columns_(columns), rows_(rows), values_(columns * rows) {}

  [[nodiscard]] std::size_t columns() const noexcept { return columns_; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
  [[nodiscard]] float& at(std::size_t column, std::size_t row) {
    return values_[row * columns_ + column];
  }
  [[nodiscard]] std::span<const float> row(std::size_t row) const {
    return {values_.data() + row * columns_, columns_};
  }

 private:
  std::size_t columns_;
  std::size_t rows_;
  std::vector<float> values_;
};

/// Of cells of a field the mean of the values up to reach - 1 cells away in both directions,
/// weighted by reach minus the distance: a tent. Nothing lies outside. Waves whose length divides
/// `reach` vanish. Cost linear in the cells that are wanted, in those about them in their columns,
/// and in `reach`.
class NeighbourhoodMeans {
 public:
  /// Takes the cells of each row whose means are wanted. Field and cells must outlive this.
  NeighbourhoodMeans(const CellField& field, std::size_t reach, std::span<const Columns> wanted);

  /// The means of the wanted cells of a row. To be asked for rows upwards.
  [[nodiscard]] std::span<const float> row(std::size_t row);

 private:
  /// The rows that reach as far as this one.
  [[nodiscard]] std::size_t first_near(std::size_t row) const;
  [[nodiscard]] std::size_t last_near(std::size_t row) const;
  /// Memory of one row's means along the row.
  [[nodiscard]] float* along(std::size_t row);
  void average_along(std::size_t row);

  const CellField& field_;
  std::size_t reach_;
  std::span<const Columns> wanted_;
  std::size_t row_size_;       // of memory
  std::size_t next_ = 0;       // row whose means along it are not known yet
  std::vector<float> padded_;  // a row of the field between zeros
  std::vector<float> along_;   // of as many rows as a mean takes, in turn
  std::vector<float> means_;
  std::vector<const float*> from_;
  std::vector<float> along_weights_;   // from the middle outwards, before and after in turn
  std::vector<float> across_weights_;  // from the first row that reaches to the last
};

}  // namespace routebench::judging
