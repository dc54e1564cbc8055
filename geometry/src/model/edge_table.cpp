#include "model/edge_table.hpp"

#include <utility>

#include "model/blocks.hpp"

namespace routebench::models {
namespace {

/// Calls visit(lower, upper, rising) for the three sides of a triangle.
template <typename Visit>
void for_each_side(const std::array<std::uint32_t, 3>& triangle, Visit&& visit) {
  for (const auto& [from, to] :
       {std::pair(triangle[0], triangle[1]), std::pair(triangle[1], triangle[2]),
        std::pair(triangle[2], triangle[0])}) {
    visit(std::min(from, to), std::max(from, to), from < to);
  }
}

}  // namespace

EdgeTable::EdgeTable(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices,
                     const ParallelFor& parallel_for)
    : begin_(vertices + 2, 0), sides_(triangles.size() * 3) {
  // Counts are kept two places up, so that after filling each entry is the beginning of its own.
  for (const auto& triangle : triangles) {
    for_each_side(triangle, [&](std::uint32_t lower, std::uint32_t, bool) { ++begin_[lower + 2]; });
  }
  for (std::size_t v = 2; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for_each_side(triangles[t], [&](std::uint32_t lower, std::uint32_t upper, bool rising) {
      sides_[begin_[lower + 1]++] = Side(upper, static_cast<std::uint32_t>(t), rising);
    });
  }
  begin_.pop_back();
  for_each_block(vertices, parallel_for, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::sort(sides_.data() + begin_[v], sides_.data() + begin_[v + 1]);
    }
  });
}

}  // namespace routebench::models
