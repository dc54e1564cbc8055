#include "eulerian/cell_graph.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "eulerian/lattice.hpp"
#include "eulerian/quadtree.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/planning/line_crossings.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench::eulerian {
namespace {

/// See square_graph.
class SquareGraph {
 public:
  SquareGraph(const Polygon& region, double pitch_mm, double least_mm)
      : rings_(rings_of({region})), least_mm_(least_mm) {
    const Box2 box = bounding_box(region);
    const Pitch pitch{pitch_mm, pitch_mm, 0, false};
    x_ = axis_over(box.lower.x, box.upper.x, pitch);
    y_ = axis_over(box.lower.y, box.upper.y, pitch);
    node_of_.assign(framed_places(x_, y_), kNone);
  }

  PlacedGraph build() {
    add_lines(true);
    for (Ring& ring : rings_)
      for (Point2& p : ring) std::swap(p.x, p.y);
    add_lines(false);
    return std::move(graph_);
  }

 private:
  /// Adds the level lines, or the upright ones, for which the rings were turned over.
  void add_lines(bool level) {
    const Axis& along = level ? x_ : y_;
    const Axis& across = level ? y_ : x_;
    const EvenLines lines{across.first_mm, across.step_mm, across.count};
    if (lines.count == 0) return;
    const std::vector<Crossing> crossings = cross_lines(rings_, lines, CrossingSearch::kBucket);
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const double from = crossings[i].x, to = crossings[i + 1].x;
      if (to - from < least_mm_) continue;
      const std::uint32_t line = crossings[i].line;
      const double y = across.at(line);
      const double first = std::max(0.0, std::ceil((from - along.first_mm) / along.step_mm));
      const double last =
          std::min(along.count - 1.0, std::floor((to - along.first_mm) / along.step_mm));
      std::uint32_t before = kNone;
      const auto go_to = [&](std::uint32_t node) {
        if (before != kNone && graph_.places[before] != graph_.places[node])
          graph_.edges.push_back({before, node});
        before = node;
      };
      const auto end_at = [&](double x) {
        graph_.places.push_back(snap(level ? Point2{x, y} : Point2{y, x}));
        go_to(static_cast<std::uint32_t>(graph_.places.size() - 1));
      };
      const bool crosses = first <= last;
      if (!crosses || along.first_mm + first * along.step_mm - from >= least_mm_) end_at(from);
      for (double k = first; k <= last; k += 1)
        go_to(crossing(level, static_cast<std::uint32_t>(k), line));
      if (!crosses || to - along.first_mm - last * along.step_mm >= least_mm_) end_at(to);
    }
  }

  /// The node where two lines cross.
  std::uint32_t crossing(bool level, std::uint32_t along, std::uint32_t across) {
    const std::uint32_t column = level ? along : across, row = level ? across : along;
    std::uint32_t& node = node_of_[std::size_t{row} * x_.count + column];
    if (node == kNone) {
      node = static_cast<std::uint32_t>(graph_.places.size());
      graph_.places.push_back(snap(Point2{x_.at(column), y_.at(row)}));
    }
    return node;
  }

  std::vector<Ring> rings_;
  double least_mm_;
  Axis x_, y_;
  std::vector<std::uint32_t> node_of_;  // of each crossing of lines
  PlacedGraph graph_;
};

}  // namespace

PlacedGraph square_graph(const Polygon& region, double pitch_mm, double least_mm) {
  return SquareGraph(region, pitch_mm, least_mm).build();
}

PlacedGraph leaf_graph(const Polygons& region, double leaf_mm, LeafRule rule,
                       const PlanContext& context) {
  if (region.empty()) return {};
  const Box2 box = bounding_box(region);
  const double border_mm = 2 * context.line_width_mm;
  const double side_mm =
      std::max(box.upper.x - box.lower.x, box.upper.y - box.lower.y) + 2 * border_mm;
  const std::vector<Ring> rings = rings_of(region);
  const Quadtree tree(rings, {box.lower.x - border_mm, box.lower.y - border_mm}, side_mm, leaf_mm);
  stop_if_asked(context);
  const std::vector<std::uint32_t> leaves = tree.leaves();
  const std::vector<bool> is_inside = inside(tree, rings, leaves);
  stop_if_asked(context);

  std::vector<std::uint32_t> nodes;
  PlacedGraph graph;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const bool touched = tree.kind(leaves[i]) == Quadtree::Kind::kTouched;
    if (!is_inside[i] && !(touched && rule == LeafRule::kShape)) continue;
    nodes.push_back(leaves[i]);
    graph.places.push_back(snap(tree.centre(leaves[i])));
  }
  const EdgeGrid edges(rule == LeafRule::kInside ? region : Polygons{});
  const auto touched = [&](std::uint32_t node) {
    return tree.kind(nodes[node]) == Quadtree::Kind::kTouched;
  };
  for (const auto& [a, b] : tree.neighbours(nodes))
    if (rule == LeafRule::kShape || (!touched(a) && !touched(b)) ||
        edges.covers(graph.places[a], graph.places[b]))
      graph.edges.push_back({a, b});
  return graph;
}

}  // namespace routebench::eulerian
