#pragma once
/// Which island is nearest, and which one a place belongs to.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// A balanced tree over the edges of a layer's polygons (its islands), from which islands are taken
/// one by one.
/// Cost  construction O(E + I log I) for E edges of I islands; taking all islands O(E log E) in
/// all;
///       a query O(log E) where edges lie apart.
class IslandTree {
 public:
  explicit IslandTree(const Polygons& islands);

  /// The island whose boundary is nearest to p among those not taken yet, the lowest such index if
  /// several are equally near. Nothing if all are taken.
  [[nodiscard]] std::optional<std::size_t> nearest(Point2 p) const;

  /// Takes an island out of the reach of nearest().
  void take(std::size_t island);

  /// The island that a region lies in, taken or not.
  /// Takes a polygon with some area inside one of the islands.
  [[nodiscard]] std::size_t island_of(const Polygon& region) const;

 private:
  struct Edge {
    Point2 a;
    Point2 b;
    std::uint32_t island = 0;
  };
  /// Edges [begin, end); children of node n are 2n + 1 and 2n + 2.
  struct Node {
    Point2 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Point2 upper{-std::numeric_limits<double>::infinity(),
                 -std::numeric_limits<double>::infinity()};
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t waiting = 0;  ///< edges of islands that have not been taken
  };
  struct Nearest {
    double squared_mm2;
    std::uint32_t island;
  };
  struct Hit {
    double x;
    std::uint32_t island;
  };

  void build(std::size_t node, std::uint32_t begin, std::uint32_t end);
  [[nodiscard]] bool is_leaf(std::size_t node) const;
  void search_nearest(std::size_t node, Point2 p, std::optional<Nearest>& best) const;
  void search_left(std::size_t node, Point2 p, std::optional<Hit>& best) const;

  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
  std::vector<bool> taken_;                            ///< by island
  std::vector<std::vector<std::uint32_t>> leaves_of_;  ///< by island: the leaf of each of its edges
};

}  // namespace routebench
