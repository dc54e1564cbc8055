/// The commands run and export.

#include <signal.h>

#include <algorithm>
#include <set>
#include <thread>

#include "program.hpp"
#include "routebench/harness/results.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::ProgramRun;

/// Three layers of a square.
constexpr const char* kSquare =
    "MULTIPOLYGON Z (((0 0 0.1, 9 0 0.1, 9 9 0.1, 0 9 0.1, 0 0 0.1)))\n"
    "MULTIPOLYGON Z (((0 0 0.3, 9 0 0.3, 9 9 0.3, 0 9 0.3, 0 0 0.3)))\n"
    "MULTIPOLYGON Z (((0 0 0.5, 9 0 0.5, 9 9 0.5, 0 9 0.5, 0 0 0.5)))\n";

constexpr const char* kHead =
    "name = \"t\"\nmodels = [\"square.wkt\"]\n[task]\nperimeters = 0\ndensity = 1\n[run]\n"
    "repetitions = 2\n";
constexpr const char* kHonest =
    "[[contender]]\nname = \"honest\"\nfill = { planner = \"hatch\" }\n"
    "[[contender]]\nname = \"one way\"\nfill = { planner = \"hatch\", zigzag = false }\n";

std::string culprit(const std::string& crime) {
  return "[[contender]]\nname = \"" + crime + "\"\nfill = { planner = \"culprit\", crime = \"" +
         crime + "\" }\n";
}

class RunCommand : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("square.wkt", kSquare);
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  /// Runs the config with the culprit plugin.
  ProgramRun run(const std::string& config, std::vector<std::string> more = {}) {
    write("t.toml", config);
    std::vector<std::string> arguments{"run",      in_folder("t.toml"),
                                       "--plugin", ROUTEBENCH_CULPRIT_PLUGIN,
                                       "--out",    in_folder("out")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(arguments);
  }

  void expect_run_refused(const std::string& config, const std::string& part,
                          const std::vector<std::string>& more = {}) {
    const ProgramRun refused = run(config, more);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_EQ(refused.out, "");
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_NE(refused.err.find(part), std::string::npos) << refused.err << "lacks: " << part;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
};

TEST_F(RunCommand, CountsRanksAndSaysWhereTheResultsAre) {
  const ProgramRun done = run(std::string(kHead) + kHonest);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(done.out.starts_with("2 cells: 2 valid\n")) << done.out;
  EXPECT_LT(done.out.find("  1  honest "), done.out.find("  2  one way ")) << done.out;
  EXPECT_TRUE(done.out.ends_with("\nresults: " + in_folder("out") + "/results.sqlite\n"))
      << done.out;
  EXPECT_EQ(done.err.find('\r'), std::string::npos) << "no bar where there is no terminal";
  std::istringstream events(done.err);
  std::size_t cells_told = 0;
  for (std::string line; std::getline(events, line);) {
    const nlohmann::json event = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(event.is_object()) << line;
    if (event.value("what", "") == "cell") ++cells_told;
  }
  EXPECT_EQ(cells_told, 2u);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out"), fs::directory_iterator()), 1);

  const ProgramRun again = run(std::string(kHead) + kHonest);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.out, done.out);
  EXPECT_NE(again.err.find("2 of 2 cells are in the database already"), std::string::npos);
}

TEST_F(RunCommand, ProgressTakesTheFormThatIsAskedFor) {
  const auto told = [&](const std::string& form) {
    return run(std::string(kHead) + kHonest, {"--fresh", "--progress", form}).err;
  };
  EXPECT_EQ(told("none"), "");
  EXPECT_NE(told("lines").find("] square.wkt · honest: valid\n"), std::string::npos);
  EXPECT_NE(told("bar").find("cell 0 of 2\r\x1b[K"), std::string::npos);
  EXPECT_TRUE(told("json").starts_with("{\"event\":"));
  EXPECT_NE(told("loud").find("--progress"), std::string::npos);
}

