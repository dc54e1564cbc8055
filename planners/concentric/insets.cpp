#include "insets.hpp"

#include <utility>

#include "routebench/geometry/region.hpp"

namespace routebench::concentric {

std::vector<Polygons> insets(const Polygons& polygons, double first_mm, double step_mm,
                             Method method, const PlanContext& context) {
  if (method == Method::kSkeleton) return skeleton_insets(polygons, first_mm, step_mm, context);
  std::vector<Polygons> all;
  double inset_mm = first_mm;
  // From one to the next: an offset by many steps at once is far slower.
  for (Polygons inner = offset(polygons, -inset_mm); !inner.empty();
       inner = offset(all.back(), -inset_mm)) {
    stop_if_asked(context);
    all.push_back(std::move(inner));
    inset_mm = step_mm;
  }
  return all;
}

}  // namespace routebench::concentric
