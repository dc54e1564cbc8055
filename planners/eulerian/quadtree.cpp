#include "eulerian/quadtree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "eulerian/lattice.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/euler.hpp"
#include "routebench/planning/line_crossings.hpp"

namespace routebench::eulerian {
namespace {

/// Every second bit of a number, moved together.
std::uint32_t even_bits(std::uint32_t code) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < 16; ++i) bits |= code >> i & 1U << i;
  return bits;
}

/// The other way: bits with a zero before each.
std::uint32_t spread_bits(std::uint32_t bits) {
  std::uint32_t code = 0;
  for (std::uint32_t i = 0; i < 16; ++i) code |= (bits & 1U << i) << i;
  return code;
}

/// True if segment ab meets the closed square: no axis and no side of the segment parts them.
bool meets(Point2 a, Point2 b, Point2 lower, double side_mm) {
  const Point2 upper = lower + Point2{side_mm, side_mm};
  if (std::max(a.x, b.x) < lower.x || std::min(a.x, b.x) > upper.x) return false;
  if (std::max(a.y, b.y) < lower.y || std::min(a.y, b.y) > upper.y) return false;
  const Point2 along = b - a;
  const std::array<double, 4> sides{
      cross(along, lower - a), cross(along, Point2{upper.x, lower.y} - a),
      cross(along, Point2{lower.x, upper.y} - a), cross(along, upper - a)};
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  return *least <= 0 && *most >= 0;
}

}  // namespace

