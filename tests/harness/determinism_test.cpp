/// Every planner makes the same routes whenever it is asked, in whatever process and beside
/// whatever else.

#include <algorithm>
#include <set>

#include "database_content.hpp"
#include "program.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {
namespace {

using test::ProgramRun;

/// Two layers: a plate with two holes, a neck, a slanted edge and a slot; and an island that tapers
/// to nothing.
constexpr const char* kLayers =
    "MULTIPOLYGON Z (((0 0 0.1, 14 0 0.1, 14 5 0.1, 16 5.3 0.1, 16 12 0.1, 5 11 0.1, 4.6 6 0.1, 4 6"
    " 0.1, 3.9 11 0.1, 0 8 0.1, 0 0 0.1), (2 2 0.1, 2 4 0.1, 3 4.5 0.1, 4 2 0.1, 2 2 0.1), (8 3 "
    "0.1,"
    " 8 7 0.1, 12 7 0.1, 12 3 0.1, 8 3 0.1)), ((18 0 0.1, 21 0 0.1, 19 9 0.1, 18 0 0.1)))\n"
    "MULTIPOLYGON Z (((0 0 0.3, 14 0 0.3, 14 5 0.3, 15.9 5.2 0.3, 16 12 0.3, 5 11 0.3, 4.6 6 0.3, 4"
    " 6 0.3, 3.9 11 0.3, 0 8 0.3, 0 0 0.3), (8 3 0.3, 8 7 0.3, 12 7 0.3, 12 3 0.3, 8 3 0.3)))\n";

/// The defaults, and every choice and switch that is not the default, each alone.
std::vector<std::string> variants_of(const Registry::Entry& entry) {
  std::vector<std::string> variants{""};
  for (const ParamSchema& param : entry.params) {
    const std::string standard = to_string(param.default_value);
    if (param.type == ParamType::kBool)
      variants.push_back(", " + param.name + " = " + (standard == "true" ? "false" : "true"));
    for (const std::string& choice : param.choices)
      if (choice != standard) variants.push_back(", " + param.name + " = \"" + choice + "\"");
  }
  return variants;
}

class Determinism : public test::ProgramTest {};

TEST_F(Determinism, TwentyRunsWithOneJobAndWithTwoMakeTheSameRoutes) {
  constexpr int kRepeats = 20;
  Registry registry;
  register_builtin_planners(registry);
  std::string config =
      "name = \"t\"\nmodels = [\"layers.wkt\"]\n[task]\nperimeters = 1\ndensity = 0.5\n"
      "skin_layers = 1\n[run]\nrepetitions = 1\nkeep_layers = \"none\"\n";
  std::size_t contenders = 0;
  for (const auto& [name, entry] : registry.entries())
    for (const std::string& variant : variants_of(entry))
      config += "[[contender]]\nname = \"" + std::to_string(++contenders) + " " + name + "\"\n" +
                (entry.info.role == PlannerRole::kShell ? "shell" : "fill") + " = { planner = \"" +
                name + "\"" + variant + " }\n";
  ASSERT_GE(contenders, 5 * registry.entries().size()) << "several variants of each";
  std::ofstream(in_folder("layers.wkt")) << kLayers;
  std::ofstream(in_folder("t.toml")) << config;

  std::set<std::string> expected;
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (const std::string jobs : {"1", "2"}) {
      const ProgramRun run = call({"run", in_folder("t.toml"), "--out", in_folder("out"), "--fresh",
                                   "--progress", "none", "--jobs", jobs});
      ASSERT_LE(run.exit_code, 1) << run.err;
      const std::vector<std::string> rows =
          test::rows_of(folder_ / "out" / "results.sqlite",
                        "SELECT name, variant_json, outcome, route_hash FROM cell JOIN contender"
                        " USING(contender_id)");
      const std::set<std::string> routes(rows.begin(), rows.end());
      ASSERT_EQ(routes.size(), contenders);
      if (expected.empty()) {
        expected = routes;
        for (const std::string& row : rows)
          EXPECT_FALSE(row.ends_with("NULL")) << "no route: " << row;
      }
      ASSERT_EQ(routes, expected) << "repeat " << repeat << " with " << jobs << " jobs";
    }
}

}  // namespace
}  // namespace routebench
