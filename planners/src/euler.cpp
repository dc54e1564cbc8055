#include "routebench/planning/euler.hpp"

#include <algorithm>
#include <boost/graph/connected_components.hpp>
#include <boost/pending/disjoint_sets.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "multigraph_bgl.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Takes away odd edges pass by pass; see removable_odd_edges.
class OddEdgeRemover {
 public:
  explicit OddEdgeRemover(const Multigraph& graph)
      : graph_(graph), odd_(graph.node_count()), removed_(graph.edges().size()) {
    for (const std::uint32_t node : odd_nodes(graph)) odd_[node] = true;
  }

  std::vector<std::uint32_t> remove() {
    while (remove_outside_of(spanning_forest()) > 0) continue;
    std::vector<std::uint32_t> edges;
    for (std::uint32_t e = 0; e < removed_.size(); ++e)
      if (removed_[e]) edges.push_back(e);
    return edges;
  }

 private:
  [[nodiscard]] bool is_candidate(std::uint32_t edge) const {
    const auto [a, b] = graph_.edges()[edge];
    return !removed_[edge] && a != b && odd_[a] && odd_[b];
  }

  /// A forest that keeps every component together and has as few candidates as can be: whatever is
  /// removed outside of it, nothing is cut apart.
  [[nodiscard]] std::vector<bool> spanning_forest() const {
    std::vector<bool> in_forest(removed_.size());
    boost::disjoint_sets_with_storage<> sets(graph_.node_count());
    for (const bool candidates : {false, true}) {
      for (std::uint32_t e = 0; e < removed_.size(); ++e) {
        if (removed_[e] || is_candidate(e) != candidates) continue;
        const auto [a, b] = graph_.edges()[e];
        const std::size_t root_a = sets.find_set(a), root_b = sets.find_set(b);
        if (root_a == root_b) continue;
        sets.link(root_a, root_b);
        in_forest[e] = true;
      }
    }
    return in_forest;
  }

  /// Removes candidates that are not in the forest until none is left; returns how many. Ends of a
  /// chain of odd nodes go first: beginning inside would leave more of them over.
  std::size_t remove_outside_of(const std::vector<bool>& forest) {
    const auto for_each_choice = [&](std::uint32_t node, auto&& visit) {
      for (const Multigraph::Arc arc : graph_.arcs(node))
        if (is_candidate(arc.edge) && !forest[arc.edge]) visit(arc);
    };
    std::vector<std::uint32_t> choices(odd_.size());
    std::vector<std::uint32_t> ends;  // nodes that had a single choice when they were put here
    for (std::uint32_t node = 0; node < odd_.size(); ++node)
      for_each_choice(node, [&](Multigraph::Arc) { ++choices[node]; });
    for (auto node = static_cast<std::uint32_t>(odd_.size()); node-- > 0;)
      if (choices[node] == 1) ends.push_back(node);

    std::size_t count = 0;
    const auto remove_at = [&](std::uint32_t node) {
      std::uint32_t partner = kNone, edge = kNone;
      for_each_choice(node, [&](Multigraph::Arc arc) {
        if (edge == kNone) std::tie(partner, edge) = std::pair(arc.head, arc.edge);
      });
      for (const std::uint32_t gone : {node, partner})
        for_each_choice(gone, [&](Multigraph::Arc arc) {
          if (--choices[arc.head] == 1) ends.push_back(arc.head);
        });
      odd_[node] = odd_[partner] = false;
      removed_[edge] = true;
      ++count;
    };
    const auto remove_at_ends = [&] {
      while (!ends.empty()) {
        const std::uint32_t node = ends.back();
        ends.pop_back();
        if (odd_[node] && choices[node] > 0) remove_at(node);
      }
    };
    remove_at_ends();
    for (std::uint32_t node = 0; node < odd_.size(); ++node) {
      if (!odd_[node] || choices[node] == 0) continue;
      remove_at(node);
      remove_at_ends();
    }
    return count;
  }

  const Multigraph& graph_;
  std::vector<bool> odd_;
  std::vector<bool> removed_;
};

/// For every arc of a graph the arc of the same node that lies most nearly opposite to it.
class Opposites {
 public:
  Opposites(const Multigraph& graph, std::span<const Point2> places) {
    for (std::size_t node = 0; node < graph.node_count(); ++node) {
      first_.push_back(opposite_.size());
      const auto arcs = graph.arcs(node);
      angles_.clear();
      for (std::uint32_t i = 0; i < arcs.size(); ++i) {
        const Point2 away = places[arcs[i].head] - places[node];
        angles_.emplace_back(std::atan2(away.y, away.x), i);
      }
      std::sort(angles_.begin(), angles_.end());
      opposite_.resize(opposite_.size() + arcs.size());
      for (const auto& [angle, i] : angles_) opposite_[first_.back() + i] = nearest_to(angle);
    }
  }

  /// Place among the node's arcs.
  [[nodiscard]] std::uint32_t of(std::size_t node, std::uint32_t arc) const {
    return opposite_[first_[node] + arc];
  }

 private:
  using AngleOfArc = std::pair<double, std::uint32_t>;

  /// The arc whose direction is nearest to the one against `angle`.
  [[nodiscard]] std::uint32_t nearest_to(double angle) const {
    const double wanted = angle > 0 ? angle - std::numbers::pi : angle + std::numbers::pi;
    const auto turn = [&](const AngleOfArc& arc) {
      const double difference = std::abs(arc.first - wanted);
      return std::min(difference, 2 * std::numbers::pi - difference);
    };
    const auto after = std::lower_bound(angles_.begin(), angles_.end(), AngleOfArc{wanted, 0});
    const AngleOfArc& above = after == angles_.end() ? angles_.front() : *after;
    const AngleOfArc& below = after == angles_.begin() ? angles_.back() : *(after - 1);
    return turn(above) <= turn(below) ? above.second : below.second;
  }

  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> opposite_;
  std::vector<AngleOfArc> angles_;  // of the node at hand
};

