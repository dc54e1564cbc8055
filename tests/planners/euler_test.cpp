#include "routebench/planning/euler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using Ends = Multigraph::Ends;

Multigraph without(const Multigraph& graph, const std::vector<std::uint32_t>& removed) {
  std::vector<Ends> left;
  for (std::uint32_t e = 0; e < graph.edges().size(); ++e)
    if (!std::binary_search(removed.begin(), removed.end(), e)) left.push_back(graph.edges()[e]);
  return {graph.node_count(), left};
}

std::uint32_t below(std::mt19937_64& random, std::uint32_t bound) {
  return std::uniform_int_distribution<std::uint32_t>(0, bound - 1)(random);
}

/// Any edges at all, loops and parallel ones among them.
Multigraph random_multigraph(std::mt19937_64& random, std::uint32_t nodes, std::uint32_t edges) {
  std::vector<Ends> list;
  while (list.size() < edges) list.push_back({below(random, nodes), below(random, nodes)});
  return {nodes, list};
}

/// A few closed random walks: no node is odd, some components, some nodes without edges.
Multigraph random_even_multigraph(std::mt19937_64& random) {
  const std::uint32_t nodes = 2 + below(random, 40);
  std::vector<Ends> edges;
  for (std::uint32_t walks = below(random, 6); walks > 0; --walks) {
    const std::uint32_t start = below(random, nodes);
    std::uint32_t at = start;
    for (std::uint32_t steps = below(random, 30); steps > 0; --steps) {
      const std::uint32_t next = below(random, nodes);
      edges.push_back({at, next});
      at = next;
    }
    edges.push_back({at, start});
  }
  return {nodes, edges};
}

struct Lattice {
  Multigraph graph;
  std::vector<Point2> places;
};

Lattice lattice(std::uint32_t columns, std::uint32_t rows, bool torus = false) {
  std::vector<Ends> edges;
  std::vector<Point2> places;
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t here = y * columns + x;
      places.push_back({static_cast<double>(x), static_cast<double>(y)});
      if (x + 1 < columns) edges.push_back({here, here + 1});
      if (y + 1 < rows) edges.push_back({here, here + columns});
      if (torus && x + 1 == columns) edges.push_back({here, y * columns});
      if (torus && y + 1 == rows) edges.push_back({here, x});
    }
  }
  return {{std::size_t{columns} * rows, edges}, places};
}

/// Every edge once, neighbours in the walk share a node, closed, one circuit a component with
/// edges.
void expect_certificate(const Multigraph& graph, const std::vector<Circuit>& circuits) {
  std::vector<int> times(graph.edges().size());
  const std::vector<std::uint32_t> component = connected_components(graph);
  std::vector<std::uint32_t> walked;
  for (const Circuit& circuit : circuits) {
    ASSERT_FALSE(circuit.edges.empty());
    ASSERT_EQ(circuit.nodes.size(), circuit.edges.size() + 1);
    EXPECT_EQ(circuit.nodes.front(), circuit.nodes.back());
    for (std::size_t i = 0; i < circuit.edges.size(); ++i) {
      ++times[circuit.edges[i]];
      Ends ends = graph.edges()[circuit.edges[i]];
      if (ends[0] != circuit.nodes[i]) std::swap(ends[0], ends[1]);
      EXPECT_EQ(ends, (Ends{circuit.nodes[i], circuit.nodes[i + 1]}));
    }
    walked.push_back(component[circuit.nodes.front()]);
    EXPECT_EQ(circuit.nodes.front(), *std::min_element(circuit.nodes.begin(), circuit.nodes.end()));
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), std::ssize(times));
  EXPECT_TRUE(std::is_sorted(walked.begin(), walked.end()));
  EXPECT_EQ(std::adjacent_find(walked.begin(), walked.end()), walked.end());
}

std::size_t turns(const std::vector<Circuit>& circuits, const std::vector<Point2>& places) {
  std::size_t count = 0;
  for (const Circuit& circuit : circuits)
    for (std::size_t i = 2; i < circuit.nodes.size(); ++i) {
      const Point2 a = places[circuit.nodes[i - 2]], b = places[circuit.nodes[i - 1]],
                   c = places[circuit.nodes[i]];
      if (dot(b - a, c - b) < 0.5) ++count;
    }
  return count;
}

TEST(Multigraph, RowsHoldEveryEdgeAtBothEnds) {
  const Multigraph graph(4, {{0, 1}, {1, 0}, {2, 2}, {1, 2}});
  EXPECT_EQ(graph.node_count(), 4U);
  EXPECT_EQ(graph.degree(0), 2U);
  EXPECT_EQ(graph.degree(1), 3U);
  EXPECT_EQ(graph.degree(2), 3U);
  EXPECT_EQ(graph.degree(3), 0U);
  ASSERT_EQ(graph.arcs(1).size(), 3U);
  EXPECT_EQ(graph.arcs(1)[2].head, 2U);
  EXPECT_EQ(graph.arcs(1)[2].edge, 3U);
  EXPECT_EQ(graph.arcs(2)[0].head, 2U);
  EXPECT_EQ(graph.arcs(2)[1].edge, 2U);
  EXPECT_THROW(Multigraph(2, {{0, 2}}), Error);
}

