/// The export for OMPL's Planner Arena.

#include <cstdlib>

#include "runner_fixture.hpp"

namespace routebench {
namespace {

using test::culprit_contender;
using test::hatch_contender;
using test::rows_of;

class OmplExport : public test::RunnerTest {
 protected:
  std::filesystem::path exported(const ExperimentConfig& config) {
    execute(config);
    return export_ompl(file(), options_.out / "ompl");
  }
};

std::vector<std::string> columns(const std::filesystem::path& file, const std::string& table) {
  return rows_of(file, "SELECT name FROM pragma_table_info('" + table + "')");
}

TEST_F(OmplExport, HasTheTablesAndColumnsThatPlannerArenaAsksFor) {
  const auto file = exported(config(hatch_contender("a"), "repetitions = 2"));
  EXPECT_EQ(file, options_.out / "ompl" / "benchmark.db");
  EXPECT_EQ(
      columns(file, "experiments"),
      (std::vector<std::string>{"id", "name", "totaltime", "timelimit", "memorylimit", "runcount",
                                "version", "hostname", "cpuinfo", "date", "seed", "setup"}));
  EXPECT_EQ(columns(file, "plannerConfigs"), (std::vector<std::string>{"id", "name", "settings"}));
  EXPECT_EQ(columns(file, "enums"), (std::vector<std::string>{"name", "value", "description"}));
  EXPECT_EQ(columns(file, "progress"), (std::vector<std::string>{"runid", "time", "best_cost"}));
  const std::vector<std::string> runs = columns(file, "runs");
  ASSERT_GT(runs.size(), 20u);
  EXPECT_EQ(std::vector<std::string>(runs.begin(), runs.begin() + 4),
            (std::vector<std::string>{"id", "experimentid", "plannerid", "time"}));
  // Its plots ask for the declared type of every column.
  EXPECT_EQ(rows_of(file, "SELECT DISTINCT type FROM pragma_table_info('runs') ORDER BY 1"),
            (std::vector<std::string>{"BOOLEAN", "ENUM", "INTEGER", "REAL"}));
}

TEST_F(OmplExport, ARunIsASampleAndWhatIsNotValidHasNoMeasure) {
  const auto file =
      exported(config(hatch_contender("a") + culprit_contender("skip") + culprit_contender("throw"),
                      "repetitions = 3\ntimeout_s = 50\nmemory_mb = 500"));
  EXPECT_EQ(rows_of(file, "SELECT name, runcount, timelimit, memorylimit FROM experiments"),
            (std::vector<std::string>{"small.wkt|1|50.0|500.0", "large.wkt|1|50.0|500.0"}));
  EXPECT_EQ(rows_of(file, "SELECT value, description FROM enums WHERE name = 'status' ORDER BY 1"),
            (std::vector<std::string>{"0|valid", "1|failed", "2|off_task"}));
  const std::string by_planner =
      "SELECT plannerConfigs.name, description, count(*), count(time), count(memory),"
      " count(travel_mm), count(DISTINCT travel_mm), min(solved), max(correct_solution) FROM runs"
      " JOIN plannerConfigs ON plannerid = plannerConfigs.id JOIN enums ON enums.value = status"
      " GROUP BY plannerid ORDER BY plannerid";
  EXPECT_EQ(rows_of(file, by_planner),
            (std::vector<std::string>{"a|valid|6|6|6|6|2|1|1", "skip|off_task|6|0|0|0|0|1|0",
                                      "throw|failed|2|0|0|0|0|0|0"}));
  const auto ours = rows_of(this->file(),
                            "SELECT plan_wall_ns / 1e9 FROM timing_sample JOIN cell USING(cell_id)"
                            " JOIN contender USING(contender_id) WHERE name = 'a' ORDER BY 1");
  EXPECT_EQ(rows_of(file, "SELECT time FROM runs WHERE time IS NOT NULL ORDER BY 1"), ours);
  EXPECT_EQ(rows_of(file, "PRAGMA foreign_key_check"), std::vector<std::string>{});
}

TEST_F(OmplExport, SweptKeysAreParametersOfTheProblem) {
  const auto file = exported(parse_config(
      "name = \"t\"\nmodels = [\"small.wkt\"]\n[task]\nperimeters = 0\ndensity = [0.5, 1]\n"
      "[printer]\nretract_policy = [\"length\", \"manhattan\"]\n[run]\nrepetitions = 1\n" +
          hatch_contender("a"),
      dir_.path() / "t.toml"));
  EXPECT_EQ(rows_of(file, "SELECT name, density, retract_policy FROM experiments ORDER BY id"),
            (std::vector<std::string>{"small.wkt|0.5|length", "small.wkt|0.5|manhattan",
                                      "small.wkt|1.0|length", "small.wkt|1.0|manhattan"}));
  EXPECT_EQ(columns(file, "experiments").size(), 14u);
}

TEST_F(OmplExport, EqualDatabasesGiveEqualBytes) {
  const auto file = exported(config(hatch_contender("a")));
  const std::string first = test::text_of_file(file);
  EXPECT_EQ(test::text_of_file(export_ompl(this->file(), dir_.path() / "elsewhere")), first);
}

}  // namespace
}  // namespace routebench
