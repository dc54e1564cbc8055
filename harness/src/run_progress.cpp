#include "run_progress.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

#include "json_parts.hpp"

namespace routebench {

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole < 120) return std::to_string(whole) + " s";
  const long long minutes = (whole + 59) / 60;
  if (minutes < 120) return std::to_string(minutes) + " min";
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
}

namespace {

constexpr std::chrono::seconds kQuietEvents{1};

void write_line(const RunLog& log, const Json& event) {
  *log.out << text_of(event, true) << std::endl;
}

std::string line_of(const StepNews& news) {
  const std::string line = news.cell + ": " + std::string(to_string(news.outcome));
  return news.reason.empty() ? line : line + " (" + news.reason + ")";
}

/// Milliseconds are enough for anybody who waits.
double rounded(double seconds) { return std::round(seconds * 1e3) / 1e3; }

}  // namespace

void tell(const RunLog& log, const std::string& text) {
  if (log.form == ProgressForm::kJson)
    write_line(log, {{"event", "note"}, {"text", text}});
  else if (log.form != ProgressForm::kNone)
    *log.out << text << std::endl;
}

void tell_redo(const RunLog& log, const std::string& cell, const std::string& why) {
  if (log.form == ProgressForm::kJson)
    write_line(log, {{"event", "redo"}, {"cell", cell}, {"why", why}});
  else
    tell(log, "redoing " + cell + ": " + why);
}

RunProgress::RunProgress(const RunLog& log, std::string what, std::size_t steps, double weight)
    : log_(log),
      what_(std::move(what)),
      steps_(steps),
      weight_(weight),
      began_(Clock::now()),
      last_quiet_event_(began_) {
  show_bar();
}

RunProgress::~RunProgress() { clear_bar(); }

double RunProgress::elapsed_s() const {
  return std::chrono::duration<double>(Clock::now() - began_).count();
}

std::optional<double> RunProgress::to_go_s() const {
  if (weight_done_ <= 0) return std::nullopt;
  return elapsed_s() * std::max(0.0, weight_ / weight_done_ - 1);
}

void RunProgress::step(double weight, const StepNews& news) {
  ++done_;
  weight_done_ += weight;
  switch (log_.form) {
    case ProgressForm::kBar:
      clear_bar();
      if (news.outcome != Outcome::kValid) *log_.out << line_of(news) << '\n';
      show_bar();
      break;
    case ProgressForm::kLines:
      if (!news.cell.empty())
        *log_.out << '[' << done_ << '/' << steps_ << "] " << line_of(news) << std::endl;
      break;
    case ProgressForm::kJson:
      write_json(news);
      break;
    case ProgressForm::kNone:
      break;
  }
}

void RunProgress::write_json(const StepNews& news) {
  if (news.cell.empty()) {
    // Who was told of some is told of the last one, too.
    const bool is_end = done_ == steps_ && told_;
    const Clock::time_point now = Clock::now();
    if (!is_end && now - last_quiet_event_ < kQuietEvents) return;
    last_quiet_event_ = now;
  }
  told_ = true;
  const std::optional<double> to_go = to_go_s();
  Json event = {{"event", "progress"},
                {"what", what_},
                {"done", done_},
                {"steps", steps_},
                {"elapsed_s", rounded(elapsed_s())},
                {"to_go_s", to_go ? Json(rounded(*to_go)) : Json(nullptr)}};
  if (!news.cell.empty()) {
    event["cell"] = news.cell;
    event["outcome"] = to_string(news.outcome);
    event["reason"] = news.reason;
  }
  write_line(log_, event);
}

void RunProgress::show_bar() {
  if (log_.form != ProgressForm::kBar || done_ == steps_) return;
  *log_.out << what_ << ' ' << done_ << " of " << steps_;
  if (const std::optional<double> to_go = to_go_s())
    *log_.out << ", about " << duration_text(*to_go) << " to go";
  log_.out->flush();
}

void RunProgress::clear_bar() {
  if (log_.form == ProgressForm::kBar) *log_.out << "\r\x1b[K" << std::flush;
}

}  // namespace routebench
