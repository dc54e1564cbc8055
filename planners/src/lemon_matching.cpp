#include "lemon_matching.hpp"

// Templates only: nothing of the library itself is linked.
#define LEMON_ONLY_TEMPLATES
#include <lemon/matching.h>
#include <lemon/smart_graph.h>

namespace routebench::lemon_matching {

Solution solve(std::uint32_t node_count, const std::vector<WeightedPair>& pairs) {
  using Graph = lemon::SmartGraph;
  using Weights = Graph::EdgeMap<std::int64_t>;
  using Matcher = lemon::MaxWeightedPerfectMatching<Graph, Weights>;
  static_assert(Matcher::dualScale == kPriceScale, "LEMON scales its dual solution otherwise");

  Graph graph;
  graph.reserveNode(static_cast<int>(node_count));
  graph.reserveEdge(static_cast<int>(pairs.size()));
  for (std::uint32_t i = 0; i < node_count; ++i) graph.addNode();
  const auto node = [](std::uint32_t i) { return Graph::nodeFromId(static_cast<int>(i)); };
  Weights weights(graph);
  // LEMON looks for the heaviest matching.
  for (const WeightedPair& pair : pairs)
    weights[graph.addEdge(node(pair.a), node(pair.b))] = -pair.weight;

  Solution solution;
  Matcher matcher(graph, weights);
  if (!matcher.run()) return solution;
  for (std::uint32_t i = 0; i < node_count; ++i) {
    solution.mate.push_back(static_cast<std::uint32_t>(Graph::id(matcher.mate(node(i)))));
    solution.price.push_back(-matcher.nodeValue(node(i)));
  }
  for (int k = 0; k < matcher.blossomNum(); ++k) {
    Blossom blossom{{}, matcher.blossomValue(k)};
    if (blossom.price == 0) continue;
    for (Matcher::BlossomIt it(matcher, k); it != lemon::INVALID; ++it)
      blossom.nodes.push_back(static_cast<std::uint32_t>(Graph::id(it)));
    solution.blossoms.push_back(std::move(blossom));
  }
  return solution;
}

}  // namespace routebench::lemon_matching
