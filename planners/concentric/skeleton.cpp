#include "skeleton.hpp"

#include <cstddef>
#include <exception>

#include "insets.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/lazy_library.hpp"
#include "routebench/geometry/region.hpp"

namespace routebench::concentric {
namespace {

std::size_t points_of(const Polygon& polygon) {
  std::size_t points = polygon.outer.size();
  for (const Ring& hole : polygon.holes) points += hole.size();
  return points;
}

using SkeletonInsets = decltype(routebench_skeleton_insets);

SkeletonInsets& loaded() {
  static SkeletonInsets* const found = reinterpret_cast<SkeletonInsets*>(function_in_library(
      ROUTEBENCH_SKELETON_LIBRARY, "routebench_skeleton_insets", "CGAL's straight skeleton"));
  return *found;
}

}  // namespace

void make_ready(Method method) {
  if (method == Method::kSkeleton) static_cast<void>(loaded());
}

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
      if (points_of(polygon) <= kMostSkeletonPoints) loaded()(polygon, step_mm, context, own);
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
