#pragma once
/// Undirected graphs, and walks that use every edge of one exactly once.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Undirected graph in compressed rows; parallel edges and loops are allowed. Immutable.
class Multigraph {
 public:
  using Ends = std::array<std::uint32_t, 2>;

  /// An edge as one of its nodes sees it.
  struct Arc {
    std::uint32_t head;  ///< where it leads
    std::uint32_t edge;
  };

  /// Throws Error{kBadUsage} if an edge names a node that there is not. Cost   linear.
  Multigraph(std::size_t node_count, std::vector<Ends> edges);

  [[nodiscard]] std::size_t node_count() const noexcept { return first_arc_.size() - 1; }
  [[nodiscard]] std::span<const Ends> edges() const noexcept { return edges_; }

  /// Arcs of a node, by ascending edge; a loop stands there twice.
  [[nodiscard]] std::span<const Arc> arcs(std::size_t node) const noexcept {
    return {arcs_.data() + first_arc_[node], arcs_.data() + first_arc_[node + 1]};
  }
  /// Number of arcs of a node.
  [[nodiscard]] std::size_t degree(std::size_t node) const noexcept {
    return first_arc_[node + 1] - first_arc_[node];
  }

 private:
  std::vector<Ends> edges_;
  std::vector<std::uint32_t> first_arc_;
  std::vector<Arc> arcs_;
};

/// For every node the number of its connected component; components are numbered by their lowest
/// node. Cost   linear.
[[nodiscard]] std::vector<std::uint32_t> connected_components(const Multigraph& graph);

/// Nodes of odd degree, ascending. In every component their number is even.
[[nodiscard]] std::vector<std::uint32_t> odd_nodes(const Multigraph& graph);

/// Edges between two odd nodes that can all be removed together: what was connected stays
/// connected, each odd node loses at most one, and what is left has no more edge that could still
/// go.
///
/// Returns ascending edges.
/// Cost    linear in nodes and edges for each of a few passes.
/// Source  S. Lei, 2015, first step of making a graph Eulerian; that it never cuts the graph is our
///         correction.
[[nodiscard]] std::vector<std::uint32_t> removable_odd_edges(const Multigraph& graph);

/// A closed walk: edges[i] joins nodes[i] and nodes[i + 1]; the last node is the first one again.
struct Circuit {
  std::vector<std::uint32_t> nodes;
  std::vector<std::uint32_t> edges;
};

/// Walks through every edge exactly once, one circuit for each component that has edges.
///
/// Takes   a graph without odd nodes; where its nodes lie, if the walk shall rather run straight on
///         than turn (one place a node), or nothing: then the first free edge is taken.
/// Returns circuits by ascending first node, the lowest of their component.
/// Throws  Error{kBadUsage} if a node is odd or the number of places is not that of the nodes.
/// Cost    linear in edges; with places, O(d log d) more for a node of degree d.
/// Source  C. Hierholzer, 1873, as an iteration over flat arrays.
[[nodiscard]] std::vector<Circuit> euler_circuits(const Multigraph& graph,
                                                  std::span<const Point2> places = {});

}  // namespace routebench
