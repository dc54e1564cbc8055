/// Insets by CGAL's straight skeleton.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/create_offset_polygons_2.h>
#include <CGAL/create_straight_skeleton_2.h>

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <utility>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "skeleton.hpp"

namespace {

using namespace routebench;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalRing = CGAL::Polygon_2<Kernel>;

CgalRing to_cgal(const Ring& ring) {
  CgalRing out;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (ring[i] != ring[i == 0 ? ring.size() - 1 : i - 1]) out.push_back({ring[i].x, ring[i].y});
  return out;
}

}  // namespace

void routebench_skeleton_insets(const Polygon& polygon, double step_mm, const PlanContext& context,
                                std::vector<Polygons>& insets) {
  const CgalRing outer = to_cgal(polygon.outer);
  std::vector<CgalRing> holes;
  for (const Ring& hole : polygon.holes) holes.push_back(to_cgal(hole));
  // Skeletons are defined for simple rings only; ours may touch themselves.
  if (!outer.is_simple()) return;
  for (const CgalRing& hole : holes)
    if (!hole.is_simple()) return;
  const auto skeleton = CGAL::create_interior_straight_skeleton_2(
      outer.vertices_begin(), outer.vertices_end(), holes.begin(), holes.end(), Kernel());
  if (!skeleton) return;
  for (double inset_mm = step_mm;; inset_mm += step_mm) {
    stop_if_asked(context);
    std::vector<Ring> rings;
    for (const auto& found :
         CGAL::create_offset_polygons_2<CgalRing>(inset_mm, *skeleton, Kernel())) {
      Ring& ring = rings.emplace_back();
      for (const Kernel::Point_2& p : *found) ring.push_back(snap(Point2{p.x(), p.y()}));
    }
    if (rings.empty()) return;
    insets.push_back(polygons_from_rings(std::move(rings), FillRule::kEvenOdd));
  }
}
