#include "routebench/planning/cell_circuits.hpp"

#include <array>
#include <cstddef>
#include <numeric>
#include <optional>

namespace routebench {
namespace {

struct Move {
  std::int64_t dx;
  std::int64_t dy;
};
/// Anticlockwise from the east; even ones along rows and columns.
constexpr std::array<Move, 8> kMoves{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
constexpr std::size_t kEast = 0, kNorth = 2;

constexpr std::size_t opposite(std::size_t move) { return (move + 4) % kMoves.size(); }

/// Circuits that grow and merge. In a circuit every cell has two links.
class Builder {
 public:
  Builder(const CellMap& map, std::vector<bool>& free, const DiagonalIsClear& clear)
      : map_(map),
        grid_(map.grid),
        free_(free),
        clear_(clear),
        links_(grid_.size(), 0),
        parent_(grid_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::vector<std::vector<std::uint32_t>> build() {
    begin_blocks(fullest_raster(), 2);
    merge();
    // Blocks that lie between those of the raster.
    begin_blocks({0, 0}, 1);
    merge();
    take_pairs();
    take_single_cells();
    merge();
    return walk();
  }

 private:
  [[nodiscard]] std::optional<std::uint32_t> neighbour(std::uint32_t cell, std::size_t move) const {
    const std::int64_t column = grid_.column(cell) + kMoves[move].dx;
    const std::int64_t row = grid_.row(cell) + kMoves[move].dy;
    if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows) return std::nullopt;
    return grid_.cell(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
  }

  /// Whether one may go from a cell to its neighbour, which there is.
  [[nodiscard]] bool open(std::uint32_t from, std::uint32_t to, std::size_t move) const {
    switch (move) {
      case kEast:
        return (map_.flags[from] & kEastLink) != 0;
      case kNorth:
        return (map_.flags[from] & kNorthLink) != 0;
      case opposite(kEast):
        return (map_.flags[to] & kEastLink) != 0;
      case opposite(kNorth):
        return (map_.flags[to] & kNorthLink) != 0;
      default:
        return clear_(from, to);
    }
  }

  [[nodiscard]] bool linked(std::uint32_t cell, std::size_t move) const {
    return (links_[cell] >> move & 1U) != 0;
  }
  /// Adds a link or takes it away.
  void toggle(std::uint32_t from, std::uint32_t to, std::size_t move) {
    links_[from] ^= static_cast<std::uint8_t>(1U << move);
    links_[to] ^= static_cast<std::uint8_t>(1U << opposite(move));
  }

  std::uint32_t circuit(std::uint32_t cell) {
    while (parent_[cell] != cell) {
      parent_[cell] = parent_[parent_[cell]];
      cell = parent_[cell];
    }
    return cell;
  }
  void unite(std::uint32_t a, std::uint32_t b) { parent_[circuit(a)] = circuit(b); }

  /// The cell beyond `move` if it is free and may be gone to.
  [[nodiscard]] std::optional<std::uint32_t> free_neighbour(std::uint32_t cell,
                                                            std::size_t move) const {
    const auto to = neighbour(cell, move);
    if (!to || !free_[*to] || !open(cell, *to, move)) return std::nullopt;
    return to;
  }

  /// Where a block of two by two cells begins.
  struct Corner {
    std::uint32_t column;
    std::uint32_t row;
  };

  /// The four cells of a block, anticlockwise, if all are free and lie open to each other.
  [[nodiscard]] std::optional<std::array<std::uint32_t, 4>> free_block(std::uint32_t column,
                                                                       std::uint32_t row) const {
    const std::uint32_t a = grid_.cell(column, row);
    if (!free_[a]) return std::nullopt;
    const auto b = free_neighbour(a, kEast);
    const auto d = free_neighbour(a, kNorth);
    if (!b || !d) return std::nullopt;
    const auto c = free_neighbour(*b, kNorth);
    if (!c || !open(*d, *c, kEast)) return std::nullopt;
    return {{a, *b, *c, *d}};
  }

  /// The corner of the raster, of the four that there are, with the most free blocks.
  [[nodiscard]] Corner fullest_raster() const {
    std::array<std::array<std::size_t, 2>, 2> blocks{};
    for (std::uint32_t row = 0; row < grid_.rows; ++row)
      for (std::uint32_t column = 0; column < grid_.columns; ++column)
        if (free_block(column, row)) ++blocks[row % 2][column % 2];
    Corner best{0, 0};
    for (const Corner corner : {Corner{1, 0}, Corner{0, 1}, Corner{1, 1}})
      if (blocks[corner.row][corner.column] > blocks[best.row][best.column]) best = corner;
    return best;
  }

  void begin_blocks(Corner raster, std::uint32_t step) {
    for (std::uint32_t row = raster.row; row < grid_.rows; row += step)
      for (std::uint32_t column = raster.column; column < grid_.columns; column += step) {
        const auto block = free_block(column, row);
        if (!block) continue;
        const auto [a, b, c, d] = *block;
        toggle(a, b, kEast);
        toggle(b, c, kNorth);
        toggle(d, c, kEast);
        toggle(a, d, kNorth);
        for (const std::uint32_t cell : *block) {
          free_[cell] = false;
          unite(cell, a);
        }
      }
  }

  /// Joins circuits that run side by side: first along rows, which makes long level stretches.
  void merge() {
    merge_across(kEast, kNorth);
    merge_across(kNorth, kEast);
  }

  /// Exchanges two links along `move`, one on either side of a step across, for two such steps.
  void merge_across(std::size_t across, std::size_t move) {
    for (std::uint32_t a = 0; a < grid_.size(); ++a) {
      if (!linked(a, move)) continue;
      const auto c = neighbour(a, across);
      if (!c || !linked(*c, move) || circuit(a) == circuit(*c)) continue;
      const std::uint32_t b = *neighbour(a, move), d = *neighbour(*c, move);
      if (!open(a, *c, across) || !open(b, d, across)) continue;
      toggle(a, b, move);
      toggle(*c, d, move);
      toggle(a, *c, across);
      toggle(b, d, across);
      unite(a, *c);
    }
  }

  /// Leads links over pairs of free cells beside them, as long as there are any.
  void take_pairs() {
    struct Link {
      std::uint32_t from;
      std::size_t move;
    };
    std::vector<Link> to_do;
    for (std::uint32_t cell = 0; cell < grid_.size(); ++cell)
      for (const std::size_t move : {kEast, kNorth})
        if (linked(cell, move)) to_do.push_back({cell, move});
    while (!to_do.empty()) {
      const auto [a, move] = to_do.back();
      to_do.pop_back();
      if (!linked(a, move)) continue;
      const std::uint32_t b = *neighbour(a, move);
      const std::size_t left = (move + 2) % kMoves.size();
      for (const std::size_t side : {left, opposite(left)}) {
        const auto p = free_neighbour(a, side);
        const auto q = free_neighbour(b, side);
        if (!p || !q || !open(*p, *q, move)) continue;
        toggle(a, b, move);
        toggle(a, *p, side);
        toggle(*p, *q, move);
        toggle(b, *q, side);
        for (const std::uint32_t cell : {*p, *q}) {
          free_[cell] = false;
          unite(cell, a);
        }
        to_do.push_back({a, side});
        to_do.push_back({b, side});
        to_do.push_back({*p, move});
        break;
      }
    }
  }

  /// Leads links over one free cell that touches both of their ends.
  void take_single_cells() {
    for (std::uint32_t cell = 0; cell < grid_.size(); ++cell)
      if (free_[cell] && take(cell)) free_[cell] = false;
  }

  bool take(std::uint32_t x) {
    for (std::size_t to_u = 0; to_u < kMoves.size(); to_u += 2) {
      const auto u = neighbour(x, to_u);
      if (!u || links_[*u] == 0 || !open(x, *u, to_u)) continue;
      for (std::size_t turn : {1U, 7U, 2U, 6U}) {
        const std::size_t to_v = (to_u + turn) % kMoves.size();
        const auto v = neighbour(x, to_v);
        if (!v || links_[*v] == 0) continue;
        const std::size_t from_u = move_between(*u, *v);
        if (!linked(*u, from_u) || !open(x, *v, to_v)) continue;
        toggle(*u, *v, from_u);
        toggle(x, *u, to_u);
        toggle(x, *v, to_v);
        unite(x, *u);
        return true;
      }
    }
    return false;
  }

  /// The move between two cells that touch.
  [[nodiscard]] std::size_t move_between(std::uint32_t from, std::uint32_t to) const {
    std::size_t move = 0;
    while (neighbour(from, move) != to) ++move;
    return move;
  }

  std::vector<std::vector<std::uint32_t>> walk() {
    std::vector<std::vector<std::uint32_t>> circuits;
    for (std::uint32_t first = 0; first < grid_.size(); ++first) {
      if (links_[first] == 0) continue;
      std::vector<std::uint32_t>& cells = circuits.emplace_back();
      // Links are taken away behind the walk; the last one leads back to the first cell.
      for (std::uint32_t cell = first; links_[cell] != 0;) {
        cells.push_back(cell);
        std::size_t move = 0;
        while (!linked(cell, move)) ++move;
        const std::uint32_t next = *neighbour(cell, move);
        toggle(cell, next, move);
        cell = next;
      }
    }
    return circuits;
  }

  const CellMap& map_;
  const CellGrid& grid_;
  std::vector<bool>& free_;
  const DiagonalIsClear& clear_;
  std::vector<std::uint8_t> links_;    // bits of kMoves
  std::vector<std::uint32_t> parent_;  // of a cell towards the one that names its circuit
};

}  // namespace

std::vector<std::vector<std::uint32_t>> cell_circuits(const CellMap& map, std::vector<bool>& free,
                                                      const DiagonalIsClear& clear) {
  return Builder(map, free, clear).build();
}

}  // namespace routebench
