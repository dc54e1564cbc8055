#include "routebench/harness/runner.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <set>
#include <sstream>

#include "runner_fixture.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::culprit_contender;
using test::hatch_contender;
using test::run_elsewhere;
using test::squares_wkt;

class Runner : public test::RunnerTest {};

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
  const std::vector<std::string> with_one = content();
  EXPECT_EQ(cells().size(), 24u);
  options_.out = dir_.path() / "out3";
  options_.jobs = 3;
  execute(all);
  EXPECT_EQ(content(), with_one);
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
             std::string("repetitions = 3\ntimeout_s = ") +
                 // A loop is waited for; whatever else ends by itself, also on a busy machine.
                 (crime.outcome == Outcome::kTimedOut ? "1.5" : "60") + "\nmemory_mb = 300",
             "", "\"small.wkt\""));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(cells().size(), 3u);
  EXPECT_EQ(cell("before", "small.wkt").outcome, Outcome::kValid);
  EXPECT_EQ(cell("after", "small.wkt").outcome, Outcome::kValid);
  const StoredCell culprit = cell(crime.name, "small.wkt");
  EXPECT_EQ(to_string(culprit.outcome), to_string(crime.outcome)) << culprit.reason;
  EXPECT_NE(culprit.reason.find(crime.reason), std::string::npos) << culprit.reason;
  EXPECT_EQ(culprit.reason.find('\n'), std::string::npos);
  EXPECT_EQ(culprit.reason.find("layer 1"), culprit.reason.rfind("layer 1")) << culprit.reason;
  if (crime.outcome == Outcome::kValid) {
    EXPECT_EQ(culprit.reason, "");
  }
}

TEST_F(Runner, HowAPlannerRoundsDoesNotReachTheJudge) {
  execute(config(hatch_contender("honest") + culprit_contender("round"), "repetitions = 1", "",
                 "\"small.wkt\""));
  const StoredCell honest = cell("honest", "small.wkt"), round = cell("round", "small.wkt");
  ASSERT_EQ(honest.route_hash, round.route_hash);
  for (std::size_t i = 0; i < metric_table().size(); ++i)
    if (is_deterministic(metric_table()[i].name)) {
      EXPECT_EQ(honest.totals[i], round.totals[i]) << metric_table()[i].name;
    }
}

TEST_F(Runner, ReasonsAreShortAndOfPrintableCharacters) {
  execute(config(culprit_contender("curse"), "repetitions = 1", "", "\"small.wkt\""));
  const std::string reason = cell("curse", "small.wkt").reason;
  EXPECT_LT(reason.size(), 5000u);
  EXPECT_TRUE(
      std::all_of(reason.begin(), reason.end(), [](char c) { return ' ' <= c && c <= '~'; }));
}

INSTANTIATE_TEST_SUITE_P(
    All, Crimes,
    testing::Values(
        Crime{"segfault", Outcome::kCrashed, "SIGSEGV while planning layer 1"},
        Crime{"abort", Outcome::kCrashed, "SIGABRT while planning layer 1; it last wrote: day"},
        Crime{"throw", Outcome::kFailed, "no mood"},
        Crime{"loop", Outcome::kTimedOut, "no result after 1.5 s while planning layer 1"},
        Crime{"hoard", Outcome::kOutOfMemory, "more than 300 MB wanted while planning layer 1"},
        Crime{"nan", Outcome::kFailed, "layer 1"}, Crime{"infinite", Outcome::kFailed, "layer 1"},
        Crime{"recurse", Outcome::kCrashed, "SIGSEGV while planning layer 1"},
        Crime{"leak", Outcome::kOffTask, "spilled"},
        Crime{"exit", Outcome::kCrashed, "exit code 0 while planning layer 1"},
        Crime{"kill_self", Outcome::kCrashed, "SIGKILL"},
        Crime{"close_files", Outcome::kCrashed, "ended its process"},
        Crime{"chatter", Outcome::kValid, ""}, Crime{"thread", Outcome::kValid, ""},
        Crime{"nap", Outcome::kValid, ""}, Crime{"skip", Outcome::kOffTask, "covered"},
        Crime{"outside", Outcome::kOffTask, "hollow_mm"},
        Crime{"discard", Outcome::kOffTask, "covered"},
        Crime{"stillborn", Outcome::kCrashed, "SIGABRT while planning layer 0"},
        Crime{"unborn", Outcome::kFailed, "layer 0: it threw something that is no std::exception"},
        Crime{"round", Outcome::kValid, ""}, Crime{"curse", Outcome::kFailed, "layer 1: ?[2J?xxx"},
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

TEST_F(Runner, OnlyExecutesSettingsByTheirLabelsOrPartsOfThem) {
  const ExperimentConfig all = parse_config(
      "name = \"t\"\nmodels = [\"small.wkt\"]\n[task]\nperimeters = 0\ndensity = [0.5, "
      "1]\n[printer]\nretract_over_mm = [1, 100]\n[run]\nrepetitions = 1\n" +
          hatch_contender("a"),
      dir_.path() / "t.toml");
  options_.only_settings = {"density=1"};
  EXPECT_EQ(execute(all).executed, 2u);
  options_.only_settings = {"density=0.5, retract_over_mm=100"};
  EXPECT_EQ(execute(all).executed, 1u);
  options_.only_settings = {"density=2"};
  EXPECT_NE(complaint(all).find("--only setting=density=2: the config has no such setting"),
            std::string::npos);
}

TEST_F(Runner, SamplesKeepTimesFaultsAndMemory) {
  execute(config(hatch_contender("a"), "repetitions = 3", "", "\"small.wkt\""));
  EXPECT_EQ(test::rows_of(file(),
                          "SELECT count(*), min(plan_wall_ns > 0), min(plan_cpu_ns > 0),"
                          " min(minor_faults >= 0), min(major_faults >= 0),"
                          " min(peak_rss_bytes > 100000), count(DISTINCT run_id)"
                          " FROM timing_sample"),
            std::vector<std::string>{"3|1|1|1|1|1|1"});
  EXPECT_NE(test::rows_of(file(), "SELECT sum(minor_faults) FROM timing_sample").front(), "0")
      << "planning touches fresh memory";
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
  StoredCell cell;
  cell.model = model;
  cell.contender = contender;
  cell.setting = setting;
  cell.outcome = outcome;
  cell.reason = outcome == Outcome::kValid ? "" : "why";
  cell.layers = 3;
  cell.totals.resize(metric_table().size());
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