Quadtree::Quadtree(const std::vector<Ring>& rings, Point2 corner, double side_mm, double leaf_mm)
    : corner_(corner), leaf_mm_(leaf_mm) {
  const double levels = std::max(0.0, std::ceil(std::log2(side_mm / leaf_mm)));
  if (!(levels <= kDeepest))
    throw Error(ErrorKind::kBadInput, "eulerian: a region of " + std::to_string(side_mm) +
                                          " mm takes more than " + std::to_string(1U << kDeepest) +
                                          " cells of " + std::to_string(leaf_mm) + " mm in a row");
  levels_ = static_cast<std::uint32_t>(levels);
  touched_.resize(size());
  for (const Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      touch(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
}

void Quadtree::touch(Point2 a, Point2 b) {
  std::vector<Position> open{{0, 0, 0}};
  while (!open.empty()) {
    const Position at = open.back();
    open.pop_back();
    const double side = side_mm(at.level);
    const Point2 lower =
        corner_ + side * Point2{static_cast<double>(at.column), static_cast<double>(at.row)};
    if (!meets(a, b, lower, side)) continue;
    touched_[number(at)] = true;
    if (at.level == levels_) continue;
    for (std::uint32_t k = 0; k < 4; ++k)
      open.push_back({at.level + 1, 2 * at.column + k % 2, 2 * at.row + k / 2});
  }
}

std::uint32_t Quadtree::level(std::uint32_t cell) {
  // 3 cell + 1 lies between 4^level and 4^(level + 1).
  return (static_cast<std::uint32_t>(std::bit_width(3 * cell + 1)) - 1) / 2;
}

Quadtree::Position Quadtree::position(std::uint32_t cell) {
  const std::uint32_t at = level(cell), code = cell - first_of_level(at);
  return {at, even_bits(code), even_bits(code >> 1U)};
}

std::uint32_t Quadtree::number(const Position& position) {
  return first_of_level(position.level) +
         (spread_bits(position.column) | spread_bits(position.row) << 1U);
}

Quadtree::Kind Quadtree::kind(std::uint32_t cell) const {
  if (touched_[cell]) return Kind::kTouched;
  return cell == 0 || touched_[parent(cell)] ? Kind::kFree : Kind::kNothing;
}

bool Quadtree::is_leaf(std::uint32_t cell) const {
  const Kind k = kind(cell);
  return k == Kind::kFree || (k == Kind::kTouched && cell >= first_of_level(levels_));
}

Point2 Quadtree::lower(std::uint32_t cell) const {
  const Position at = position(cell);
  return corner_ +
         side_mm(at.level) * Point2{static_cast<double>(at.column), static_cast<double>(at.row)};
}

Point2 Quadtree::centre(std::uint32_t cell) const {
  const double half = side_mm(level(cell)) / 2;
  return lower(cell) + Point2{half, half};
}

std::vector<std::uint32_t> Quadtree::leaves() const {
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t cell = 0; cell < size(); ++cell)
    if (is_leaf(cell)) leaves.push_back(cell);
  return leaves;
}

std::optional<std::uint32_t> Quadtree::leaf_beside(std::uint32_t cell, int step_column,
                                                   int step_row) const {
  Position at = position(cell);
  // Below 0 it wraps round to what is beyond the last, too.
  at.column += static_cast<std::uint32_t>(step_column);
  at.row += static_cast<std::uint32_t>(step_row);
  if (at.column >= 1U << at.level || at.row >= 1U << at.level) return std::nullopt;
  std::uint32_t beside = number(at);
  while (kind(beside) == Kind::kNothing) beside = parent(beside);
  return is_leaf(beside) ? std::optional(beside) : std::nullopt;
}

std::vector<std::array<std::uint32_t, 2>> Quadtree::neighbours(
    const std::vector<std::uint32_t>& leaves) const {
  std::vector<std::uint32_t> place(size(), kNone);
  for (std::uint32_t i = 0; i < leaves.size(); ++i) place[leaves[i]] = i;
  std::vector<std::array<std::uint32_t, 2>> pairs;
  constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (std::uint32_t i = 0; i < leaves.size(); ++i)
    for (const auto& [step_column, step_row] : kSteps) {
      const auto beside = leaf_beside(leaves[i], step_column, step_row);
      if (!beside || place[*beside] == kNone) continue;
      // The smaller one finds the larger; of equals the left or lower one finds the other.
      if (level(*beside) == level(leaves[i]) && step_column + step_row < 0) continue;
      pairs.push_back({i, place[*beside]});
    }
  return pairs;
}

std::vector<bool> inside(const Quadtree& tree, const std::vector<Ring>& rings,
                         const std::vector<std::uint32_t>& leaves) {
  const double leaf_mm = tree.side_mm(tree.levels());
  const Point2 corner = tree.lower(0);
  const EvenLines rays{corner.y + leaf_mm / 2, leaf_mm, 1U << tree.levels()};
  const std::vector<Crossing> crossings = cross_lines(rings, rays, CrossingSearch::kBucket);
  const auto lies_inside = [&](std::uint32_t cell) {
    // The ray through the lowest row of the cell: all of a free cell lies on one side.
    const Quadtree::Position at = Quadtree::position(cell);
    const Crossing wanted{tree.centre(cell).x, at.row << (tree.levels() - at.level), 0, 0};
    const auto before = [](const Crossing& a, const Crossing& b) {
      return a.line != b.line ? a.line < b.line : a.x < b.x;
    };
    const auto found = std::lower_bound(crossings.begin(), crossings.end(), wanted, before);
    // Every ray has an even number of crossings, so those of rays before do not matter.
    return (found - crossings.begin()) % 2 == 1;
  };

  const auto is_free = [&](std::uint32_t i) {
    return tree.kind(leaves[i]) == Quadtree::Kind::kFree;
  };
  std::vector<Multigraph::Ends> passages;
  for (const auto& pair : tree.neighbours(leaves))
    if (is_free(pair[0]) && is_free(pair[1])) passages.push_back(pair);
  const Multigraph graph(leaves.size(), std::move(passages));
  const std::vector<std::uint32_t> pool_of = connected_components(graph);
  constexpr std::uint8_t kUnknown = 2;
  std::vector<std::uint8_t> pools(leaves.size(), kUnknown);
  std::vector<bool> inside(leaves.size());
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    std::uint8_t& pool = pools[pool_of[i]];
    if (pool == kUnknown) pool = lies_inside(leaves[i]) ? 1 : 0;
    inside[i] = pool == 1;
  }
  return inside;
}

}  // namespace routebench::eulerian
