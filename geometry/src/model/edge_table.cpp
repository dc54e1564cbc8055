#include "model/edge_table.hpp"

#include <algorithm>
#include <utility>

namespace routebench::models {
template <typename Visit>
void EdgeTable::for_each_side_of(std::size_t triangle, Visit&& visit) const {
  const auto number = static_cast<std::uint32_t>(triangle);
  const auto& [a, b, c] = triangles_[triangle];
  visit(std::min(a, b), Side(std::max(a, b), number, a < b));
  visit(std::min(b, c), Side(std::max(b, c), number, b < c));
  visit(std::min(c, a), Side(std::max(c, a), number, c < a));
}

EdgeTable::EdgeTable(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices,
                     const ParallelFor& parallel_for)
    : triangles_(triangles) {
  const std::size_t ranges =
      std::max<std::size_t>(1, (triangles.size() + kTrianglesPerRange - 1) / kTrianglesPerRange);
  first_vertex_.resize(ranges + 1);
  parallel_for(ranges, [&](std::size_t range) {
    const auto [begin, end] = triangles_of(range);
    std::uint32_t after_last = 0;
    for (std::size_t t = begin; t < end; ++t)
      for (const std::uint32_t v : triangles[t]) after_last = std::max(after_last, v + 1);
    first_vertex_[range + 1] = after_last;
  });
  for (std::size_t range = 0; range < ranges; ++range)
    first_vertex_[range + 1] = std::max(first_vertex_[range], first_vertex_[range + 1]);
  first_vertex_.back() = static_cast<std::uint32_t>(vertices);

  std::vector<std::vector<Stray>> found(ranges);
  parallel_for(ranges, [&](std::size_t range) { found[range] = strays_from(range); });
  strays_.resize(ranges);
  for (const std::vector<Stray>& strays : found)
    for (const Stray& stray : strays) strays_[stray.range].push_back(stray);
}

std::vector<EdgeTable::Stray> EdgeTable::strays_from(std::size_t range) const {
  std::vector<Stray> strays;
  const auto keep = [&](std::uint32_t lower, Side side) {
    if (lower >= first_vertex_[range]) return;
    const auto next = std::upper_bound(first_vertex_.begin(), first_vertex_.end(), lower);
    const auto target = static_cast<std::uint32_t>(next - first_vertex_.begin() - 1);
    strays.push_back({target, lower, side});
  };
  const auto [begin, end] = triangles_of(range);
  for (std::size_t t = begin; t < end; ++t)
    if (*std::min_element(triangles_[t].begin(), triangles_[t].end()) < first_vertex_[range])
      for_each_side_of(t, keep);
  return strays;
}

EdgeTable::SortedSides EdgeTable::sorted_sides(std::size_t range) const {
  const std::uint32_t first = first_vertex_[range];
  // Counts are kept two places up, so that after filling each entry is the beginning of its own.
  SortedSides sorted{std::vector<std::uint32_t>(first_vertex_[range + 1] - first + 2, 0), {}};
  std::vector<std::uint32_t>& begin = sorted.begin;
  const auto visit_all = [&](const auto& visit) {
    const auto [from, to] = triangles_of(range);
    for (std::size_t t = from; t < to; ++t)
      for_each_side_of(t, [&](std::uint32_t lower, Side side) {
        if (lower >= first) visit(lower - first, side);
      });
    for (const Stray& stray : strays_[range]) visit(stray.lower - first, stray.side);
  };
  visit_all([&](std::uint32_t lower, Side) { ++begin[lower + 2]; });
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  sorted.sides.resize(begin.back());
  visit_all([&](std::uint32_t lower, Side side) { sorted.sides[begin[lower + 1]++] = side; });
  begin.pop_back();
  for (std::size_t v = 0; v + 1 < begin.size(); ++v)
    std::sort(sorted.sides.data() + begin[v], sorted.sides.data() + begin[v + 1]);
  return sorted;
}

}  // namespace routebench::models
