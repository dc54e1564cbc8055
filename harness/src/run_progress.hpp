#pragma once
/// What a run tells people while it goes on.

#include <chrono>
#include <string>

#include "routebench/harness/runner.hpp"

namespace routebench {

/// Steps of one kind, with the time to go on a terminal. Elsewhere a line a step, if it has one.
class RunProgress {
 public:
  /// Takes what the steps are called, and the sum of their weights; a step's weight is its expected
  /// share of the time.
  RunProgress(const RunLog& log, std::string what, std::size_t steps, double weight);
  ~RunProgress();
  RunProgress(const RunProgress&) = delete;
  RunProgress& operator=(const RunProgress&) = delete;

  /// A step is done. `line` is shown on a terminal only if it is `notable`.
  void step(double weight, const std::string& line, bool notable);

 private:
  void show();
  void clear();

  RunLog log_;
  std::string what_;
  std::size_t steps_;
  std::size_t done_ = 0;
  double weight_;
  double weight_done_ = 0;
  std::chrono::steady_clock::time_point began_;
};

/// "3 s", "12 min", "2 h 5 min".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace routebench
