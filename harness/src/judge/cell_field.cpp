#include "judge/cell_field.hpp"

#include <algorithm>

#include "judge/row_loops.hpp"

namespace routebench::judging {

NeighbourhoodMeans::NeighbourhoodMeans(const CellField& field, std::size_t reach,
                                       std::span<const Columns> wanted)
    : field_(field),
      reach_(reach),
      wanted_(wanted),
      row_size_(field.columns() + RowLoops::kFloatRoom),
      padded_(row_size_ + 2 * reach),
      along_((2 * reach - 1) * row_size_),
      means_(row_size_),
      from_(2 * reach - 1) {
  const auto weight = [reach](std::size_t distance) {
    return static_cast<float>(reach - distance) / static_cast<float>(reach * reach);
  };
  along_weights_.push_back(weight(0));
  for (std::size_t distance = 1; distance < reach; ++distance)
    along_weights_.insert(along_weights_.end(), 2, weight(distance));
  for (std::size_t distance = reach; distance-- > 1;) across_weights_.push_back(weight(distance));
  for (std::size_t distance = 0; distance < reach; ++distance)
    across_weights_.push_back(weight(distance));
}

std::size_t NeighbourhoodMeans::first_near(std::size_t row) const {
  return row + 1 - std::min(reach_, row + 1);
}

std::size_t NeighbourhoodMeans::last_near(std::size_t row) const {
  return std::min(row + reach_, field_.rows()) - 1;
}

float* NeighbourhoodMeans::along(std::size_t row) {
  return along_.data() + row % (2 * reach_ - 1) * row_size_;
}

void NeighbourhoodMeans::average_along(std::size_t row) {
  Columns near{field_.columns(), 0};
  for (std::size_t other = first_near(row); other <= last_near(row); ++other)
    if (!wanted_[other].empty())
      near = {std::min(near.first, wanted_[other].first), std::max(near.end, wanted_[other].end)};
  if (near.empty()) return;
  // With as many zeros before and after the row as a mean takes.
  const Columns taken{near.first - std::min(near.first, reach_),
                      std::min(near.end + reach_, field_.columns())};
  float* const from = padded_.data() + reach_;
  const float* const values = field_.row(row).data();
  std::copy(values + taken.first, values + taken.end, from + taken.first);
  from_[0] = from + near.first;
  for (std::size_t distance = 1; distance < reach_; ++distance) {
    from_[2 * distance - 1] = from + near.first + distance;
    from_[2 * distance] = from + near.first - distance;
  }
  row_loops().weighted_sum(from_.data(), along_weights_.data(), from_.size(),
                           along(row) + near.first, near.end - near.first);
}

std::span<const float> NeighbourhoodMeans::row(std::size_t row) {
  const Columns wanted = wanted_[row];
  if (wanted.empty()) return {};
  for (next_ = std::max(next_, first_near(row)); next_ <= last_near(row); ++next_)
    average_along(next_);
  const std::size_t first = first_near(row);
  const std::size_t near_count = last_near(row) + 1 - first;
  for (std::size_t i = 0; i < near_count; ++i) from_[i] = along(first + i) + wanted.first;
  const std::size_t count = wanted.end - wanted.first;
  row_loops().weighted_sum(from_.data(), across_weights_.data() + (first + reach_ - 1 - row),
                           near_count, means_.data(), count);
  return {means_.data(), count};
}

}  // namespace routebench::judging
