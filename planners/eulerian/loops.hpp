#pragma once
/// Disjoint closed walks over the nodes of a lattice, which grow and join.

#include <array>
#include <boost/pending/disjoint_sets.hpp>
#include <cstdint>
#include <vector>

#include "eulerian/lattice.hpp"

namespace routebench::eulerian {

/// Every node lies in at most one loop and is linked to the two nodes beside it there.
class Loops {
 public:
  explicit Loops(const Lattice& lattice);

  /// True if the node lies in a loop.
  [[nodiscard]] bool holds(std::uint32_t node) const { return links_[node][0] != kNone; }
  [[nodiscard]] const std::array<std::uint32_t, 2>& links(std::uint32_t node) const {
    return links_[node];
  }
  [[nodiscard]] bool linked(std::uint32_t a, std::uint32_t b) const {
    return links_[a][0] == b || links_[a][1] == b;
  }

  /// Makes a loop of the four nodes of the square whose lower left one is `node`, if it has four
  /// that are joined all round and lie in no loop.
  bool add_square(std::uint32_t node);

  /// Joins two loops that run along opposite sides of the square, so that they run across it. With
  /// `level` the sides are upright and the new links level.
  bool join_across(std::uint32_t node, bool level);

  /// True if two nodes that lie in loops lie in the same one.
  [[nodiscard]] bool same_loop(std::uint32_t a, std::uint32_t b) {
    return sets_.find_set(a) == sets_.find_set(b);
  }
  /// Joins two loops: instead of a and b, and of c and d, a and c are linked, and b and d.
  void join(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

  /// Takes two nodes c and d that lie in no loop in between a and b, which are linked.
  void insert(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  /// Takes one node.
  void insert(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  /// All loops, by their lowest nodes; none repeats its first node.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> walks() const;

 private:
  void replace(std::uint32_t at, std::uint32_t old_link, std::uint32_t new_link);

  const Lattice& lattice_;
  std::vector<std::array<std::uint32_t, 2>> links_;
  boost::disjoint_sets_with_storage<> sets_;
};

}  // namespace routebench::eulerian
