#include "eulerian/trails.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "eulerian/polyline.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/inside_path.hpp"
#include "routebench/planning/matching.hpp"
#include "routebench/planning/ring_path.hpp"

namespace routebench::eulerian {
namespace {

std::vector<Multigraph::Ends> edges_that_stay(const Multigraph& graph) {
  const std::vector<std::uint32_t> removed = removable_odd_edges(graph);
  std::vector<Multigraph::Ends> left;
  auto next = removed.begin();
  for (std::uint32_t e = 0; e < graph.edges().size(); ++e) {
    if (next != removed.end() && *next == e)
      ++next;
    else
      left.push_back(graph.edges()[e]);
  }
  return left;
}

}  // namespace

std::vector<Multigraph::Ends> jumps_of(const Multigraph& graph, const std::vector<Point2>& places,
                                       Pairing pairing) {
  const std::vector<std::uint32_t> part_of = connected_components(graph);
  std::vector<std::uint32_t> odd = odd_nodes(graph);
  std::stable_sort(odd.begin(), odd.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return part_of[a] < part_of[b]; });
  std::vector<Multigraph::Ends> jumps;
  for (std::size_t begin = 0, end = 0; begin < odd.size(); begin = end) {
    std::vector<Point2> points;
    for (; end < odd.size() && part_of[odd[end]] == part_of[odd[begin]]; ++end)
      points.push_back(places[odd[end]]);
    const Matching partner =
        pairing == Pairing::kGreedy ? greedy_matching(points) : minimum_matching(points);
    for (std::size_t i = 0; i < partner.size(); ++i)
      if (i < partner[i]) jumps.push_back({odd[begin + i], odd[begin + partner[i]]});
  }
  return jumps;
}

std::vector<std::vector<Point2>> walk_trails(const PlacedGraph& placed, const Polygons& region,
                                             const TrailRule& rule, const PlanContext& context) {
  const std::vector<Point2>& places = placed.places;
  std::vector<Multigraph::Ends> edges = edges_that_stay(Multigraph(places.size(), placed.edges));
  stop_if_asked(context);
  const auto first_jump = static_cast<std::uint32_t>(edges.size());
  const std::vector<Multigraph::Ends> jumps =
      jumps_of(Multigraph(places.size(), edges), places, rule.pairing);
  edges.insert(edges.end(), jumps.begin(), jumps.end());
  const Multigraph graph(places.size(), std::move(edges));
  stop_if_asked(context);

  std::optional<InsidePaths> paths;
  if (rule.jump == Jump::kReroute && !jumps.empty()) paths.emplace(region);
  // The way of an edge; nothing if it is travelled.
  const auto way = [&](std::uint32_t edge, Point2 a,
                       Point2 b) -> std::optional<std::vector<Point2>> {
    if (edge < first_jump || rule.jump == Jump::kExtrude) return std::vector{a, b};
    if (rule.jump == Jump::kTravel || distance(a, b) > rule.longest_mm) return std::nullopt;
    // Beside an edge of the graph it would be laid twice.
    const auto [u, v] = graph.edges()[edge];
    for (const Multigraph::Arc arc : graph.arcs(u))
      if (arc.head == v && arc.edge < first_jump) return std::nullopt;
    auto path = paths->shortest(a, b);
    if (path && length_mm(*path) > rule.longest_mm) path.reset();
    return path;
  };

  std::vector<std::vector<Point2>> trails;
  for (const Circuit& circuit : euler_circuits(
           graph, rule.straight ? std::span<const Point2>(places) : std::span<const Point2>())) {
    std::vector<std::vector<Point2>> runs(1);
    for (std::size_t i = 0; i < circuit.edges.size(); ++i) {
      stop_if_asked(context);
      const Point2 a = places[circuit.nodes[i]], b = places[circuit.nodes[i + 1]];
      if (runs.back().empty()) runs.back().push_back(a);
      const auto path = way(circuit.edges[i], a, b);
      if (!path) {
        runs.emplace_back();
        continue;
      }
      for (const Point2 p : *path) append_straight(runs.back(), p);
    }
    // What comes before the first travel goes on from what comes after the last one.
    if (runs.size() > 1 && !runs.front().empty()) {
      for (const Point2 p : runs.front()) append_straight(runs.back(), p);
      runs.erase(runs.begin());
    }
    for (std::vector<Point2>& run : runs)
      if (run.size() >= 2) trails.push_back(std::move(run));
  }
  return trails;
}

}  // namespace routebench::eulerian
