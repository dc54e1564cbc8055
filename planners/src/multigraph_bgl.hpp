#pragma once
/// Multigraph as Boost.Graph sees it: its algorithms run on our compressed rows without a copy.
///
/// Models IncidenceGraph, VertexListGraph and EdgeListGraph of an undirected graph. Include it in
/// source files only.

#include <boost/graph/graph_traits.hpp>
#include <boost/graph/properties.hpp>
#include <boost/iterator/iterator_facade.hpp>
#include <boost/property_map/property_map.hpp>
#include <boost/range/irange.hpp>
#include <cstdint>
#include <utility>

#include "routebench/planning/euler.hpp"

namespace routebench::bgl {

/// An edge with the direction in which it is looked at; equal to itself seen from the other end.
struct EdgeSeen {
  std::uint32_t source = 0;
  std::uint32_t target = 0;
  std::uint32_t edge = 0;
  friend bool operator==(const EdgeSeen& a, const EdgeSeen& b) { return a.edge == b.edge; }
  friend bool operator!=(const EdgeSeen& a, const EdgeSeen& b) { return a.edge != b.edge; }
};

/// Goes over the arcs of one node.
class OutEdgeIterator
    : public boost::iterator_facade<OutEdgeIterator, EdgeSeen, boost::random_access_traversal_tag,
                                    EdgeSeen> {
 public:
  OutEdgeIterator() = default;
  OutEdgeIterator(std::uint32_t node, const Multigraph::Arc* arc) : node_(node), arc_(arc) {}

 private:
  friend class boost::iterator_core_access;
  [[nodiscard]] EdgeSeen dereference() const { return {node_, arc_->head, arc_->edge}; }
  [[nodiscard]] bool equal(const OutEdgeIterator& other) const { return arc_ == other.arc_; }
  void increment() { ++arc_; }
  void decrement() { --arc_; }
  void advance(std::ptrdiff_t by) { arc_ += by; }
  [[nodiscard]] std::ptrdiff_t distance_to(const OutEdgeIterator& other) const {
    return other.arc_ - arc_;
  }

  std::uint32_t node_ = 0;
  const Multigraph::Arc* arc_ = nullptr;
};

}  // namespace routebench::bgl

namespace boost {
template <>
struct graph_traits<routebench::Multigraph> {
  using vertex_descriptor = std::uint32_t;
  using edge_descriptor = routebench::bgl::EdgeSeen;
  using directed_category = undirected_tag;
  using edge_parallel_category = allow_parallel_edge_tag;
  struct traversal_category : incidence_graph_tag, vertex_list_graph_tag {};
  using vertex_iterator = integer_range<std::uint32_t>::iterator;
  using out_edge_iterator = routebench::bgl::OutEdgeIterator;
  using vertices_size_type = std::size_t;
  using edges_size_type = std::size_t;
  using degree_size_type = std::size_t;
  static constexpr vertex_descriptor null_vertex() { return ~vertex_descriptor{0}; }
};

template <>
struct property_map<routebench::Multigraph, vertex_index_t> {
  using type = typed_identity_property_map<std::uint32_t>;
  using const_type = type;
};
}  // namespace boost

// The free functions of the concepts, found by argument-dependent lookup.
namespace routebench {

using MultigraphTraits = boost::graph_traits<Multigraph>;

inline std::pair<MultigraphTraits::vertex_iterator, MultigraphTraits::vertex_iterator> vertices(
    const Multigraph& graph) {
  const auto range =
      boost::irange<std::uint32_t>(0, static_cast<std::uint32_t>(graph.node_count()));
  return {range.begin(), range.end()};
}
inline std::size_t num_vertices(const Multigraph& graph) { return graph.node_count(); }
inline std::size_t out_degree(std::uint32_t node, const Multigraph& graph) {
  return graph.degree(node);
}
inline std::pair<bgl::OutEdgeIterator, bgl::OutEdgeIterator> out_edges(std::uint32_t node,
                                                                       const Multigraph& graph) {
  const auto arcs = graph.arcs(node);
  return {{node, arcs.data()}, {node, arcs.data() + arcs.size()}};
}
inline boost::typed_identity_property_map<std::uint32_t> get(boost::vertex_index_t,
                                                             const Multigraph&) {
  return {};
}

namespace bgl {
inline std::uint32_t source(const EdgeSeen& edge, const Multigraph&) { return edge.source; }
inline std::uint32_t target(const EdgeSeen& edge, const Multigraph&) { return edge.target; }
}  // namespace bgl

}  // namespace routebench
