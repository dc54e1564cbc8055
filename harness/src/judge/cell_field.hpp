#pragma once
/// A quantity spread over square cells, and its average over a neighbourhood.

#include <cstddef>
#include <vector>

namespace routebench::judging {

class CellField {
 public:
  CellField(std::size_t columns, std::size_t rows)
      : columns_(columns), rows_(rows), values_(columns * rows) {}

  [[nodiscard]] float& at(std::size_t column, std::size_t row) {
    return values_[row * columns_ + column];
  }
  [[nodiscard]] const std::vector<float>& values() const noexcept { return values_; }

  /// Replaces every value by the mean of those up to reach - 1 cells away in both directions,
  /// weighted by reach minus the distance: a tent. Nothing lies outside. Waves whose length divides
  /// `reach` vanish. Cost linear in cells x reach.
  void average(std::size_t reach);

 private:
  std::size_t columns_;
  std::size_t rows_;
  std::vector<float> values_;
};

}  // namespace routebench::judging
