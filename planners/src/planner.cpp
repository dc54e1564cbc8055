#include "routebench/planning/planner.hpp"

#include "routebench/geometry/error.hpp"

namespace routebench {

Planner::~Planner() = default;

void stop_if_asked(const PlanContext& context) {
  if (context.stop.stop_requested()) throw Error(ErrorKind::kStopped, "stopped as asked");
}

}  // namespace routebench
