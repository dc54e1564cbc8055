#pragma once
/// Regions at growing distances from the boundary.

#include <cstddef>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::concentric {

/// How insets are computed.
enum class Method {
  kClipper,  ///< one after the other, by an integer polygon clipper
  kSkeleton  ///< all further ones from a straight skeleton of the first
};

/// Loads what a method needs, so that no planning has to wait for it. Throws   Error{kInternal}.
void make_ready(Method method);

/// What lies at least first_mm, first_mm + step_mm, ... from the boundary (with mitred corners),
/// until nothing is left. Throws   Error{kStopped}.
/// Cost   clipper: n log n for each inset; skeleton: n log n to n^2 once, then linear for each.
[[nodiscard]] std::vector<Polygons> insets(const Polygons& polygons, double first_mm,
                                           double step_mm, Method method,
                                           const PlanContext& context);

/// Above so many points of a polygon no skeleton is built. The time grows with the power 1.8 of
/// them, and CGAL cannot be stopped: these take it some tenths of a second.
inline constexpr std::size_t kMostSkeletonPoints = 500;

/// The same, all but the first inset from straight skeletons of the polygons of that. Where one
/// cannot be built, or would take too long, the clipper's.
[[nodiscard]] std::vector<Polygons> skeleton_insets(const Polygons& polygons, double first_mm,
                                                    double step_mm, const PlanContext& context);

}  // namespace routebench::concentric
