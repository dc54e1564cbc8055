#include "overlay/edge_cells.hpp"

#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

namespace routebench::overlay {
namespace {

/// Cells as wide as 2^result: a few for each edge, as most of them hold none, but not much narrower
/// than edges are long.
std::uint32_t shift_for(double width, double height, double mean_extent, double edges) {
  constexpr double kCellsPerEdge = 1.5;
  const double count = kCellsPerEdge * edges;
  const double size = std::max(
      {std::sqrt(width * height / count), mean_extent, std::max(width, height) / count, 1.0});
  return static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(size))) - 1;
}

}  // namespace

bool is_right_of(const Edge& e, const Edge& f) {
  const auto upwards = [](const Edge& edge) {
    return edge.from.y < edge.to.y ? edge : Edge{edge.to, edge.from};
  };
  const Edge a = upwards(e), b = upwards(f);
  // The end that lies within the other's height decides; right of an upward edge is negative.
  if (a.from.y >= b.from.y) {
    if (const std::int64_t t = turn(b.from, b.to, a.from); t != 0) return t < 0;
  } else if (const std::int64_t t = turn(a.from, a.to, b.from); t != 0) {
    return t > 0;
  }
  if (a.to.y <= b.to.y) return turn(b.from, b.to, a.to) < 0;
  return turn(a.from, a.to, b.to) > 0;
}

GridPoint crossing_of(Edge e, Edge f) {
  if (e.to < e.from) std::swap(e.from, e.to);
  if (f.to < f.from) std::swap(f.from, f.to);
  if (std::tie(f.from, f.to) < std::tie(e.from, e.to)) std::swap(e, f);
  const auto a = static_cast<double>(turn(f.from, f.to, e.from));
  const auto b = static_cast<double>(turn(f.from, f.to, e.to));
  const double share = a / (a - b);
  return {e.from.x + static_cast<std::int32_t>(std::lround(share * (e.to.x - e.from.x))),
          e.from.y + static_cast<std::int32_t>(std::lround(share * (e.to.y - e.from.y)))};
}

void EdgeCells::make_cells(std::uint32_t edges, double mean_extent) {
  shift_ = shift_for(upper_.x - lower_.x, upper_.y - lower_.y, mean_extent, edges);
  columns_ = column(upper_.x) + 1;
  head_.assign(std::size_t{columns_} * (row(upper_.y) + 1), kNone);
  items_.reserve(2 * std::size_t{edges});
}

}  // namespace routebench::overlay
