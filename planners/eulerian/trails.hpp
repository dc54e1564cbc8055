#pragma once
/// A graph made Eulerian and walked.

#include <vector>

#include "eulerian/cell_graph.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::eulerian {

/// How odd nodes that are left are paired.
enum class Pairing { kGreedy, kMatching };
/// How the circuit gets from one of a pair to the other.
enum class Jump {
  kTravel,   ///< without extruding
  kReroute,  ///< extruding on the shortest way inside
  kExtrude,  ///< extruding straight, across hollows too
};

struct TrailRule {
  Pairing pairing = Pairing::kMatching;
  Jump jump = Jump::kTravel;
  bool straight = true;   ///< run straight on where that can be
  double longest_mm = 0;  ///< of a jump that is rerouted; longer ones are travelled
};

/// Walks every edge of a graph, but for those that are removed to make it Eulerian: edges between
/// odd nodes whose removal does not cut it, then jumps between the odd nodes that are left, within
/// each connected part.
///
/// Takes   a graph, and the region in which jumps are rerouted.
/// Returns polylines; without jumps that are travelled one for each connected part, and closed.
/// Cost    linear in edges, and that of the matching and of the ways round.
/// Source  S. Lei, 2015.
[[nodiscard]] std::vector<std::vector<Point2>> walk_trails(const PlacedGraph& graph,
                                                           const Polygons& region,
                                                           const TrailRule& rule,
                                                           const PlanContext& context);

/// Edges between odd nodes that make the graph Eulerian, as walk_trails adds them: for every part
/// the pairs of its odd nodes. Takes   a graph from which removable edges are gone.
[[nodiscard]] std::vector<Multigraph::Ends> jumps_of(const Multigraph& graph,
                                                     const std::vector<Point2>& places,
                                                     Pairing pairing);

}  // namespace routebench::eulerian
