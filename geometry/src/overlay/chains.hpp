#pragma once
/// Planar edges taken together: paths between the points where rings meet.

#include <cstdint>
#include <span>
#include <vector>

#include "overlay/planar_edges.hpp"

namespace routebench::overlay {

/// Edges of a ring from one meeting point to the next, or a whole ring that meets nothing.
struct Chain {
  std::uint32_t ring = 0;
  std::uint32_t first = 0;     ///< edge
  std::uint32_t last = 0;      ///< edge
  std::uint32_t from = kNone;  ///< node; kNone: a closed ring
  std::uint32_t to = kNone;
  Winding step;          ///< what the left side has more than the right side
  Winding right;         ///< once windings are found
  bool is_copy = false;  ///< lies on another chain, which has its step too

  [[nodiscard]] bool is_closed() const { return from == kNone; }
  [[nodiscard]] Winding left() const { return right + step; }
};

/// An end of a chain at a node.
struct ChainEnd {
  std::uint32_t chain = 0;
  bool starts = false;  ///< the chain begins here
};

/// The chains of planar edges with the winding numbers on both of their sides.
class ChainGraph {
 public:
  explicit ChainGraph(const PlanarEdges& planar);

  [[nodiscard]] const std::pmr::vector<Chain>& chains() const { return chains_; }
  [[nodiscard]] std::uint32_t nodes() const {
    return static_cast<std::uint32_t>(end_begin_.empty() ? 0 : end_begin_.size() - 1);
  }
  /// The chains' ends at a node, counter-clockwise.
  [[nodiscard]] std::span<const ChainEnd> ends(std::uint32_t node) const {
    return {ends_.data() + end_begin_[node], ends_.data() + end_begin_[node + 1]};
  }
  /// Place of a chain's end among those of its node.
  [[nodiscard]] std::uint32_t place(ChainEnd end) const {
    return end.starts ? start_place_[end.chain] : stop_place_[end.chain];
  }
  [[nodiscard]] std::uint32_t chain_of(std::uint32_t edge) const { return chain_of_[edge]; }

  /// The leftmost point of a chain, of several the lowest.
  [[nodiscard]] std::uint32_t leftmost(const Chain& chain) const;

 private:
  void make_nodes();
  void make_chains();
  void merge_copies();
  void sort_ends();
  void find_windings();
  [[nodiscard]] Winding winding_left_of(std::uint32_t point) const;
  void spread(std::uint32_t node, std::uint32_t place, Winding before,
              std::pmr::vector<std::uint8_t>& known);
  [[nodiscard]] GridPoint heading(ChainEnd end) const;

  const PlanarEdges& planar_;
  std::pmr::memory_resource* memory_;
  std::pmr::vector<std::uint32_t> node_of_{memory_};  // points
  std::uint32_t node_count_ = 0;
  std::pmr::vector<Chain> chains_{memory_};
  std::pmr::vector<std::uint32_t> chain_of_{memory_};  // edges; a copy's are its original's
  std::pmr::vector<std::uint8_t> runs_back_{memory_};  // edges of copies: against the original
  std::pmr::vector<std::uint32_t> end_begin_{memory_};
  std::pmr::vector<ChainEnd> ends_{memory_};
  std::pmr::vector<std::uint32_t> start_place_{memory_}, stop_place_{memory_};  // of chains
};

}  // namespace routebench::overlay
