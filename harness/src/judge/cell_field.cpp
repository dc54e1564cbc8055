#include "judge/cell_field.hpp"

#include <algorithm>

namespace routebench::judging {
namespace {

/// Adds weight x from[0 .. count) to to[0 .. count), which compilers turn into vector instructions.
void add_scaled(const float* from, float* to, std::size_t count, float weight) {
  for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

Columns CellField::occupied(std::size_t row) const {
  const std::span<const float> values = this->row(row);
  const auto is_set = [](float value) { return value != 0; };
  const auto first = std::find_if(values.begin(), values.end(), is_set);
  const auto last = std::find_if(values.rbegin(), values.rend(), is_set);
  if (first == values.end()) return {};
  return {static_cast<std::size_t>(first - values.begin()),
          static_cast<std::size_t>(values.rend() - last)};
}

NeighbourhoodMeans::NeighbourhoodMeans(const CellField& field, std::size_t reach,
                                       std::span<const Columns> wanted)
    : field_(field),
      reach_(reach),
      wanted_(wanted),
      along_((2 * reach - 1) * field.columns()),
      means_(field.columns()) {}

std::size_t NeighbourhoodMeans::first_near(std::size_t row) const {
  return row + 1 - std::min(reach_, row + 1);
}

std::size_t NeighbourhoodMeans::last_near(std::size_t row) const {
  return std::min(row + reach_, field_.rows()) - 1;
}

float* NeighbourhoodMeans::along(std::size_t row) {
  return along_.data() + row % (2 * reach_ - 1) * field_.columns();
}

void NeighbourhoodMeans::average_along(std::size_t row) {
  Columns near{field_.columns(), 0};
  for (std::size_t other = first_near(row); other <= last_near(row); ++other)
    if (!wanted_[other].empty())
      near = {std::min(near.first, wanted_[other].first), std::max(near.end, wanted_[other].end)};
  if (near.empty()) return;
  const float* from = field_.row(row).data();
  float* to = along(row);
  std::fill(to + near.first, to + near.end, 0.0F);
  // One distance after the other over the whole row.
  add_scaled(from + near.first, to + near.first, near.end - near.first, weight(0));
  for (std::size_t d = 1; d < std::min(reach_, field_.columns()); ++d) {
    const std::size_t end = std::min(near.end, field_.columns() - d);
    if (near.first < end)
      add_scaled(from + near.first + d, to + near.first, end - near.first, weight(d));
    const std::size_t first = std::max(near.first, d);
    if (first < near.end) add_scaled(from + first - d, to + first, near.end - first, weight(d));
  }
}

std::span<const float> NeighbourhoodMeans::row(std::size_t row) {
  const Columns wanted = wanted_[row];
  if (wanted.empty()) return {};
  for (next_ = std::max(next_, first_near(row)); next_ <= last_near(row); ++next_)
    average_along(next_);
  const std::size_t count = wanted.end - wanted.first;
  std::fill(means_.begin(), means_.begin() + static_cast<std::ptrdiff_t>(count), 0.0F);
  for (std::size_t other = first_near(row); other <= last_near(row); ++other)
    add_scaled(along(other) + wanted.first, means_.data(), count,
               weight(other < row ? row - other : other - row));
  return {means_.data(), count};
}

}  // namespace routebench::judging
