#pragma once
/// What has been planned in a job already.

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "routebench/planning/planner.hpp"

namespace routebench {

/// Routes of regions, for those that come again on other layers of the same job: one contender, one
/// task, one model. May be asked from any thread.
class PlanMemo {
 public:
  /// What the route of a region depends on, beside the region and what is the same in all the job.
  struct Question {
    const void* planner;  ///< tells one from the other
    int phase;            ///< the layer's index modulo PlannerInfo::repeats_every
    double height_mm;
    Point2 start;
    double density;
    friend bool operator==(const Question&, const Question&) = default;
  };

  /// The route of a region: plans it unless an equal region has been planned for an equal question.
  /// Who asks for what another thread is planning sleeps until that is done, or plans it itself if
  /// that has failed; so `plan` must not ask the memo.
  /// Throws what plan throws.
  /// Cost   linear in the region's vertices.
  [[nodiscard]] std::shared_ptr<const Route> route(const Question& question, const Polygons& region,
                                                   const std::function<Route()>& plan);

 private:
  struct Entry {
    Question question;
    Polygons region;
    std::mutex planning;
    std::shared_ptr<const Route> route;  ///< nothing until it is planned
  };

  Entry& entry_of(const Question& question, const Polygons& region);

  std::mutex mutex_;
  std::unordered_multimap<std::uint64_t, std::unique_ptr<Entry>> entries_;  ///< by region's hash
};

}  // namespace routebench
