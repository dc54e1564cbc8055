#pragma once
/// Graphs whose edges are walked to fill a region.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/euler.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::eulerian {

/// A graph with a place for every node.
struct PlacedGraph {
  std::vector<Point2> places;  ///< on the grid
  std::vector<Multigraph::Ends> edges;
};

/// Level and upright lines at multiples of a pitch, cut at the boundary: nodes where they cross
/// each other and where they end. Ends nearer than `least_mm` to a crossing are left out, and so
/// are lines that short.
/// Throws  see framed_places.
/// Cost    linear in lines, crossings and squares of the bounding box.
[[nodiscard]] PlacedGraph square_graph(const Polygon& region, double pitch_mm, double least_mm);

/// Which leaves of a quadtree are nodes.
enum class LeafRule {
  kInside,  ///< those whose centres lie inside, joined where the way between them does, too
  kShape,   ///< as published: those inside and all that the outline touches
};

/// Leaves of a quadtree at their centres, neighbours joined, also those of different sizes. The
/// root is the square round the bounding box with a border of two lines. Throws  see Quadtree. Cost
/// near linear in leaves and vertices. Source  S. Lei, 2015.
[[nodiscard]] PlacedGraph leaf_graph(const Polygons& region, double leaf_mm, LeafRule rule,
                                     const PlanContext& context);

}  // namespace routebench::eulerian
