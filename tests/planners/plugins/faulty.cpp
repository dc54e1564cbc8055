/// Plugins that must be refused: one source, built once for each ROUTEBENCH_FAULT.

#include <stdexcept>
#include <string>

#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

template <char Letter>
class Idle final : public Planner {
 public:
  struct Params {
    void bind(ParamBinder&) {}
  };
  static PlannerInfo info() {
    return {std::string("idle_") + Letter, PlannerRole::kFill, "lays nothing", ""};
  }
  explicit Idle(const Params&) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override { return {}; }
};

class BadDefault final : public Planner {
 public:
  struct Params {
    double share = 2;
    void bind(ParamBinder& bind) { bind("share", share, {0, 1}, "", "cannot be 2"); }
  };
  static PlannerInfo info() { return {"bad_default", PlannerRole::kFill, "lays nothing", ""}; }
  explicit BadDefault(const Params&) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override { return {}; }
};

enum Fault {
  kAbi,
  kBuildId,
  kNoBuildId,
  kNoFunction,
  kThrows,
  kThrowsNumber,
  kTwice,
  kNothing,
  kBadDefault,
};

void register_planners(Registry& registry) {
  if constexpr (ROUTEBENCH_FAULT == kNothing) return;
  if constexpr (ROUTEBENCH_FAULT == kBadDefault) return registry.add<BadDefault>();
  registry.add<Idle<'a'>>();
  if constexpr (ROUTEBENCH_FAULT == kThrows) throw std::runtime_error("no licence found:\nbuy one");
  if constexpr (ROUTEBENCH_FAULT == kThrowsNumber) throw 42;
  registry.add<Idle<ROUTEBENCH_FAULT == kTwice ? 'a' : 'b'>>();
}

}  // namespace

extern "C" PluginDescription routebench_plugin() {
  PluginDescription plugin{kPluginAbi, plugin_build_id(), "faulty", &register_planners};
  if constexpr (ROUTEBENCH_FAULT == kAbi) plugin.abi = kPluginAbi + 1;
  if constexpr (ROUTEBENCH_FAULT == kBuildId) plugin.build_id = "libodd++ 7";
  if constexpr (ROUTEBENCH_FAULT == kNoBuildId) plugin.build_id = nullptr;
  if constexpr (ROUTEBENCH_FAULT == kNoFunction) plugin.register_planners = nullptr;
  return plugin;
}
