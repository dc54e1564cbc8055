#include "routebench/planning/inside_path.hpp"

#include <algorithm>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/property_map/function_property_map.hpp>
#include <cstdint>
#include <limits>

#include "multigraph_bgl.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/euler.hpp"

namespace routebench {
namespace {

// Ellipses of so many times the distance of their foci, then of twice as many, and so on.
constexpr double kFirstReach = 1.25;

bool holds(const Box2& box, Point2 p) {
  return p.x >= box.lower.x && p.x <= box.upper.x && p.y >= box.lower.y && p.y <= box.upper.y;
}

}  // namespace

InsidePaths::InsidePaths(const Polygons& polygons) {
  for (const Polygon& polygon : polygons) {
    Room room{EdgeGrid({polygon}), bounding_box(polygon), {}};
    const auto add_corners = [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Corner corner{ring[(i + ring.size() - 1) % ring.size()], ring[i],
                            ring[(i + 1) % ring.size()]};
        // The area lies to the left of every ring.
        if (cross(corner.at - corner.before, corner.after - corner.at) < 0)
          room.corners.push_back(corner);
      }
    };
    add_corners(polygon.outer);
    for (const Ring& hole : polygon.holes) add_corners(hole);
    rooms_.push_back(std::move(room));
  }
}

std::optional<std::vector<Point2>> InsidePaths::shortest(Point2 a, Point2 b) const {
  for (const Room& room : rooms_) {
    if (!holds(room.box, a) || !holds(room.box, b)) continue;
    if (!room.edges.contains(a) || !room.edges.contains(b)) continue;
    if (room.edges.covers(a, b)) return std::vector{a, b};
    std::vector<Corner> near;
    for (double reach = kFirstReach * distance(a, b);; reach *= 2) {
      // A way no longer than the reach bends only at corners of this ellipse.
      near.clear();
      for (const Corner& corner : room.corners)
        if (distance(a, corner.at) + distance(corner.at, b) <= reach) near.push_back(corner);
      std::vector<Point2> path = shortest_over(near, room.edges, a, b);
      double length = 0;
      for (std::size_t i = 1; i < path.size(); ++i) length += distance(path[i - 1], path[i]);
      const bool is_shortest = !path.empty() && length <= reach;
      if (is_shortest || near.size() == room.corners.size()) {
        if (path.empty()) break;
        return path;
      }
    }
  }
  return std::nullopt;
}

std::vector<Point2> InsidePaths::shortest_over(const std::vector<Corner>& corners,
                                               const EdgeGrid& edges, Point2 a, Point2 b) {
  // Nodes: the corners, then a, then b.
  const auto start = static_cast<std::uint32_t>(corners.size());
  const std::uint32_t goal = start + 1;
  const auto place = [&](std::uint32_t node) {
    return node == start ? a : node == goal ? b : corners[node].at;
  };
  // A shortest path bends round a corner, so both of the corner's edges lie on one side of it.
  const auto touches = [&](std::uint32_t node, Point2 from) {
    if (node >= start) return true;
    const Corner& corner = corners[node];
    const Point2 way = corner.at - from;
    const double before = cross(way, corner.before - corner.at);
    const double after = cross(way, corner.after - corner.at);
    return (before >= 0 && after >= 0) || (before <= 0 && after <= 0);
  };
  std::vector<Multigraph::Ends> sights;
  std::vector<double> lengths;
  for (std::uint32_t i = 0; i <= goal; ++i) {
    for (std::uint32_t j = i + 1; j <= goal; ++j) {
      const Point2 p = place(i), q = place(j);
      if (!touches(i, q) || !touches(j, p) || !edges.covers(p, q)) continue;
      sights.push_back({i, j});
      lengths.push_back(distance(p, q));
    }
  }
  const Multigraph graph(corners.size() + 2, std::move(sights));
  std::vector<std::uint32_t> previous(graph.node_count());
  const auto length_of = boost::make_function_property_map<bgl::EdgeSeen>(
      [&](const bgl::EdgeSeen& edge) { return lengths[edge.edge]; });
  boost::dijkstra_shortest_paths(
      graph, goal,
      boost::weight_map(length_of).predecessor_map(
          boost::make_iterator_property_map(previous.begin(), get(boost::vertex_index, graph))));
  std::vector<Point2> path{a};
  for (std::uint32_t node = start; node != goal; node = previous[node]) {
    if (previous[node] == node) return {};  // not reached
    path.push_back(place(previous[node]));
  }
  return path;
}

}  // namespace routebench
