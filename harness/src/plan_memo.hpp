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
  /// What the route of a region depends on, beside the region and what is the same in all the job.
  struct Question {
    const Planner* planner;
    int phase;  ///< the layer's index modulo PlannerInfo::repeats_every
    double height_mm;
    Point2 start;
    double density;
    friend bool operator==(const Question&, const Question&) = default;
  };

  /// The route that was kept for an equal region and question; nothing if there is none.
  /// Cost   linear in the region's vertices, and in those of the route.
  [[nodiscard]] std::optional<Route> find(const Question& question, const Polygons& region);
  void keep(const Question& question, const Polygons& region, const Route& route);

 private:
  struct Entry {
    Question question;
    Polygons region;
    Route route;
  };

  std::mutex mutex_;
  std::unordered_multimap<std::uint64_t, Entry> entries_;  ///< by a hash of the region
};

}  // namespace routebench
