/// The gate: whether a route did its task.

#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

#include "routebench/geometry/error.hpp"
#include "routebench/harness/judge.hpp"

namespace routebench {
namespace {

std::string shortest(double value, int digits) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::general, digits)
                       .ptr;
  return {text.data(), end};
}

/// "covered 0.91 < 0.95", with as many digits as it takes to tell the two apart.
std::string miss(std::string_view name, double value, char relation, double limit) {
  constexpr int kMostDigits = 17;
  int digits = 3;
  while (digits < kMostDigits && shortest(value, digits) == shortest(limit, digits)) ++digits;
  return std::string(name) + " " + shortest(value, digits) + " " + relation + " " +
         shortest(limit, digits);
}

/// Collects the limits that are missed. A metric that does not apply misses none.
class Misses {
 public:
  explicit Misses(const Scores& totals) : totals_(totals) {}

  [[nodiscard]] std::optional<double> value(std::string_view name) const {
    return totals_.at(metric_index(name));
  }

  void at_least(std::string_view name, double limit) {
    if (const std::optional<double> v = value(name); v && !(*v >= limit))
      add(miss(name, *v, '<', limit));
  }
  void at_most(std::string_view name, double limit) {
    if (const std::optional<double> v = value(name); v && !(*v <= limit))
      add(miss(name, *v, '>', limit));
  }

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  void add(const std::string& reason) { text_ += (text_.empty() ? "" : "; ") + reason; }

  const Scores& totals_;
  std::string text_;
};

}  // namespace

std::span<const Outcome> outcomes() {
  using enum Outcome;
  static constexpr std::array kAll{kValid,    kOffTask,     kFailed,      kCrashed,
                                   kTimedOut, kOutOfMemory, kNotInstalled};
  return kAll;
}

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kValid:
      return "valid";
    case Outcome::kOffTask:
      return "off_task";
    case Outcome::kFailed:
      return "failed";
    case Outcome::kCrashed:
      return "crashed";
    case Outcome::kTimedOut:
      return "timed_out";
    case Outcome::kOutOfMemory:
      return "out_of_memory";
    case Outcome::kNotInstalled:
      return "not_installed";
  }
  throw Error(ErrorKind::kInternal, "an outcome without a name");
}

Verdict Judge::verdict(const Scores& totals) const {
  const GateLimits& gate = task_.gate;
  Misses misses(totals);
  misses.at_least("covered", gate.covered_min);
  misses.at_most("skipped", gate.skipped_max);
  misses.at_most("worst_layer", gate.worst_layer_max);
  misses.at_least("deposit", gate.deposit_min);
  misses.at_most("deposit", gate.deposit_max);
  if (task_.perimeters > 0) misses.at_least("outline_covered", gate.outline_covered_min);
  misses.at_most("spilled", gate.spilled_max);
  misses.at_most("doubled", gate.doubled_max);
  misses.at_most("hollow_mm", gate.hollow_share_max * misses.value("extrude_mm").value_or(0));
  if (misses.text().empty()) return {};
  return {Outcome::kOffTask, misses.text()};
}

}  // namespace routebench
