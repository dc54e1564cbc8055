#pragma once
/// Planning relative to the model's corner, so that moving everything by a grid vector moves the
/// route exactly.

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

/// A layer's polygons and the nozzle's place as seen from context.origin. Differences of grid
/// coordinates are exact, so what is computed in the frame does not depend on where the model
/// stands.
class Frame {
 public:
  Frame(const Layer& layer, const PlanContext& context);

  [[nodiscard]] const Polygons& polygons() const noexcept { return polygons_; }
  [[nodiscard]] Point2 start() const noexcept { return start_; }

  /// The route as the printer sees it; exact.
  [[nodiscard]] Route from_frame(Route route) const;

 private:
  Point2 origin_;
  Point2 start_;
  Polygons polygons_;
};

}  // namespace routebench
