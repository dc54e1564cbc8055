/// What every planner promises (planner.hpp), for every planner that is compiled in, the example
/// plugins, and every plugin named in the environment variable ROUTEBENCH_PLUGINS (files, separated
/// by ':'): the checks of `routebench check-planner`.

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "routebench/harness/conformance.hpp"
#include "routebench/planning/plugin.hpp"

namespace routebench {

void PrintTo(const TrialLayer& layer, std::ostream* out) { *out << layer.name; }
void PrintTo(const ConformanceCheck& check, std::ostream* out) { *out << check.promise; }

namespace {

/// Built-in planners and plugins, and what went wrong with the latter.
struct Planners {
  Registry registry;
  std::vector<PluginRecord> plugins;
};

const Planners& planners() {
  static const Planners all = [] {
    Planners found;
    register_builtin_planners(found.registry);
    for (const char* example : {"boustrophedon", "fermat_spirals"})
      found.plugins.push_back(load_plugin(
          found.registry, std::string(ROUTEBENCH_TEST_PLUGINS) + "/" + example + ".so"));
    const char* files = std::getenv("ROUTEBENCH_PLUGINS");
    std::istringstream list(files != nullptr ? files : "");
    for (std::string file; std::getline(list, file, ':');)
      if (!file.empty()) found.plugins.push_back(load_plugin(found.registry, file));
    return found;
  }();
  return all;
}

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const auto& [name, entry] : planners().registry.entries()) names.push_back(name);
  return names;
}

class Contract
    : public testing::TestWithParam<std::tuple<std::string, ConformanceCheck, TrialLayer>> {};

TEST_P(Contract, IsKept) {
  const auto& [planner, check, layer] = GetParam();
  const std::optional<Breach> breach = check.breach(planners().registry, planner, layer);
  EXPECT_FALSE(breach) << "with " << breach->params << ": " << breach->complaint;
}

INSTANTIATE_TEST_SUITE_P(AllPlanners, Contract,
                         testing::Combine(testing::ValuesIn(planner_names()),
                                          testing::ValuesIn(conformance_checks()),
                                          testing::ValuesIn(trial_layers())),
                         [](const auto& test) {
                           return std::get<0>(test.param) + "_" + std::get<1>(test.param).name +
                                  "_" + std::get<2>(test.param).name;
                         });

TEST(ContractSetup, EveryNamedPluginIsThere) {
  for (const PluginRecord& plugin : planners().plugins)
    EXPECT_TRUE(plugin.loaded) << plugin.file << ": " << plugin.refused_because;
}

}  // namespace
}  // namespace routebench
