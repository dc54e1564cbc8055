#pragma once
/// Tests that run experiments of cheap cells in this process.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "culprit.hpp"
#include "database_content.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/runner.hpp"
#include "scratch_dir.hpp"

namespace routebench::test {

namespace fs = std::filesystem;

/// Four layers, each a square of some size.
inline std::string squares_wkt(double side_mm) {
  std::ostringstream text;
  for (int i = 0; i < 4; ++i) {
    const double z = 0.1 + 0.2 * i;
    text << "MULTIPOLYGON Z (((";
    for (const Point2 p : {Point2{0, 0}, Point2{side_mm, 0}, Point2{side_mm, side_mm},
                           Point2{0, side_mm}, Point2{0, 0}})
      text << (p == Point2{0, 0} && text.str().back() == '(' ? "" : ", ") << p.x << ' ' << p.y
           << ' ' << z;
    text << ")))\n";
  }
  return text.str();
}

inline std::string hatch_contender(const std::string& name, const std::string& params = "") {
  return "[[contender]]\nname = \"" + name + "\"\nfill = { planner = \"hatch\"" + params + " }\n";
}

inline std::string culprit_contender(const std::string& crime) {
  return "[[contender]]\nname = \"" + crime + "\"\nfill = { planner = \"culprit\", crime = \"" +
         crime + "\" }\n";
}

/// A folder with models, configs and results.
class RunnerTest : public testing::Test {
 protected:
  void SetUp() override {
    dir_.write("small.wkt", squares_wkt(8));
    dir_.write("large.wkt", squares_wkt(12));
    planners_.registry.add<test::Hatch>();
    planners_.registry.add<test::Culprit>();
    options_.out = dir_.path() / "out";
    options_.jobs = 1;
  }

  /// A config over both squares, walls and sparse fill left out.
  [[nodiscard]] ExperimentConfig config(
      const std::string& contenders, const std::string& run = "repetitions = 1",
      const std::string& more = "", const std::string& models = "\"small.wkt\", \"large.wkt\"") {
    return parse_config("name = \"t\"\nmodels = [" + models + "]\n" + more +
                            "[task]\nperimeters = 0\ndensity = 1\n[run]\n" + run + "\n" +
                            contenders,
                        dir_.path() / "t.toml");
  }

  RunSummary execute(const ExperimentConfig& config) {
    log_.str("");
    return run_experiment(config, planners_, options_, {&log_, ProgressForm::kLines});
  }

  [[nodiscard]] fs::path file() const { return options_.out / "results.sqlite"; }
  [[nodiscard]] std::vector<StoredCell> cells() const { return current_cells(file()); }
  [[nodiscard]] StoredCell cell(const std::string& contender, const std::string& model) const {
    for (const StoredCell& cell : cells())
      if (cell.contender == contender && cell.model == model) return cell;
    ADD_FAILURE() << "no cell of " << contender << " on " << model;
    return {};
  }

  [[nodiscard]] std::vector<std::string> content() const { return current_content(file()); }

  [[nodiscard]] std::string complaint(const ExperimentConfig& config) {
    try {
      execute(config);
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }

  ScratchDir dir_;
  PlannerSet planners_;
  RunnerOptions options_;
  std::ostringstream log_;
};

/// A run in a process of its own, as the program would make it.
inline pid_t run_elsewhere(const ExperimentConfig& config, const PlannerSet& planners,
                           const RunnerOptions& options) {
  const pid_t process = fork();
  if (process == 0) {
    std::ostringstream log;
    try {
      _exit(run_experiment(config, planners, options, {&log}).interrupted ? 130 : 0);
    } catch (const std::exception&) {
      _exit(3);
    }
  }
  return process;
}

}  // namespace routebench::test
