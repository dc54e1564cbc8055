/// A plugin that does as no plugin should while it is loaded: one source, built once for each
/// ROUTEBENCH_CRIME.

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

enum Crime { kThrows, kExits, kAborts, kCrashes, kHangs };

bool commit(Crime crime) {
  switch (crime) {
    case kThrows:
      throw std::runtime_error("thrown before main");
    case kExits:
      _exit(0);
    case kAborts:
      std::abort();
    case kCrashes:
      std::raise(SIGSEGV);
      break;
    case kHangs:
      while (true) sleep(1);
  }
  return true;
}

const bool kCommitted = commit(ROUTEBENCH_CRIME);

class Idle final : public Planner {
 public:
  struct Params {
    void bind(ParamBinder&) {}
  };
  static PlannerInfo info() { return {"idle", PlannerRole::kFill, "lays nothing", ""}; }
  explicit Idle(const Params&) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override { return {}; }
};

}  // namespace

ROUTEBENCH_REGISTER(spoilt) {
  if (kCommitted) registry.add<Idle>();
}
