#include "eulerian/trails.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "eulerian/lattice.hpp"
#include "eulerian/tree_coverage.hpp"
#include "planning.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/planning/matching.hpp"

namespace routebench::eulerian {
namespace {

using test::kSpacing;
using test::kWidth;

const PlanContext kContext = test::context_for(2, 1);

std::vector<Polygon> regions() {
  std::vector<Polygon> regions{test::blob().front()};
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (const Polygon& polygon : test::random_polygons(seed)) regions.push_back(polygon);
  return regions;
}

double length_mm(const PlacedGraph& graph, const std::vector<Multigraph::Ends>& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) sum += distance(graph.places[a], graph.places[b]);
  return sum;
}

/// The graph without the edges that may go.
Multigraph thinned(const PlacedGraph& graph) {
  const Multigraph all(graph.places.size(), graph.edges);
  const std::vector<std::uint32_t> removed = removable_odd_edges(all);
  std::vector<Multigraph::Ends> left;
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e)
    if (!std::binary_search(removed.begin(), removed.end(), e)) left.push_back(graph.edges[e]);
  return {graph.places.size(), left};
}

std::vector<PlacedGraph> graphs_of(const Polygon& region) {
  return {square_graph(region, 1.5, 0.3), leaf_graph({region}, 0.9, LeafRule::kInside, kContext),
          leaf_graph({region}, 0.9, LeafRule::kShape, kContext)};
}

TEST(SquareGraph, ASquareHasItsLinesAndTheirEnds) {
  // Lines at 2, 4, 6 and 8 in both directions: 16 crossings and 16 ends.
  const PlacedGraph graph = square_graph({test::rectangle(1, 1, 9, 9), {}}, 2, 0.3);
  EXPECT_EQ(graph.places.size(), 32U);
  EXPECT_EQ(graph.edges.size(), 2U * 4 * 5);
  EXPECT_DOUBLE_EQ(length_mm(graph, graph.edges), 2 * 4 * 8);
  // Ends 0.2 from a crossing are left out.
  const PlacedGraph tight = square_graph({test::rectangle(1.8, 1, 9, 9), {}}, 2, 0.3);
  EXPECT_DOUBLE_EQ(length_mm(tight, tight.edges), 4 * 8 + 4 * 7);
}

TEST(CellGraph, EveryNodeStandsAloneInItsPlace) {
  for (const Polygon& region : regions())
    for (const PlacedGraph& graph : graphs_of(region)) {
      std::set<std::pair<double, double>> places;
      for (const Point2 p : graph.places) EXPECT_TRUE(places.emplace(p.x, p.y).second);
      std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
      for (const auto& [a, b] : graph.edges)
        EXPECT_TRUE(edges.insert(std::minmax(a, b)).second && a != b);
    }
}

TEST(Trails, JumpsLeaveNoNodeOddAndNoPart) {
  double greedy_mm = 0, matching_mm = 0;
  for (const Polygon& region : regions())
    for (const PlacedGraph& graph : graphs_of(region)) {
      const Multigraph thin = thinned(graph);
      const std::vector<std::uint32_t> parts = connected_components(thin);
      double sums[2]{};
      for (const Pairing pairing : {Pairing::kGreedy, Pairing::kMatching}) {
        const std::vector<Multigraph::Ends> jumps = jumps_of(thin, graph.places, pairing);
        std::vector<Multigraph::Ends> all(thin.edges().begin(), thin.edges().end());
        for (const auto& jump : jumps) {
          EXPECT_EQ(parts[jump[0]], parts[jump[1]]);
          all.push_back(jump);
        }
        EXPECT_TRUE(odd_nodes(Multigraph(graph.places.size(), all)).empty());
        sums[pairing == Pairing::kMatching ? 1 : 0] = length_mm(graph, jumps);
      }
      EXPECT_LE(sums[1], sums[0] + 1e-4);
      greedy_mm += sums[0];
      matching_mm += sums[1];
    }
  EXPECT_LE(matching_mm, 0.85 * greedy_mm);
}

TEST(Trails, EveryEdgeIsWalkedOnceInOneClosedTrailForEachPart) {
  for (const Polygon& region : regions())
    for (const PlacedGraph& graph : graphs_of(region))
      for (const bool straight : {false, true}) {
        const Multigraph thin = thinned(graph);
        const double edges_mm = length_mm(graph, {thin.edges().begin(), thin.edges().end()});
        const auto jumps = jumps_of(thin, graph.places, Pairing::kMatching);
        const double jumps_mm = length_mm(graph, jumps);
        const std::vector<std::uint32_t> part_of = connected_components(thin);
        std::map<std::uint32_t, std::size_t> pairs_of;  // of the parts that have edges
        for (const auto& edge : thin.edges()) pairs_of[part_of[edge[0]]] = 0;
        for (const auto& jump : jumps) ++pairs_of[part_of[jump[0]]];
        // A travel opens a part's circuit, and every further one cuts it.
        std::size_t travelled = 0;
        for (const auto& [part, pairs] : pairs_of) travelled += std::max<std::size_t>(1, pairs);
        for (const Jump jump : {Jump::kExtrude, Jump::kTravel}) {
          double laid_mm = 0;
          const auto trails =
              walk_trails(graph, {region}, {Pairing::kMatching, jump, straight, 0}, kContext);
          for (const std::vector<Point2>& trail : trails) {
            laid_mm += routebench::length_mm(trail);
            if (jump == Jump::kExtrude) {
              EXPECT_EQ(trail.front(), trail.back());
            }
          }
          EXPECT_NEAR(laid_mm, edges_mm + (jump == Jump::kExtrude ? jumps_mm : 0), 1e-6);
          EXPECT_EQ(trails.size(), jump == Jump::kExtrude ? pairs_of.size() : travelled);
        }
      }
}