/// One walk over a graph; see euler_circuits.
class Walker {
 public:
  Walker(const Multigraph& graph, std::span<const Point2> places)
      : graph_(graph), next_(graph.node_count()), used_(graph.edges().size()) {
    if (!places.empty()) opposites_.emplace_back(graph, places);
  }

  /// Whether an edge at the node is not yet used.
  [[nodiscard]] bool has_free_arc(std::uint32_t node) {
    return choose({node, kNone, kNone}) != kNone;
  }

  /// The circuit of the component of `start`.
  Circuit walk_from(std::uint32_t start) {
    Circuit circuit;
    stack_.assign(1, {start, kNone, kNone});
    while (!stack_.empty()) {
      const Step here = stack_.back();
      const std::uint32_t choice = choose(here);
      if (choice != kNone) {
        const Multigraph::Arc arc = graph_.arcs(here.node)[choice];
        used_[arc.edge] = true;
        stack_.push_back({arc.head, arc.edge, opposites_.empty() ? kNone : place_at(arc)});
      } else {
        circuit.nodes.push_back(here.node);
        if (here.edge != kNone) circuit.edges.push_back(here.edge);
        stack_.pop_back();
      }
    }
    std::reverse(circuit.nodes.begin(), circuit.nodes.end());
    std::reverse(circuit.edges.begin(), circuit.edges.end());
    return circuit;
  }

 private:
  struct Step {
    std::uint32_t node;
    std::uint32_t edge;     // by which it was reached
    std::uint32_t came_by;  // that edge's place among the arcs of the node
  };

  /// Place of the arc's edge among the arcs of its head.
  [[nodiscard]] std::uint32_t place_at(Multigraph::Arc arc) const {
    const auto arcs = graph_.arcs(arc.head);
    const auto by_edge = [](Multigraph::Arc a, std::uint32_t edge) { return a.edge < edge; };
    return static_cast<std::uint32_t>(
        std::lower_bound(arcs.begin(), arcs.end(), arc.edge, by_edge) - arcs.begin());
  }

  /// A free arc of the node, the one straight on if that is free; kNone if none is.
  std::uint32_t choose(const Step& here) {
    const auto arcs = graph_.arcs(here.node);
    if (here.came_by != kNone) {
      const std::uint32_t ahead = opposites_.front().of(here.node, here.came_by);
      if (!used_[arcs[ahead].edge]) return ahead;
    }
    std::uint32_t& next = next_[here.node];
    while (next < arcs.size() && used_[arcs[next].edge]) ++next;
    return next < arcs.size() ? next : kNone;
  }

  const Multigraph& graph_;
  std::vector<Opposites> opposites_;  // none or one
  std::vector<std::uint32_t> next_;   // of each node: no arc before this one is free
  std::vector<bool> used_;
  std::vector<Step> stack_;
};

}  // namespace

Multigraph::Multigraph(std::size_t node_count, std::vector<Ends> edges)
    : edges_(std::move(edges)), first_arc_(node_count + 1), arcs_(2 * edges_.size()) {
  for (const Ends& ends : edges_) {
    for (const std::uint32_t node : ends) {
      if (node >= node_count) {
        throw Error(ErrorKind::kBadUsage, "a graph of " + std::to_string(node_count) +
                                              " nodes got an edge at node " + std::to_string(node));
      }
      ++first_arc_[node + 1];
    }
  }
  for (std::size_t i = 0; i < node_count; ++i) first_arc_[i + 1] += first_arc_[i];
  std::vector<std::uint32_t> next(first_arc_.begin(), first_arc_.end() - 1);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e];
    arcs_[next[a]++] = {b, e};
    arcs_[next[b]++] = {a, e};
  }
}

std::vector<std::uint32_t> connected_components(const Multigraph& graph) {
  std::vector<std::uint32_t> component(graph.node_count());
  boost::connected_components(
      graph, boost::make_iterator_property_map(component.begin(), get(boost::vertex_index, graph)));
  return component;
}

std::vector<std::uint32_t> odd_nodes(const Multigraph& graph) {
  std::vector<std::uint32_t> nodes;
  for (std::uint32_t node = 0; node < graph.node_count(); ++node)
    if (graph.degree(node) % 2 == 1) nodes.push_back(node);
  return nodes;
}

std::vector<std::uint32_t> removable_odd_edges(const Multigraph& graph) {
  return OddEdgeRemover(graph).remove();
}

std::vector<Circuit> euler_circuits(const Multigraph& graph, std::span<const Point2> places) {
  if (!places.empty() && places.size() != graph.node_count()) {
    throw Error(ErrorKind::kBadUsage, "euler_circuits: " + std::to_string(places.size()) +
                                          " places for " + std::to_string(graph.node_count()) +
                                          " nodes");
  }
  if (const std::vector<std::uint32_t> odd = odd_nodes(graph); !odd.empty()) {
    throw Error(ErrorKind::kBadUsage, "euler_circuits: " + std::to_string(odd.size()) +
                                          " nodes are odd, the first is " +
                                          std::to_string(odd.front()));
  }
  Walker walker(graph, places);
  std::vector<Circuit> circuits;
  for (std::uint32_t node = 0; node < graph.node_count(); ++node) {
    if (walker.has_free_arc(node)) circuits.push_back(walker.walk_from(node));
  }
  return circuits;
}

}  // namespace routebench
