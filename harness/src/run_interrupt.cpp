#include "run_interrupt.hpp"

#include <ctime>
#include <initializer_list>

namespace routebench {

InterruptWatch::InterruptWatch() {
  sigemptyset(&watched_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&watched_, signal);
  sigprocmask(SIG_BLOCK, &watched_, &before_);
}

InterruptWatch::~InterruptWatch() { sigprocmask(SIG_SETMASK, &before_, nullptr); }

bool InterruptWatch::interrupted() {
  const timespec at_once{};
  if (sigtimedwait(&watched_, nullptr, &at_once) > 0) interrupted_ = true;
  return interrupted_;
}

}  // namespace routebench