/// How often strokes pass a place: every segment counts with its first point, not its last, unless
/// an open stroke ends there.
int passes(const std::vector<std::vector<Point2>>& strokes, Point2 p) {
  int count = 0;
  for (const std::vector<Point2>& points : strokes)
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Point2 near = nearest_on_segment(p, points[i - 1], points[i]);
      const bool ends = i + 1 == points.size() && points.front() != points.back();
      if (distance(near, p) < 1e-5 && (ends || distance(points[i], p) >= 1e-5)) ++count;
    }
  return count;
}

/// Checks how often nodes with three neighbours round a square are passed.
template <typename Check>
void check_cell_nodes(const Polygon& region, Check&& check) {
  for (const TreeOrder order : {TreeOrder::kRows, TreeOrder::kFirst}) {
    const Lattice lattice(region, {1, 1.2, kWidth / 2, false});
    const TreeStrokes strokes = cover_by_tree(lattice, order, kContext);
    for (const std::vector<Point2>& loop : strokes.loops) EXPECT_EQ(loop.front(), loop.back());
    for (std::uint32_t node = lattice.first(); node < lattice.last(); ++node) {
      const std::uint32_t up = lattice.stride();
      if (!lattice.joined_right(node) || !lattice.joined_up(node)) continue;
      if (!lattice.joined_right(node + up) || !lattice.joined_up(node + 1)) continue;
      for (const std::uint32_t corner : {node, node + 1, node + up, node + up + 1})
        check(strokes, passes(strokes.loops, lattice.place(corner)) +
                           passes(strokes.lines, lattice.place(corner)));
    }
  }
}

TEST(TreeCoverage, EveryNodeOfASquareIsVisitedOnce) {
  // Rooms of whole squares, two nodes wide at least: nothing has to be laid twice.
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Ring> rings;
    for (int room = 0; room < 8; ++room) {
      const auto at = [&](std::uint64_t cells) {
        return 2.0 * static_cast<double>(random() % cells) - 0.1;
      };
      const double x = at(10), y = at(10);
      rings.push_back(test::rectangle(x, y, x + 1.2 + 2 * std::floor(at(4) / 2 + 0.1),
                                      y + 1.2 + 2 * std::floor(at(4) / 2 + 0.1)));
    }
    for (const Polygon& region : polygons_from_rings(rings, FillRule::kNonZero))
      check_cell_nodes(region, [](const TreeStrokes& strokes, int count) {
        ASSERT_EQ(strokes.loops.size(), 1U);
        ASSERT_TRUE(strokes.lines.empty());
        ASSERT_EQ(count, 1);
      });
  }
}

TEST(TreeCoverage, NoNodeOfASquareIsMissed) {
  for (const Polygon& region : regions())
    check_cell_nodes(region, [](const TreeStrokes&, int count) { EXPECT_GE(count, 1); });
}

TEST(TreeCoverage, ABoxIsOneLoopAsLongAsItsNodesTakeInAnyOrder) {
  for (const double x : {3.0, 7.0, 12.0}) {
    const Lattice lattice({test::rectangle(0, 0, x, 10), {}}, {1, 1.2, 0.25, true});
    std::size_t nodes = 0;
    for (std::uint32_t node = lattice.first(); node < lattice.last(); ++node)
      if (lattice.has(node)) ++nodes;
    for (const TreeOrder order : {TreeOrder::kRows, TreeOrder::kColumns, TreeOrder::kFirst}) {
      const TreeStrokes strokes = cover_by_tree(lattice, order, kContext);
      ASSERT_EQ(strokes.loops.size(), 1U);
      EXPECT_TRUE(strokes.lines.empty());
      EXPECT_NEAR(routebench::length_mm(strokes.loops[0]), static_cast<double>(nodes),
                  0.1 * static_cast<double>(nodes));
    }
  }
}

TEST(Lattice, FittedAxesShareEvenlyAndNeverTooWide) {
  for (double length = 0.05; length < 12; length += 0.13) {
    const Pitch pitch{kSpacing, kWidth, kWidth / 2, true};
    const Axis axis = axis_over(1, 1 + length, pitch);
    EXPECT_LE(axis.step_mm, kWidth + 1e-12);
    // What lies beyond the first line is half a step, less what offsets may wave.
    EXPECT_NEAR(axis.first_mm - (1 - kWidth / 2), axis.step_mm / 2, 0.011);
    EXPECT_NEAR(1 + length + kWidth / 2 - axis.at(axis.count - 1), axis.step_mm / 2, 0.011);
  }
}

TEST(Lattice, RefusesMorePlacesThanItHoldsInMemory) {
  EXPECT_EQ(framed_places({0, 1, 4094}, {0, 1, 4094}), 16777216U);
  EXPECT_THROW((void)framed_places({0, 1, 4094}, {0, 1, 4095}), Error);
}

TEST(Lattice, NodesLieInsideAndKeepTheirDistance) {
  for (const Polygon& region : regions()) {
    const double pitch = 0.9;
    const Lattice lattice(region, {pitch, 1.0, 0.3, false});
    const EdgeGrid edges({region});
    for (std::uint32_t node = lattice.first(); node < lattice.last(); ++node) {
      if (!lattice.has(node)) continue;
      const Point2 p = lattice.place(node);
      EXPECT_TRUE(edges.contains(p) || edges.distance_to_edge_mm(p, 1e-5));
      for (const std::uint32_t other : {node + 1, node + lattice.stride() - 1,
                                        node + lattice.stride(), node + lattice.stride() + 1})
        if (lattice.has(other)) {
          EXPECT_GE(distance(p, lattice.place(other)), pitch / 2 - 1e-5);
        }
    }
  }
}

}  // namespace
}  // namespace routebench::eulerian
