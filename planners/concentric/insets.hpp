#pragma once
/// Regions at growing distances from the boundary.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::concentric {

/// How insets are computed.
enum class Method {
  kClipper,  ///< one after the other, by an integer polygon clipper
  kSkeleton  ///< all from one straight skeleton of the region
};

/// What lies at least first_mm, first_mm + step_mm, ... from the boundary (with mitred corners),
/// until nothing is left. Throws   Error{kStopped}.
/// Cost   clipper: n log n for each inset; skeleton: n log n to n^2 once, then linear for each.
[[nodiscard]] std::vector<Polygons> insets(const Polygons& polygons, double first_mm,
                                           double step_mm, Method method,
                                           const PlanContext& context);

/// The same from straight skeletons; where one cannot be built, the clipper's.
[[nodiscard]] std::vector<Polygons> skeleton_insets(const Polygons& polygons, double first_mm,
                                                    double step_mm, const PlanContext& context);

}  // namespace routebench::concentric
