#pragma once
/// Ctrl-C as a question instead of an end.

#include <signal.h>

namespace routebench {

/// While it lives, SIGINT, SIGTERM and SIGHUP wait to be asked for. Signals that were neither
/// asked for nor taken act when it is gone.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// Takes a waiting signal, if there is one.
  [[nodiscard]] bool interrupted();

 private:
  sigset_t watched_{};
  sigset_t before_{};
  bool interrupted_ = false;
};

}  // namespace routebench
