#include "routebench/harness/runner.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "culprit.hpp"
#include "routebench/geometry/error.hpp"
#include "scratch_dir.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::ScratchDir;

/// Four layers, each a square of some size.
std::string squares_wkt(double side_mm) {
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

std::string hatch_contender(const std::string& name, const std::string& params = "") {
  return "[[contender]]\nname = \"" + name + "\"\nfill = { planner = \"hatch\"" + params + " }\n";
}

std::string culprit_contender(const std::string& crime) {
  return "[[contender]]\nname = \"" + crime + "\"\nfill = { planner = \"culprit\", crime = \"" +
         crime + "\" }\n";
}

/// A folder with models, configs and results.
class Runner : public testing::Test {
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
    return run_experiment(config, planners_, options_, {&log_, false});
  }

  [[nodiscard]] fs::path file() const { return options_.out / "results.sqlite"; }
  [[nodiscard]] std::vector<StoredCell> cells() const { return current_cells(file()); }
  [[nodiscard]] StoredCell cell(const std::string& contender, const std::string& model) const {
    for (const StoredCell& cell : cells())
      if (cell.contender == contender && cell.model == model) return cell;
    ADD_FAILURE() << "no cell of " << contender << " on " << model;
    return {};
  }

  /// What may depend on neither the number of jobs nor on interruptions: all but times and memory.
  [[nodiscard]] std::vector<std::string> scores() const {
    std::vector<std::string> lines;
    for (const StoredCell& cell : cells()) {
      std::ostringstream line;
      line.precision(17);
      line << cell.model << '|' << cell.contender << '|' << cell.setting << '|' << cell.seed << '|'
           << to_string(cell.outcome) << '|' << cell.reason;
      for (std::size_t i = 0; i < cell.totals.size(); ++i) {
        const std::string_view name = metric_table()[i].name;
        if (name == "plan_wall_ns" || name == "plan_cpu_ns" || name == "peak_rss_bytes") continue;
        line << '|' << cell.totals[i].value_or(-1e300);
      }
      lines.push_back(line.str());
    }
    std::sort(lines.begin(), lines.end());
    return lines;
  }

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

TEST_F(Runner, EveryCellIsExecutedAndScored) {
  const RunSummary summary =
      execute(config(hatch_contender("zigzag") + hatch_contender("one way", ", zigzag = false")));
  EXPECT_EQ(summary.executed, 4u);
  EXPECT_EQ(summary.found, 0u);
  EXPECT_EQ(summary.file, file());
  ASSERT_EQ(cells().size(), 4u);
  for (const StoredCell& cell : cells()) {
    EXPECT_EQ(cell.outcome, Outcome::kValid) << cell.reason;
    EXPECT_EQ(cell.layers, 4u);
    EXPECT_GT(cell.totals.at(metric_index("plan_wall_ns")).value_or(0), 0);
    EXPECT_GT(cell.totals.at(metric_index("peak_rss_bytes")).value_or(0), 1e5);
  }
  const auto travel = [&](const char* contender) {
    return *cell(contender, "small.wkt").totals.at(metric_index("travel_mm"));
  };
  EXPECT_LT(travel("zigzag"), travel("one way") / 2);
}

TEST_F(Runner, TheSameAgainDoesNothing) {
  const ExperimentConfig same = config(hatch_contender("a"), "repetitions = 2");
  execute(same);
  const std::string before = test::text_of_file(file());
  const RunSummary again = execute(same);
  EXPECT_EQ(again.executed, 0u);
  EXPECT_EQ(again.found, 2u);
  EXPECT_EQ(test::text_of_file(file()), before);
  EXPECT_NE(log_.str().find("2 of 2 cells are in the database already"), std::string::npos);
}

TEST_F(Runner, OnlyWhatIsNewOrChangedIsExecuted) {
  execute(config(hatch_contender("a") + hatch_contender("b")));
  EXPECT_EQ(
      execute(config(hatch_contender("a") + hatch_contender("b") + hatch_contender("c"))).executed,
      2u);
  EXPECT_EQ(cells().size(), 6u);
  EXPECT_EQ(execute(config(hatch_contender("a", ", version = 2") + hatch_contender("b"))).executed,
            2u);
  EXPECT_EQ(cells().size(), 4u) << "cells of an earlier config must not stay in the table";
  // Written otherwise, but the same.
  EXPECT_EQ(execute(config(hatch_contender("a", ", zigzag = true, version = 2"))).executed, 0u);
  EXPECT_EQ(cells().size(), 2u);
  EXPECT_EQ(execute(config(hatch_contender("a", ", version = 2"), "repetitions = 1", "seed = 9\n"))
                .executed,
            2u);
  dir_.write("small.wkt", squares_wkt(9));
  EXPECT_EQ(execute(config(hatch_contender("a", ", version = 2"))).executed, 1u);
}

TEST_F(Runner, MissingRepetitionsAreTakenLater) {
  const auto samples = [&] {
    return ResultsWriter(options_.out, "t", ResultsWriter::Start::kResume)
        .known_cells()
        .begin()
        ->second.repetitions;
  };
  execute(config(hatch_contender("a"), "repetitions = 1"));
  EXPECT_EQ(samples(), (std::vector<int>{0}));
  EXPECT_EQ(execute(config(hatch_contender("a"), "repetitions = 4")).executed, 0u);
  EXPECT_EQ(samples(), (std::vector<int>{0, 1, 2, 3}));
}

TEST_F(Runner, NumberOfJobsChangesNoScore) {
  const std::string contenders =
      hatch_contender("a") + hatch_contender("b", ", zigzag = [true, false]") +
      culprit_contender("skip") + culprit_contender("throw") + culprit_contender("abort");
  const ExperimentConfig all = config(contenders, "repetitions = 2", "seed = [1, 2]\n");
  execute(all);
  const std::vector<std::string> with_one = scores();
  EXPECT_EQ(with_one.size(), 24u);
  options_.out = dir_.path() / "out3";
  options_.jobs = 3;
  execute(all);
  EXPECT_EQ(scores(), with_one);
  for (const auto& [key, cell] :
       ResultsWriter(options_.out, "t", ResultsWriter::Start::kResume).known_cells())
    EXPECT_EQ(cell.repetitions.size(),
              cell.outcome == Outcome::kValid || cell.outcome == Outcome::kOffTask ? 2u : 0u);
}

struct Crime {
  const char* name;
  Outcome outcome;
  const char* reason;  ///< a part of it
};
void PrintTo(const Crime& crime, std::ostream* out) { *out << crime.name; }

class Crimes : public Runner, public testing::WithParamInterface<Crime> {};

TEST_P(Crimes, CostTheirOwnCellAndNothingElse) {
  const Crime& crime = GetParam();
#if defined(__SANITIZE_ADDRESS__)
  if (crime.outcome == Outcome::kOutOfMemory)
    GTEST_SKIP() << "the sanitizer ends a process whose memory is limited";
#endif
  testing::internal::CaptureStdout();
  execute(
      config(hatch_contender("before") + culprit_contender(crime.name) + hatch_contender("after"),
             "repetitions = 3\ntimeout_s = 1.5\nmemory_mb = 300", "", "\"small.wkt\""));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(cells().size(), 3u);
  EXPECT_EQ(cell("before", "small.wkt").outcome, Outcome::kValid);
  EXPECT_EQ(cell("after", "small.wkt").outcome, Outcome::kValid);
  const StoredCell culprit = cell(crime.name, "small.wkt");
  EXPECT_EQ(to_string(culprit.outcome), to_string(crime.outcome)) << culprit.reason;
  EXPECT_NE(culprit.reason.find(crime.reason), std::string::npos) << culprit.reason;
  EXPECT_EQ(culprit.reason.find('\n'), std::string::npos);
  if (crime.outcome == Outcome::kValid) {
    EXPECT_EQ(culprit.reason, "");
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Crimes,
    testing::Values(
        Crime{"segfault", Outcome::kCrashed, "SIGSEGV while planning layer 1"},
        Crime{"abort", Outcome::kCrashed, "SIGABRT while planning layer 1; it last wrote: day"},
        Crime{"throw", Outcome::kFailed, "no mood"},
        Crime{"loop", Outcome::kTimedOut, "no result after 1.5 s while planning layer 1"},
        Crime{"hoard", Outcome::kOutOfMemory, "more than 300 MB wanted while planning layer 1"},
        Crime{"nan", Outcome::kFailed, "layer 1"},
        Crime{"exit", Outcome::kCrashed, "exit code 0 while planning layer 1"},
        Crime{"kill_self", Outcome::kCrashed, "SIGKILL"},
        Crime{"close_files", Outcome::kCrashed, "ended its process"},
        Crime{"chatter", Outcome::kValid, ""}, Crime{"thread", Outcome::kValid, ""},
        Crime{"nap", Outcome::kValid, ""}, Crime{"skip", Outcome::kOffTask, "covered"},
        Crime{"outside", Outcome::kOffTask, "covered"},
        Crime{"discard", Outcome::kOffTask, "covered"},
        Crime{"moody", Outcome::kFailed, "not deterministic: repetition"}),
    [](const testing::TestParamInfo<Crime>& crime) { return std::string(crime.param.name); });

TEST_F(Runner, ACellAtALimitIsExecutedAgainWhenTheLimitWasRaised) {
  const auto with_timeout = [&](const char* timeout) {
    return config(culprit_contender("nap"), std::string("repetitions = 1\ntimeout_s = ") + timeout,
                  "", "\"small.wkt\"");
  };
  execute(with_timeout("0.1"));
  EXPECT_EQ(cell("nap", "small.wkt").outcome, Outcome::kTimedOut);
  EXPECT_EQ(execute(with_timeout("0.05")).executed, 0u);
  EXPECT_EQ(execute(with_timeout("20")).executed, 1u);
  EXPECT_EQ(cell("nap", "small.wkt").outcome, Outcome::kValid);
  EXPECT_EQ(execute(with_timeout("0.1")).executed, 0u);
}

TEST_F(Runner, OnlyExecutesWhatIsChosen) {
  const ExperimentConfig all =
      config(hatch_contender("a", ", zigzag = [true, false]") + hatch_contender("b"));
  options_.only_contenders = {"a [fill.zigzag=false]"};
  EXPECT_EQ(execute(all).executed, 2u);
  options_.only_contenders = {"a"};
  options_.only_models = {"small.wkt"};
  EXPECT_EQ(execute(all).executed, 1u);
  EXPECT_EQ(cells().size(), 3u);
  EXPECT_EQ(execute(all).executed, 0u);
  options_.only_contenders = {"aa"};
  EXPECT_EQ(complaint(all),
            "--only contender=aa: the config has no such contender; did you mean a?");
  options_.only_contenders.clear();
  options_.only_models = {"smal.wkt"};
  EXPECT_EQ(complaint(all),
            "--only model=smal.wkt: the config has no such model; did you mean small.wkt?");
}

TEST_F(Runner, ADryRunWritesNothing) {
  options_.dry_run = true;
  const ExperimentConfig both = config(hatch_contender("a") + hatch_contender("b"));
  const RunSummary first = execute(both);
  EXPECT_EQ(first.left, 4u);
  EXPECT_EQ(first.executed, 0u);
  EXPECT_FALSE(fs::exists(options_.out));
  EXPECT_NE(log_.str().find("would execute small.wkt · a\n"), std::string::npos);
  options_.dry_run = false;
  execute(config(hatch_contender("a")));
  options_.dry_run = true;
  const RunSummary second = execute(both);
  EXPECT_EQ(second.left, 2u);
  EXPECT_EQ(second.found, 2u);
  EXPECT_EQ(cells().size(), 2u);
}

TEST_F(Runner, FreshStartsAnew) {
  execute(config(hatch_contender("a")));
  options_.fresh = true;
  EXPECT_EQ(execute(config(hatch_contender("a"))).executed, 2u);
  EXPECT_EQ(cells().size(), 2u);
}

TEST_F(Runner, AnOptionalModelThatCannotBeHadIsLeftOutAndNamed) {
  const std::string more = "optional_models = [\"large.wkt\", \"lost.wkt\"]\n";
  const RunSummary summary =
      execute(config(hatch_contender("zigzag"), "repetitions = 1", more, "\"small.wkt\""));
  EXPECT_EQ(summary.executed, 2u);
  EXPECT_EQ(cell("zigzag", "large.wkt").outcome, Outcome::kValid);
  EXPECT_NE(log_.str().find("left out an optional model"), std::string::npos);
  EXPECT_NE(log_.str().find("lost.wkt"), std::string::npos);
}

TEST_F(Runner, NothingIsWrittenIfAnythingIsWrongBeforehand) {
  EXPECT_NE(
      complaint(config(hatch_contender("a"), "repetitions = 1", "", "\"small.wkt\", \"none.wkt\""))
          .find("none.wkt"),
      std::string::npos);
  EXPECT_NE(complaint(config(hatch_contender("a", ", zigzagg = true"))).find("zigzagg"),
            std::string::npos);
  EXPECT_NE(complaint(config(hatch_contender("a") +
                             "[[contender]]\nname = \"b\"\nshell = { planner = \"hatch\" }\n"))
                .find("hatch"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(options_.out));
}

TEST_F(Runner, SettingsThatCutAlikeShareTheirLayersAndTheOthersDoNot) {
  execute(
      parse_config("name = \"t\"\nmodels = [\"small.wkt\"]\n[task]\nperimeters = 0\ndensity = "
                   "[0.5, 1]\nskin_layers = 0\n"
                   "[printer]\nretract_over_mm = [1, 100]\n[run]\nrepetitions = 1\n" +
                       hatch_contender("a"),
                   dir_.path() / "t.toml"));
  ASSERT_EQ(cells().size(), 4u);
  std::set<std::string> labels;
  for (const StoredCell& cell : cells()) {
    EXPECT_EQ(cell.outcome, Outcome::kValid) << cell.setting << ": " << cell.reason;
    labels.insert(cell.setting);
  }
  EXPECT_EQ(labels.size(), 4u);
  const auto score = [&](const std::string& setting, const char* metric) {
    for (const StoredCell& cell : cells())
      if (cell.setting == setting) return cell.totals.at(metric_index(metric)).value_or(-1);
    return -1.0;
  };
  EXPECT_LT(score("density=0.5, retract_over_mm=1", "extrude_mm"),
            0.9 * score("density=1, retract_over_mm=1", "extrude_mm"));
  EXPECT_EQ(score("density=0.5, retract_over_mm=1", "travel_mm"),
            score("density=0.5, retract_over_mm=100", "travel_mm"));
}

/// A run in a process of its own, as the program would make it.
pid_t run_elsewhere(const ExperimentConfig& config, const PlannerSet& planners,
                    const RunnerOptions& options) {
  const pid_t process = fork();
  if (process == 0) {
    std::ostringstream log;
    try {
      _exit(run_experiment(config, planners, options, {&log, false}).interrupted ? 130 : 0);
    } catch (const std::exception&) {
      _exit(3);
    }
  }
  return process;
}

/// Waits until a number of cells is in the database.
void wait_for_cells(const fs::path& file, std::size_t count) {
  for (int i = 0; i < 3000; ++i) {
    try {
      if (fs::exists(file) && current_cells(file).size() >= count) return;
    } catch (const Error&) {
      // between two steps of the writer
    }
    usleep(5'000);
  }
  FAIL() << "no " << count << " cells";
}

TEST_F(Runner, KilledAtAnyMomentItGoesOnToTheSameTable) {
  const ExperimentConfig all =
      config(culprit_contender("nap") + hatch_contender("a") +
                 hatch_contender("b", ", zigzag = false") + culprit_contender("skip"),
             "repetitions = 2");
  execute(all);
  const std::vector<std::string> undisturbed = scores();
  options_.out = dir_.path() / "killed";
  for (const std::size_t done : {1u, 2u, 5u}) {
    const pid_t process = run_elsewhere(all, planners_, options_);
    wait_for_cells(file(), done);
    kill(process, SIGKILL);
    int status = 0;
    waitpid(process, &status, 0);
  }
  const RunSummary summary = execute(all);
  EXPECT_GE(summary.found, 5u);
  EXPECT_EQ(scores(), undisturbed);
}

TEST_F(Runner, InterruptedItKeepsWhatIsDone) {
  const ExperimentConfig all = config(
      hatch_contender("a") + culprit_contender("loop") + hatch_contender("b"), "repetitions = 1");
  const pid_t process = run_elsewhere(all, planners_, options_);
  wait_for_cells(file(), 1);
  kill(process, SIGINT);
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(cells().size(), 1u);
}

TEST_F(Runner, TheRouteOfTheMiddleLayerIsKept) {
  execute(config(hatch_contender("a"), "repetitions = 1", "", "\"small.wkt\""));
  const std::string database = test::text_of_file(file());
  EXPECT_NE(database.find("[{\"kind\":\"dense\",\"width_mm\":0.45,\"points\":[["),
            std::string::npos);
  EXPECT_NE(database.find("MULTIPOLYGON Z (((0 0 0.5"), std::string::npos);
  EXPECT_EQ(database.find("MULTIPOLYGON Z (((0 0 0.3"), std::string::npos);
}

StoredCell stored(const std::string& model, const std::string& contender, double travel_mm,
                  Outcome outcome = Outcome::kValid, const std::string& setting = "") {
  StoredCell cell{model,   contender,
                  setting, 1,
                  outcome, outcome == Outcome::kValid ? "" : "why",
                  3,       Scores(metric_table().size())};
  cell.totals[metric_index("travel_mm")] = travel_mm;
  cell.totals[metric_index("retractions")] = travel_mm / 10;
  cell.totals[metric_index("plan_wall_ns")] = 2.5e6;
  return cell;
}

std::string ranking(const std::vector<StoredCell>& cells) {
  std::ostringstream text;
  write_ranking(text, cells);
  return text.str();
}

TEST(Ranking, IsByTheGeometricMeanOfTravelOverCommonModels) {
  // With the shift of 1 mm: ratios 2 and 1 for "far" against 1 and 2 for "near" on m1 and m2 tie;
  // m3 tips the balance.
  EXPECT_EQ(ranking({stored("m1", "far", 199), stored("m1", "near", 99), stored("m2", "far", 9),
                     stored("m2", "near", 19), stored("m3", "far", 0), stored("m3", "near", 3)}),
            "6 cells: 6 valid\n"
            "\n"
            "     contender  travel ratio  travel mm  retractions  plan ms  valid\n"
            "  1  far               1.260      208.0           21      7.5    3/3\n"
            "  2  near              2.000      121.0           12      7.5    3/3\n"
            "  over 3 of 3 models; the ratio is the geometric mean of travel to the least travel "
            "there\n");
}

TEST(Ranking, WhatIsNotValidIsCountedFirstAndLeftOutByName) {
  EXPECT_EQ(
      ranking({stored("m1", "a", 10), stored("m1", "b", 20),
               stored("m1", "c", 1, Outcome::kCrashed), stored("m2", "a", 10),
               stored("m2", "b", 5, Outcome::kOffTask), stored("m2", "c", 1, Outcome::kTimedOut)}),
      "6 cells: 3 valid, 1 off_task, 1 crashed, 1 timed_out\n"
      "\n"
      "     contender  travel ratio  travel mm  retractions  plan ms  valid\n"
      "  1  a                 1.000       10.0            1      2.5    2/2\n"
      "  2  b                 1.909       20.0            2      2.5    1/2\n"
      "  over 1 of 2 models; the ratio is the geometric mean of travel to the least travel "
      "there\n"
      "  not ranked: c has no valid cell\n"
      "\n"
      "left out: 3 of 6 cells\n"
      "  m1 · c: crashed (why)\n"
      "  m2 · b: off_task (why)\n"
      "  m2 · c: timed_out (why)\n");
}

TEST(Ranking, SettingsAreRankedApartAndNoCommonModelIsSaid) {
  const std::string text = ranking({stored("m1", "a", 10, Outcome::kValid, "density=0.2"),
                                    stored("m1", "b", 20, Outcome::kFailed, "density=0.2"),
                                    stored("m2", "a", 10, Outcome::kFailed, "density=0.2"),
                                    stored("m2", "b", 20, Outcome::kValid, "density=0.2"),
                                    stored("m1", "a", 10, Outcome::kValid, "density=1")});
  EXPECT_NE(
      text.find("\ndensity=0.2\nno ranking: on none of the 2 models are all contenders valid\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("\ndensity=1\n"), std::string::npos) << text;
}

TEST(Ranking, NothingAtAllIsNoAccident) { EXPECT_EQ(ranking({}), "0 cells: 0 valid\n"); }

}  // namespace
}  // namespace routebench