TEST_F(RunCommand, EveryMisbehaviourOfAPluginCostsItsOwnCellsAndIsNamed) {
  const std::vector<std::pair<std::string, std::string>> crimes {
    {"segfault", "crashed"}, {"recurse", "crashed"}, {"abort", "crashed"}, {"exit", "crashed"},
        {"throw", "failed"}, {"nan", "failed"}, {"infinite", "failed"}, {"loop", "timed_out"},
        {"outside", "off_task"}, {"leak", "off_task"}, {"skip", "off_task"},
#if !defined(__SANITIZE_ADDRESS__)
        {"hoard", "out_of_memory"},
#endif
  };
  std::string config = std::string(kHead) + "timeout_s = 10\nmemory_mb = 200\n" + kHonest;
  for (const auto& [crime, outcome] : crimes) config += culprit(crime);
  const ProgramRun done = run(config, {"--jobs", "2"});
  EXPECT_EQ(done.exit_code, 1) << done.err;
  for (const auto& [crime, outcome] : crimes)
    EXPECT_NE(done.out.find("  square.wkt · " + crime + ": " + outcome + " ("), std::string::npos)
        << crime << " is not " << outcome << " in\n"
        << done.out;
  EXPECT_NE(done.out.find("  1  honest "), std::string::npos) << done.out;
  EXPECT_NE(done.out.find("  2  one way "), std::string::npos) << done.out;
  EXPECT_TRUE(done.out.starts_with(std::to_string(crimes.size() + 2) + " cells: 2 valid, "))
      << done.out;
}

TEST_F(RunCommand, CellsThatAreNotValidAreCountedNamedAndMakeTheExitCode) {
  const ProgramRun done = run(std::string(kHead) + kHonest + culprit("segfault") + culprit("skip"));
  EXPECT_EQ(done.exit_code, 1) << done.err;
  EXPECT_TRUE(done.out.starts_with("4 cells: 2 valid, 1 off_task, 1 crashed\n")) << done.out;
  EXPECT_NE(done.out.find("square.wkt · segfault: crashed (SIGSEGV while planning layer 1"),
            std::string::npos)
      << done.out;
  EXPECT_NE(done.out.find("square.wkt · skip: off_task (covered "), std::string::npos) << done.out;
}

TEST_F(RunCommand, WithoutOutTheResultsGoByTheNameOfTheExperiment) {
  const fs::path here = fs::current_path();
  write("t.toml", std::string(kHead) + kHonest);
  fs::current_path(folder_);
  const ProgramRun done = call({"run", "t.toml", "--plugin", ROUTEBENCH_CULPRIT_PLUGIN});
  fs::current_path(here);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(done.out.ends_with("\nresults: results/t/results.sqlite\n")) << done.out;
  EXPECT_TRUE(fs::exists(folder_ / "results" / "t" / "results.sqlite"));
}

TEST_F(RunCommand, PluginsOfTheConfigAreFoundBesideIt) {
  fs::copy_file(ROUTEBENCH_CULPRIT_PLUGIN, folder_ / "culprit.so");
  write("t.toml", "plugins = [\"culprit.so\"]\n" + std::string(kHead) + kHonest);
  const ProgramRun done = call({"run", in_folder("t.toml"), "--out", in_folder("out")});
  EXPECT_EQ(done.exit_code, 0) << done.err;
}

TEST_F(RunCommand, AnotherBuildOfAPluginIsExecutedAnew) {
  const fs::path plugin = folder_ / "culprit.so";
  fs::copy_file(ROUTEBENCH_CULPRIT_PLUGIN, plugin);
  write("t.toml", "plugins = [\"culprit.so\"]\n" + std::string(kHead) + kHonest);
  const auto run_it = [&] { return call({"run", in_folder("t.toml"), "--out", in_folder("out")}); };
  EXPECT_EQ(run_it().exit_code, 0);
  std::ofstream(plugin, std::ios::app) << "bytes that nobody loads";
  const ProgramRun again = run_it();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.err.find("executing 2 cells"), std::string::npos) << again.err;
  EXPECT_NE(again.err.find("{\"event\":\"redo\",\"cell\":\"square.wkt · honest\",\"why\":\"the "
                           "plugin file of its planner has changed\"}\n"),
            std::string::npos)
      << again.err;
  EXPECT_TRUE(again.out.starts_with("2 cells: 2 valid\n")) << again.out;
}

