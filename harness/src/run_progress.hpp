#pragma once
/// What a run tells people, or programs, while it goes on.

#include <chrono>
#include <optional>
#include <string>

#include "routebench/harness/runner.hpp"

namespace routebench {

/// A line for people: {"event": "note", "text": ...} as JSON, nothing where nothing is wanted.
void tell(const RunLog& log, const std::string& text);

/// The event {"event": "redo", "cell": ..., "why": ...}, or a line that says the same.
void tell_redo(const RunLog& log, const std::string& cell, const std::string& why);

/// What there is to tell of a step.
struct StepNews {
  std::string cell;  ///< empty: nothing but that it is done
  Outcome outcome = Outcome::kValid;
  std::string reason;
};

/// Steps of one kind.
///
/// As a bar: one line with the time to go that is written over; of the steps' news only that which
/// is not valid stays. As lines: one a step that has news. As JSON: one object a step, for steps
/// without news at most one a second, so that what is quick says nothing: event, what, done, steps,
/// elapsed_s, to_go_s (null if it is not known) and, with news, cell, outcome, reason.
class RunProgress {
 public:
  /// Takes what the steps are called, and the sum of their weights; a step's weight is its expected
  /// share of the time.
  RunProgress(const RunLog& log, std::string what, std::size_t steps, double weight);
  ~RunProgress();
  RunProgress(const RunProgress&) = delete;
  RunProgress& operator=(const RunProgress&) = delete;

  void step(double weight, const StepNews& news);

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] double elapsed_s() const;
  [[nodiscard]] std::optional<double> to_go_s() const;
  void show_bar();
  void clear_bar();
  void write_json(const StepNews& news);

  RunLog log_;
  std::string what_;
  std::size_t steps_;
  std::size_t done_ = 0;
  double weight_;
  double weight_done_ = 0;
  Clock::time_point began_;
  Clock::time_point last_quiet_event_;
  bool told_ = false;  ///< an event of this kind
};

/// "3 s", "12 min", "2 h 5 min".
[[nodiscard]] std::string duration_text(double seconds);

}  // namespace routebench
