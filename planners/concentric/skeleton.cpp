/// Insets by CGAL's straight skeleton.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2.h>
#include <CGAL/create_offset_polygons_2.h>
#include <CGAL/create_straight_skeleton_2.h>

#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <exception>
#include <utility>

#include "insets.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"

namespace routebench::concentric {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalRing = CGAL::Polygon_2<Kernel>;

CgalRing to_cgal(const Ring& ring) {
  CgalRing out;
  for (std::size_t i = 0; i < ring.size(); ++i)
    if (ring[i] != ring[i == 0 ? ring.size() - 1 : i - 1]) out.push_back({ring[i].x, ring[i].y});
  return out;
}

std::size_t points_of(const Polygon& polygon) {
  std::size_t points = polygon.outer.size();
  for (const Ring& hole : polygon.holes) points += hole.size();
  return points;
}

/// The insets of one polygon; nothing if CGAL fails, as it may where the construction is inexact.
std::vector<Polygons> insets_of(const Polygon& polygon, double step_mm,
                                const PlanContext& context) {
  const CgalRing outer = to_cgal(polygon.outer);
  std::vector<CgalRing> holes;
  for (const Ring& hole : polygon.holes) holes.push_back(to_cgal(hole));
  std::vector<Polygons> all;
  // Skeletons are defined for simple rings only; ours may touch themselves.
  if (!outer.is_simple()) return all;
  for (const CgalRing& hole : holes)
    if (!hole.is_simple()) return all;
  const auto skeleton = CGAL::create_interior_straight_skeleton_2(
      outer.vertices_begin(), outer.vertices_end(), holes.begin(), holes.end(), Kernel());
  if (!skeleton) return all;
  for (double inset_mm = step_mm;; inset_mm += step_mm) {
    stop_if_asked(context);
    std::vector<Ring> rings;
    for (const auto& found :
         CGAL::create_offset_polygons_2<CgalRing>(inset_mm, *skeleton, Kernel())) {
      Ring& ring = rings.emplace_back();
      for (const Kernel::Point_2& p : *found) ring.push_back(snap(Point2{p.x(), p.y()}));
    }
    if (rings.empty()) return all;
    all.push_back(polygons_from_rings(std::move(rings), FillRule::kEvenOdd));
  }
}

}  // namespace

std::vector<Polygons> skeleton_insets(const Polygons& polygons, double first_mm, double step_mm,
                                      const PlanContext& context) {
  // An offset rids the outline of the points that do not matter, which may be most of a curve's.
  const Polygons outermost = offset(polygons, -first_mm);
  if (outermost.empty()) return {};
  std::vector<Polygons> all{outermost};
  for (const Polygon& polygon : outermost) {
    stop_if_asked(context);
    std::vector<Polygons> own;
    try {
      if (points_of(polygon) <= kMostSkeletonPoints) own = insets_of(polygon, step_mm, context);
    } catch (const Error&) {
      throw;
    } catch (const std::exception&) {
      own.clear();
    }
    if (own.empty()) own = insets({polygon}, step_mm, step_mm, Method::kClipper, context);
    if (all.size() <= own.size()) all.resize(own.size() + 1);
    for (std::size_t i = 0; i < own.size(); ++i)
      all[i + 1].insert(all[i + 1].end(), own[i].begin(), own[i].end());
  }
  return all;
}

}  // namespace routebench::concentric
