#include "routebench/planning/cell_circuits.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

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
        columns_(map.grid.columns),
        free_(free),
        clear_(clear),
        links_(grid_.size(), 0),
        parent_(grid_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
    for (std::uint32_t cell = 0; cell < grid_.size(); ++cell)
      if (free_[cell]) cells_.push_back(cell);
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
  /// The cell beyond a move that does not leave the grid.
  [[nodiscard]] std::uint32_t beyond(std::uint32_t cell, std::size_t move) const {
    return static_cast<std::uint32_t>(cell + kMoves[move].dx + kMoves[move].dy * columns_);
  }

  /// Whether one may go along a row or column. Never from the grid: its last cells have no link.
  [[nodiscard]] bool open(std::uint32_t cell, std::size_t move) const {
    switch (move) {
      case kEast:
        return (map_.flags[cell] & kEastLink) != 0;
      case kNorth:
        return (map_.flags[cell] & kNorthLink) != 0;
      case opposite(kEast):
        return cell > 0 && (map_.flags[cell - 1] & kEastLink) != 0;
      default:
        return cell >= grid_.columns && (map_.flags[cell - grid_.columns] & kNorthLink) != 0;
    }
  }

  [[nodiscard]] bool linked(std::uint32_t cell, std::size_t move) const {
    return (std::uint32_t{links_[cell]} >> move & 1U) != 0;
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

  [[nodiscard]] bool may_take(std::uint32_t cell, std::size_t move) const {
    return open(cell, move) && free_[beyond(cell, move)];
  }

  /// Where a block of two by two cells begins.
  struct Corner {
    std::uint32_t column;
    std::uint32_t row;
  };

  /// Whether a block of four free cells that lie open to each other begins in a cell.
  [[nodiscard]] bool is_free_block(std::uint32_t cell) const {
    return free_[cell] && may_take(cell, kEast) && may_take(cell, kNorth) &&
           may_take(beyond(cell, kEast), kNorth) && open(beyond(cell, kNorth), kEast);
  }

  /// The corner of the raster, of the four that there are, with the most free blocks.
  [[nodiscard]] Corner fullest_raster() const {
    std::array<std::array<std::size_t, 2>, 2> blocks{};
    for (const std::uint32_t cell : cells_)
      if (is_free_block(cell)) ++blocks[grid_.row(cell) % 2][grid_.column(cell) % 2];
    Corner best{0, 0};
    for (const Corner corner : {Corner{1, 0}, Corner{0, 1}, Corner{1, 1}})
      if (blocks[corner.row][corner.column] > blocks[best.row][best.column]) best = corner;
    return best;
  }

  void begin_blocks(Corner raster, std::uint32_t step) {
    for (const std::uint32_t a : cells_) {
      if (grid_.column(a) % step != raster.column || grid_.row(a) % step != raster.row ||
          !is_free_block(a))
        continue;
      const std::uint32_t b = beyond(a, kEast), c = beyond(b, kNorth), d = beyond(a, kNorth);
      toggle(a, b, kEast);
      toggle(b, c, kNorth);
      toggle(d, c, kEast);
      toggle(a, d, kNorth);
      for (const std::uint32_t cell : {a, b, c, d}) {
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
    for (const std::uint32_t a : cells_) {
      if (!linked(a, move) || !open(a, across)) continue;
      const std::uint32_t b = beyond(a, move), c = beyond(a, across);
      if (!linked(c, move) || !open(b, across) || circuit(a) == circuit(c)) continue;
      const std::uint32_t d = beyond(c, move);
      toggle(a, b, move);
      toggle(c, d, move);
      toggle(a, c, across);
      toggle(b, d, across);
      unite(a, c);
    }
  }

  /// Leads links over pairs of free cells beside them, as long as there are any.
  void take_pairs() {
    struct Link {
      std::uint32_t from;
      std::size_t move;
    };
    std::vector<Link> to_do;
    for (const std::uint32_t cell : cells_)
      for (const std::size_t move : {kEast, kNorth})
        if (linked(cell, move)) to_do.push_back({cell, move});
    while (!to_do.empty()) {
      const auto [a, move] = to_do.back();
      to_do.pop_back();
      if (!linked(a, move)) continue;
      const std::uint32_t b = beyond(a, move);
      const std::size_t left = (move + 2) % kMoves.size();
      for (const std::size_t side : {left, opposite(left)}) {
        if (!may_take(a, side) || !may_take(b, side)) continue;
        const std::uint32_t p = beyond(a, side), q = beyond(b, side);
        if (!open(p, move)) continue;
        toggle(a, b, move);
        toggle(a, p, side);
        toggle(p, q, move);
        toggle(b, q, side);
        for (const std::uint32_t cell : {p, q}) {
          free_[cell] = false;
          unite(cell, a);
        }
        to_do.push_back({a, side});
        to_do.push_back({b, side});
        to_do.push_back({p, move});
        break;
      }
    }
  }

  /// Leads links over one free cell that touches both of their ends.
  void take_single_cells() {
    for (const std::uint32_t cell : cells_)
      if (free_[cell] && take(cell)) free_[cell] = false;
  }

  bool take(std::uint32_t x) {
    for (std::size_t to_u = 0; to_u < kMoves.size(); to_u += 2) {
      if (!open(x, to_u)) continue;
      const std::uint32_t u = beyond(x, to_u);
      for (std::size_t from_u = 0; from_u < kMoves.size(); ++from_u) {
        if (!linked(u, from_u)) continue;
        const Move way{kMoves[to_u].dx + kMoves[from_u].dx, kMoves[to_u].dy + kMoves[from_u].dy};
        const auto to_v = std::find_if(kMoves.begin(), kMoves.end(), [&](Move move) {
          return move.dx == way.dx && move.dy == way.dy;
        });
        if (to_v == kMoves.end()) continue;
        const auto move = static_cast<std::size_t>(to_v - kMoves.begin());
        const std::uint32_t v = beyond(x, move);
        if (move % 2 == 0 ? !open(x, move) : !clear_(x, v)) continue;
        toggle(u, v, from_u);
        toggle(x, u, to_u);
        toggle(x, v, move);
        unite(x, u);
        return true;
      }
    }
    return false;
  }

  std::vector<std::vector<std::uint32_t>> walk() {
    std::vector<std::vector<std::uint32_t>> circuits;
    for (const std::uint32_t first : cells_) {
      if (links_[first] == 0) continue;
      std::vector<std::uint32_t>& cells = circuits.emplace_back();
      // Links are taken away behind the walk; the last one leads back to the first cell.
      for (std::uint32_t cell = first; links_[cell] != 0;) {
        cells.push_back(cell);
        std::size_t move = 0;
        while (!linked(cell, move)) ++move;
        const std::uint32_t next = beyond(cell, move);
        toggle(cell, next, move);
        cell = next;
      }
    }
    return circuits;
  }

  const CellMap& map_;
  const CellGrid& grid_;
  std::int64_t columns_;
  std::vector<bool>& free_;
  const DiagonalIsClear& clear_;
  std::vector<std::uint32_t> cells_;   // that were free at first
  std::vector<std::uint8_t> links_;    // bits of kMoves
  std::vector<std::uint32_t> parent_;  // of a cell towards the one that names its circuit
};

}  // namespace

std::vector<std::vector<std::uint32_t>> cell_circuits(const CellMap& map, std::vector<bool>& free,
                                                      const DiagonalIsClear& clear) {
  return Builder(map, free, clear).build();
}

}  // namespace routebench
