#pragma once
/// Square cells over an outline, small where it runs and large elsewhere.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::eulerian {

/// A complete tree of arity 4 in one array, breadth first: what is above, below and where a cell
/// lies is arithmetic on its number. Children of a cell are its lower left, lower right, upper left
/// and upper right quarter. A cell is split where the outline touches it, down to one size.
class Quadtree {
 public:
  /// Levels below the root, at most: 2048 smallest cells in a row (921 mm of 0.45 mm
  /// lines) and 5.6 million cells of a bit each.
  static constexpr std::uint32_t kDeepest = 11;

  enum class Kind : std::uint8_t {
    kNothing,  ///< below a cell that is not split
    kFree,     ///< a leaf that the outline does not touch
    kTouched,  ///< touched: split, or a leaf of the smallest size
  };

  /// Takes   rings; the lower left corner of the root; the least side that the root must have, and
  ///         that of the smallest cells, mm > 0. The root is as large as whole levels make it.
  /// Throws  Error{kBadInput} if that takes more than kDeepest levels.
  /// Cost    cells, and the sum of the cells that each edge touches.
  Quadtree(const std::vector<Ring>& rings, Point2 corner, double side_mm, double leaf_mm);

  // Arithmetic of numbers. A cell of a level is also known by its column and row there.
  [[nodiscard]] static std::uint32_t parent(std::uint32_t cell) { return (cell - 1) / 4; }
  [[nodiscard]] static std::uint32_t first_child(std::uint32_t cell) { return 4 * cell + 1; }
  [[nodiscard]] static std::uint32_t level(std::uint32_t cell);
  /// Number of the first cell of a level, which is how many come before it.
  [[nodiscard]] static std::uint32_t first_of_level(std::uint32_t level) {
    return ((1U << 2 * level) - 1) / 3;
  }
  struct Position {
    std::uint32_t level, column, row;
    friend bool operator==(const Position&, const Position&) = default;
  };
  [[nodiscard]] static Position position(std::uint32_t cell);
  [[nodiscard]] static std::uint32_t number(const Position& position);

  [[nodiscard]] std::uint32_t levels() const noexcept { return levels_; }  ///< below the root
  [[nodiscard]] std::uint32_t size() const noexcept { return first_of_level(levels_ + 1); }
  [[nodiscard]] Kind kind(std::uint32_t cell) const;
  [[nodiscard]] bool is_leaf(std::uint32_t cell) const;
  [[nodiscard]] double side_mm(std::uint32_t level) const {
    return leaf_mm_ * static_cast<double>(1U << (levels_ - level));
  }
  [[nodiscard]] Point2 lower(std::uint32_t cell) const;
  [[nodiscard]] Point2 centre(std::uint32_t cell) const;

  /// All leaves, ascending.
  [[nodiscard]] std::vector<std::uint32_t> leaves() const;
  /// The leaf of the same size or larger that lies beside a cell; nothing if that side is split
  /// further or the root ends there. Takes   a step of one in one direction.
  [[nodiscard]] std::optional<std::uint32_t> leaf_beside(std::uint32_t cell, int step_column,
                                                         int step_row) const;
  /// Pairs of places in a list of leaves that lie side by side, each pair once. Takes   leaves(),
  /// or some of them in that order.
  [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> neighbours(
      const std::vector<std::uint32_t>& leaves) const;

 private:
  void touch(Point2 a, Point2 b);

  Point2 corner_;
  double leaf_mm_;
  std::uint32_t levels_ = 0;
  std::vector<bool> touched_;
};

/// For every leaf whether its centre lies inside the rings (odd crossings to its left). Free leaves
/// are flooded: of each pool of them one is looked at. Takes   the rings of the tree and leaves().
/// Cost   near linear in leaves and in crossings with rays, one through each row of smallest cells.
[[nodiscard]] std::vector<bool> inside(const Quadtree& tree, const std::vector<Ring>& rings,
                                       const std::vector<std::uint32_t>& leaves);

}  // namespace routebench::eulerian
