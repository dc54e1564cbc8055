#pragma once
/// Routes as honest planners would make them, for tests of those who judge them.

#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::test {

inline void append(Route& route, const Route& more) {
  route.strokes.insert(route.strokes.end(), more.strokes.begin(), more.strokes.end());
}

/// One closed stroke for every ring.
inline Route loops(const Polygons& polygons, double width_mm) {
  Route route;
  const auto add = [&](const Ring& ring) {
    Stroke stroke{ring, width_mm};
    stroke.points.push_back(ring.front());
    route.strokes.push_back(std::move(stroke));
  };
  for (const Polygon& polygon : polygons) {
    add(polygon.outer);
    for (const Ring& hole : polygon.holes) add(hole);
  }
  return route;
}

/// The task's perimeters.
inline Route walls(const Polygons& polygons, const Task& task) {
  Route route;
  Polygons region = polygons;
  for (int wall = 0; wall < task.perimeters; ++wall) {
    // The centre line of a wall runs half a spacing inside the region that it borders; the first
    // one half a line, so that its bead touches the outline. The difference stays in the walls.
    append(route,
           loops(offset(region, wall == 0 ? -task.line_width_mm / 2 : -task.spacing_mm() / 2),
                 task.line_width_mm));
    region = offset(region, -task.spacing_mm());
  }
  return route;
}

struct Hatch {
  double distance_mm = 1;
  double angle_rad = 0;
  double phase = 0.5;  ///< of the first line, in distances from the region's origin
  /// Whether line k is laid.
  std::function<bool(long)> keep = [](long) { return true; };
};

/// Parallel lines, to and fro, their ends half a line inside the region.
inline Route lines(const Polygons& region, const Hatch& hatch, double width_mm) {
  Route route;
  if (region.empty()) return route;
  const EdgeGrid edges(region);
  const Point2 along{std::cos(hatch.angle_rad), std::sin(hatch.angle_rad)};
  const Point2 across{-along.y, along.x};
  const Box2 box = bounding_box(region);
  double low = 1e300, high = -1e300, left = 1e300, right = -1e300;
  for (const Point2 corner :
       {box.lower, box.upper, Point2{box.lower.x, box.upper.y}, Point2{box.upper.x, box.lower.y}}) {
    low = std::min(low, dot(across, corner));
    high = std::max(high, dot(across, corner));
    left = std::min(left, dot(along, corner));
    right = std::max(right, dot(along, corner));
  }
  bool back = false;
  for (long k = 0;; ++k) {
    const double height = low + (static_cast<double>(k) + hatch.phase) * hatch.distance_mm;
    if (height > high - width_mm / 2) break;
    if (height < low + width_mm / 2 || !hatch.keep(k)) continue;
    const Point2 a = (left - 1) * along + height * across;
    const Point2 b = (right + 1) * along + height * across;
    const std::vector<double> cuts = edges.crossings(a, b);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      if (!edges.contains(lerp(a, b, (cuts[i - 1] + cuts[i]) / 2))) continue;
      const Point2 from = lerp(a, b, cuts[i - 1]) + width_mm / 2 * along;
      const Point2 to = lerp(a, b, cuts[i]) - width_mm / 2 * along;
      if (dot(along, to - from) < width_mm / 2) continue;
      Stroke stroke{{snap(from), snap(to)}, width_mm};
      if (back) std::swap(stroke.points.front(), stroke.points.back());
      back = !back;
      route.strokes.push_back(std::move(stroke));
    }
  }
  return route;
}

}  // namespace routebench::test
