#pragma once
/// How long plan() takes.

#include <cstdint>
#include <functional>

#include "routebench/harness/contender.hpp"

namespace routebench {

/// Does work once and adds the time that it took; nothing if it throws.
void add_time_of(const std::function<void()>& work, PlanTime& time);

/// Calls plan() once and adds the time that it took; nothing if it throws. A planner that is a
/// program of its own is timed as ProcessPlanner says.
[[nodiscard]] Route timed_plan(const Planner& planner, const Layer& layer,
                               const PlanContext& context, PlanTime& time);

/// What all threads of this process have taken so far.
[[nodiscard]] std::int64_t process_cpu_ns();

/// The most memory that planning has taken so far: of this process, or of the planner's own if that
/// took more.
[[nodiscard]] double peak_rss_bytes(const Planner* planner = nullptr);

}  // namespace routebench
