#include "plan_timing.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "process_planner.hpp"

namespace routebench {
namespace {

std::int64_t now_ns(clockid_t clock) {
  std::timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

void add_time_of(const std::function<void()>& work, PlanTime& time) {
  using Clock = std::chrono::steady_clock;
  const std::int64_t cpu_begin = now_ns(CLOCK_THREAD_CPUTIME_ID);
  const Clock::time_point begin = Clock::now();
  work();
  const Clock::time_point end = Clock::now();
  time.cpu_ns += now_ns(CLOCK_THREAD_CPUTIME_ID) - cpu_begin;
  time.wall_ns += std::chrono::duration_cast<std::chrono::nanoseconds>(end - begin).count();
}

Route timed_plan(const Planner& planner, const Layer& layer, const PlanContext& context,
                 PlanTime& time) {
  if (const auto* process = dynamic_cast<const ProcessPlanner*>(&planner))
    return process->plan(layer, context, time);
  Route route;
  add_time_of([&] { route = planner.plan(layer, context); }, time);
  return route;
}

std::int64_t process_cpu_ns() { return now_ns(CLOCK_PROCESS_CPUTIME_ID); }

double peak_rss_bytes(const Planner* planner) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double ours = static_cast<double>(usage.ru_maxrss) * 1024;
  const auto* process = dynamic_cast<const ProcessPlanner*>(planner);
  return process == nullptr ? ours : std::max(ours, static_cast<double>(process->peak_rss_bytes()));
}

}  // namespace routebench
