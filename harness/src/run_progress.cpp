#include "run_progress.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

namespace routebench {

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 120) return std::to_string(whole) + " s";
  const long long minutes = (whole + 59) / 60;
  if (minutes < 120) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

RunProgress::RunProgress(const RunLog& log, std::string what, std::size_t steps, double weight)
    : log_(log),
      what_(std::move(what)),
      steps_(steps),
      weight_(weight),
      began_(std::chrono::steady_clock::now()) {
  show();
}

RunProgress::~RunProgress() { clear(); }

void RunProgress::step(double weight, const std::string& line, bool notable) {
  ++done_;
  weight_done_ += weight;
  if (log_.terminal) {
    clear();
    if (notable) *log_.out << line << '\n';
    show();
  } else if (!line.empty()) {
    *log_.out << '[' << done_ << '/' << steps_ << "] " << line << std::endl;
  }
}

void RunProgress::show() {
  if (!log_.terminal || done_ == steps_) return;
  const double elapsed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  *log_.out << what_ << ' ' << done_ << " of " << steps_;
  if (weight_done_ > 0)
    *log_.out << ", about " << duration_text(elapsed_s * std::max(0.0, weight_ / weight_done_ - 1))
              << " to go";
  log_.out->flush();
}

void RunProgress::clear() {
  if (log_.terminal) *log_.out << "\r\x1b[K" << std::flush;
}

}  // namespace routebench
