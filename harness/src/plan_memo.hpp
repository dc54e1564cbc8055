#pragma once
/// What has been planned in a job already.

#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "routebench/planning/planner.hpp"

namespace routebench {

/// Routes of regions, for those that come again on other layers of the same job: one contender, one
/// task, one model. May be asked from any thread.
class PlanMemo {
 public:
  /// The route that was kept for an equal region, from an equal start, at an equal density, a
  /// multiple of the planner's period_layers away; nothing if there is none.
  /// Cost   linear in the region's vertices, and in those of the route.
  [[nodiscard]] std::optional<Route> find(const Planner& planner, const Layer& part,
                                          const PlanContext& context);

  /// Takes a planner with a period.
  void keep(const Planner& planner, const Layer& part, const PlanContext& context,
            const Route& route);

 private:
  struct Entry {
    const Planner* planner;
    int phase;  ///< the layer's index, of those in a period
    double height_mm;
    Point2 start;
    double density;
    Polygons region;
    Route route;
  };
  using Entries = std::unordered_multimap<std::uint64_t, Entry>;

  std::mutex mutex_;
  Entries entries_;  ///< never erased
};

}  // namespace routebench