TEST(Multigraph, ComponentsAreWhatSearchingFinds) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 200; ++round) {
    const Multigraph graph = random_multigraph(random, 1 + below(random, 30), below(random, 30));
    std::vector<std::uint32_t> expected(graph.node_count(), ~0U);
    std::uint32_t number = 0;
    for (std::uint32_t start = 0; start < graph.node_count(); ++start) {
      if (expected[start] != ~0U) continue;
      std::vector<std::uint32_t> open{start};
      expected[start] = number;
      while (!open.empty()) {
        const std::uint32_t node = open.back();
        open.pop_back();
        for (const Multigraph::Arc arc : graph.arcs(node)) {
          if (expected[arc.head] == number) continue;
          expected[arc.head] = number;
          open.push_back(arc.head);
        }
      }
      ++number;
    }
    EXPECT_EQ(connected_components(graph), expected);
  }
}

TEST(EulerCircuits, UseEveryEdgeOnceOnRandomMultigraphs) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 500; ++round) {
    const Multigraph graph = random_even_multigraph(random);
    ASSERT_TRUE(odd_nodes(graph).empty());
    expect_certificate(graph, euler_circuits(graph));
    std::vector<Point2> places;
    std::uniform_real_distribution<double> coordinate(-1, 1);
    for (std::size_t i = 0; i < graph.node_count(); ++i)
      places.push_back({coordinate(random), coordinate(random)});
    expect_certificate(graph, euler_circuits(graph, places));
    const std::vector<Point2> heap(graph.node_count());  // all in one place: every direction is 0
    expect_certificate(graph, euler_circuits(graph, heap));
  }
}

TEST(EulerCircuits, StraightOnTurnsLess) {
  const auto [full, places] = lattice(14, 10);
  const Multigraph graph = without(full, removable_odd_edges(full));
  const std::vector<Circuit> straight = euler_circuits(graph, places);
  const std::vector<Circuit> first = euler_circuits(graph);
  expect_certificate(graph, straight);
  expect_certificate(graph, first);
  EXPECT_LT(2 * turns(straight, places), turns(first, places));
}

TEST(EulerCircuits, LongWalksNeedNoDeepRecursion) {
  const auto [graph, places] = lattice(300, 300, true);
  expect_certificate(graph, euler_circuits(graph, places));
}

TEST(EulerCircuits, RefuseOddNodesAndMissingPlaces) {
  EXPECT_THROW(static_cast<void>(euler_circuits(Multigraph(2, {{0, 1}}))), Error);
  const std::vector<Point2> one(1);
  EXPECT_THROW(static_cast<void>(euler_circuits(Multigraph(2, {{0, 1}, {0, 1}}), one)), Error);
  EXPECT_TRUE(euler_circuits(Multigraph(0, {})).empty());
  EXPECT_TRUE(euler_circuits(Multigraph(3, {})).empty());
}

TEST(RemovableOddEdges, NeverCutAndLeaveNothingThatCouldGo) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 400; ++round) {
    const std::uint32_t nodes = 2 + below(random, 14);
    const Multigraph graph = random_multigraph(random, nodes, below(random, 40));
    const std::vector<std::uint32_t> removed = removable_odd_edges(graph);
    std::vector<int> lost(nodes);
    for (const std::uint32_t e : removed) {
      const auto [a, b] = graph.edges()[e];
      EXPECT_EQ(graph.degree(a) % 2, 1U);
      EXPECT_EQ(graph.degree(b) % 2, 1U);
      EXPECT_NE(a, b);
      ++lost[a];
      ++lost[b];
    }
    EXPECT_LE(*std::max_element(lost.begin(), lost.end()), 1);

    const Multigraph left = without(graph, removed);
    const std::vector<std::uint32_t> components = connected_components(graph);
    EXPECT_EQ(connected_components(left), components);
    for (std::uint32_t e = 0; e < left.edges().size(); ++e) {
      const auto [a, b] = left.edges()[e];
      if (a == b || left.degree(a) % 2 == 0 || left.degree(b) % 2 == 0) continue;
      EXPECT_NE(connected_components(without(left, {e})), components) << "one more could go";
    }
  }
}

TEST(RemovableOddEdges, MakeAnEvenRimEulerian) {
  // Every side of this lattice has an even number of odd nodes: they go in pairs, from the corners.
  for (const auto& [columns, rows] : {std::pair{8U, 6U}, {4U, 4U}, {30U, 12U}}) {
    const Multigraph graph = lattice(columns, rows).graph;
    EXPECT_EQ(odd_nodes(graph).size(), 2 * (columns + rows) - 8);
    EXPECT_TRUE(odd_nodes(without(graph, removable_odd_edges(graph))).empty());
  }
}

TEST(RemovableOddEdges, ChainsAreTakenFromTheirEnds) {
  // A path of eight odd nodes over one hub; the numbers run so that the lowest is in the middle.
  const std::vector<std::uint32_t> path = {5, 3, 1, 0, 2, 4, 6, 7};
  std::vector<Ends> edges;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i > 0) edges.push_back({path[i - 1], path[i]});
    edges.push_back({path[i], 8});
  }
  edges.push_back({path.front(), 8});
  edges.push_back({path.back(), 8});
  const Multigraph graph(9, edges);
  ASSERT_EQ(odd_nodes(graph).size(), 8U);
  EXPECT_EQ(removable_odd_edges(graph).size(), 4U);
}

}  // namespace
}  // namespace routebench