TEST_F(RunCommand, ADryRunListsAndWritesNothing) {
  const ProgramRun dry = run(std::string(kHead) + kHonest, {"--dry-run"});
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_NE(dry.out.find("would execute square.wkt · one way\n"), std::string::npos) << dry.out;
  EXPECT_NE(dry.out.find("\n2 cells to execute, 0 done, "), std::string::npos) << dry.out;
  EXPECT_NE(dry.out.find("\nabout "), std::string::npos) << dry.out;
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(RunCommand, WhatIsWrongIsSaidInOneLineBeforeAnythingIsWritten) {
  const std::string good = std::string(kHead) + kHonest;
  expect_run_refused(good + "[[contender]]\nname = \"x\"\nfillx = {}\n",
                     "t.toml:16: key `fillx`: unknown key of [[contender]]; did you mean `fill`?");
  expect_run_refused("name = \n" + good, "t.toml:1:8: ");
  expect_run_refused("plugins = [\"none.so\"]\n" + good, "none.so");
  expect_run_refused(good,
                     "--only planner=hatch: must be contender=NAME, model=SPEC or setting=LABEL",
                     {"--only", "planner=hatch"});
  expect_run_refused(good, "did you mean honest?", {"--only", "contender=honets"});
  expect_run_refused(good, "--jobs", {"--jobs", "-3"});
  write("square.wkt", "MULTIPOLYGON Z (((0 0 nan\n");
  expect_run_refused(good, "square.wkt");
  write("square.wkt", kSquare);
  expect_run_refused(
      "name = \"t\"\nmodels = [\"square.wkt\", \"none.stl\"]\n" + std::string(kHonest), "none.stl");
  fs::remove(folder_ / "square.wkt");
  expect_run_refused(good, "square.wkt");
}

TEST_F(RunCommand, OneRunAtATimeAndInterruptedItKeepsWhatIsDone) {
  write("t.toml", std::string(kHead) + "jobs = 1\n" + kHonest + culprit("loop"));
  const std::vector<std::string> arguments{
      "run", in_folder("t.toml"), "--plugin", ROUTEBENCH_CULPRIT_PLUGIN, "--out", in_folder("out")};
  ProgramRun first;
  std::thread running([&] { first = call(arguments); });
  const fs::path file = folder_ / "out" / "results.sqlite";
  const fs::path lock = folder_ / "out" / ".lock";
  std::string second_err;
  pid_t holder = 0;
  for (int i = 0; i < 2000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!fs::exists(file)) continue;
    if (current_cells(file).size() == 2) break;
  }
  try {
    ResultsWriter(folder_ / "out", "t", ResultsWriter::Start::kResume);
  } catch (const std::exception& error) {
    second_err = error.what();
    const std::size_t at = second_err.find("(process ");
    if (at != std::string::npos) holder = std::stoi(second_err.substr(at + 9));
  }
  EXPECT_NE(second_err.find("another run is writing its results here"), std::string::npos)
      << second_err;
  EXPECT_GT(holder, 1);
  if (holder > 1) kill(holder, SIGINT);
  running.join();
  EXPECT_EQ(first.exit_code, 130);
  EXPECT_EQ(first.out, "");
  EXPECT_NE(first.err.find("routebench: interrupted; 2 cells are done and kept, 1 are left"),
            std::string::npos)
      << first.err;
  EXPECT_EQ(current_cells(file).size(), 2u);
  EXPECT_FALSE(fs::exists(lock));
}

TEST_F(RunCommand, ExportWritesWhereItSaysAndRefusesWhatIsNoResults) {
  ASSERT_EQ(run(std::string(kHead) + kHonest).exit_code, 0);
  const ProgramRun exported = call({"export", in_folder("out")});
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_TRUE(exported.out.starts_with(in_folder("out") + "/csv/cells.csv\n")) << exported.out;
  EXPECT_EQ(std::count(exported.out.begin(), exported.out.end(), '\n'), 8);
  const std::string cells = test::content_of(folder_ / "out" / "csv" / "cells.csv");
  EXPECT_NE(cells.find("t,square.wkt,one way,,1,valid,,3,"), std::string::npos);

  const ProgramRun elsewhere =
      call({"export", in_folder("out/results.sqlite"), "--out", in_folder("tables")});
  EXPECT_EQ(elsewhere.exit_code, 0) << elsewhere.err;
  EXPECT_EQ(test::content_of(folder_ / "tables" / "cells.csv"), cells);

  const ProgramRun refused = call({"export", in_folder("square.wkt")});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("square.wkt: file is not a database"), std::string::npos)
      << refused.err;
  EXPECT_EQ(call({"export", in_folder("nowhere")}).exit_code, 2);
}

}  // namespace
}  // namespace routebench
