#include "model/edge_table.hpp"

#include <algorithm>
#include <utility>

namespace routebench::models {
namespace {

/// As std::sort, but for a handful, which most vertices have.
void sort_sides(std::span<EdgeTable::Side> sides) {
  constexpr std::size_t kHandful = 16;
  if (sides.size() > kHandful) return std::sort(sides.begin(), sides.end());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const EdgeTable::Side side = sides[i];
    std::size_t place = i;
    for (; place > 0 && side < sides[place - 1]; --place) sides[place] = sides[place - 1];
    sides[place] = side;
  }
}

}  // namespace

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
    std::array<std::uint32_t, 3> last{};
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t c = 0; c < 3; ++c) last[c] = std::max(last[c], triangles_[t][c]);
    first_vertex_[range + 1] = std::max({last[0], last[1], last[2]}) + 1;
  });
  for (std::size_t range = 0; range < ranges; ++range)
    first_vertex_[range + 1] = std::max(first_vertex_[range], first_vertex_[range + 1]);
  first_vertex_.back() = static_cast<std::uint32_t>(vertices);

  strays_.resize(ranges);
  parallel_for(ranges, [&](std::size_t range) { strays_[range] = strays_from(range); });
  received_.resize(ranges);
  for (const Strays& from : strays_)
    for (const Strays::Group& group : from.groups) received_[group.range].push_back(group.strays);
}

EdgeTable::Strays EdgeTable::strays_from(std::size_t range) const {
  std::vector<Stray> found;
  const std::uint32_t first = first_vertex_[range];
  const auto keep = [&](std::uint32_t lower, Side side) {
    if (lower < first) found.push_back({lower, side});
  };
  const auto [begin, end] = triangles_of(range);
  for (std::size_t t = begin; t < end; ++t) {
    const auto& [a, b, c] = triangles_[t];
    if (std::min(std::min(a, b), c) < first) for_each_side_of(t, keep);
  }
  if (found.empty()) return {};

  // A counting sort. The range of one is mostly that of the one before.
  std::vector<std::uint32_t> ranges(found.size());
  std::vector<std::size_t> place(range + 1);
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::uint32_t lower = found[i].lower;
    if (lower < first_vertex_[last] || lower >= first_vertex_[last + 1]) {
      const auto after = std::upper_bound(first_vertex_.begin(), first_vertex_.end(), lower);
      last = static_cast<std::uint32_t>(after - first_vertex_.begin() - 1);
    }
    ranges[i] = last;
    ++place[last];
  }
  Strays sorted{LargeVector<Stray>(found.size()), {}};
  std::size_t next = 0;
  for (std::size_t to = 0; to < place.size(); ++to) {
    const std::size_t count = std::exchange(place[to], next);
    if (count == 0) continue;
    sorted.groups.push_back(
        {static_cast<std::uint32_t>(to), std::span(sorted.strays).subspan(next, count)});
    next += count;
  }
  for (std::size_t i = 0; i < found.size(); ++i) sorted.strays[place[ranges[i]]++] = found[i];
  return sorted;
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
    for (const std::span<const Stray> strays : received_[range])
      for (const Stray& stray : strays) visit(stray.lower - first, stray.side);
  };
  visit_all([&](std::uint32_t lower, Side) { ++begin[lower + 2]; });
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  sorted.sides.resize(begin.back());
  visit_all([&](std::uint32_t lower, Side side) { sorted.sides[begin[lower + 1]++] = side; });
  begin.pop_back();
  for (std::size_t v = 0; v + 1 < begin.size(); ++v)
    sort_sides(std::span(sorted.sides).subspan(begin[v], begin[v + 1] - begin[v]));
  return sorted;
}

}  // namespace routebench::models
