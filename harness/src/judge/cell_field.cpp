#include "judge/cell_field.hpp"

#include <algorithm>

namespace routebench::judging {
namespace {

/// Adds weight x from[0 .. count) to to[0 .. count).
void add_scaled(const float* from, float* to, std::size_t count, float weight) {
  for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

void CellField::average(std::size_t reach) {
  // Each direction in turn. The loops run over whole rows at one distance after the other, which
  // compilers turn into vector instructions.
  const auto weight = [reach](std::size_t distance) {
    return static_cast<float>(reach - distance) / static_cast<float>(reach * reach);
  };
  std::vector<float> rows(values_.size());
  for (std::size_t row = 0; row < rows_; ++row) {
    const float* from = values_.data() + row * columns_;
    float* to = rows.data() + row * columns_;
    add_scaled(from, to, columns_, weight(0));
    for (std::size_t d = 1; d < std::min(reach, columns_); ++d) {
      add_scaled(from + d, to, columns_ - d, weight(d));
      add_scaled(from, to + d, columns_ - d, weight(d));
    }
  }
  std::ranges::fill(values_, 0.0F);
  for (std::size_t row = 0; row < rows_; ++row) {
    const std::size_t first = row + 1 - std::min(reach, row + 1);
    const std::size_t last = std::min(row + reach, rows_) - 1;
    for (std::size_t other = first; other <= last; ++other)
      add_scaled(rows.data() + other * columns_, values_.data() + row * columns_, columns_,
                 weight(other < row ? row - other : other - row));
  }
}

}  // namespace routebench::judging
