/// Foreign slicers as contenders of an experiment.

#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <map>

#include "program.hpp"
#include "routebench/harness/results.hpp"
#include "sliced_abroad.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::ProgramRun;

class SlicerContender : public test::ProgramTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  /// A program for the shell.
  void write_script(const std::string& name, const std::string& text) const {
    write(name, "#!/bin/sh\n" + text + "\n");
    chmod(in_folder(name).c_str(), 0755);
  }

  /// Runs contenders, each a name and what stands behind `slicer =`, on a small gear.
  ProgramRun run(const std::vector<std::pair<std::string, std::string>>& slicers,
                 const std::string& limits = "", const std::string& more = "",
                 const std::string& model = kModel) {
    std::string config = "name = \"t\"\nmodels = [\"" + model +
                         "\"]\n[task]\nskin_layers = 0\n[run]\nrepetitions = 2\njobs = 1\n" +
                         limits + "\n" + more;
    for (const auto& [name, slicer] : slicers)
      config += "[[contender]]\nname = \"" + name + "\"\nslicer = " + slicer + "\n";
    write("t.toml", config);
    return call({"run", in_folder("t.toml"), "--out", in_folder("out")});
  }

  [[nodiscard]] std::map<std::string, StoredCell> cells() const {
    std::map<std::string, StoredCell> cells;
    for (const StoredCell& cell : current_cells(folder_ / "out" / "results.sqlite"))
      cells[cell.contender] = cell;
    return cells;
  }

  static std::string command(const std::string& words) { return "{ command = \"" + words + "\" }"; }

  static constexpr const char* kModel = "shape:gear?size=16";
};

/// A cell's metric; NaN if it has none.
double metric(const StoredCell& cell, const char* name) {
  return cell.totals.at(metric_index(name)).value_or(std::nan(""));
}

TEST_F(SlicerContender, OurOwnProgramAsASlicerScoresAsItsPlanners) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer ends a program of ours whose memory is limited";
#endif
  const std::string planners =
      "[[contender]]\nname = \"planners\"\nshell = { planner = \"greedy_shell\" }\n"
      "fill = { planner = \"rectilinear\" }\n";
  const ProgramRun done =
      run({{"program", command(std::string(ROUTEBENCH_PROGRAM) +
                               " plan {model} --shell greedy_shell --fill rectilinear --jobs 1"
                               " --task skin_layers={task.skin_layers} --gcode {gcode}")}},
          "", planners, "shape:box?x=16&y=12&z=3");
  ASSERT_EQ(done.exit_code, 0) << done.out << done.err;
  const auto found = cells();
  const StoredCell& planned = found.at("planners");
  const StoredCell& printed = found.at("program");
  EXPECT_EQ(printed.outcome, Outcome::kValid) << printed.reason;
  EXPECT_EQ(printed.layers, planned.layers);
  for (const char* name : {"extrude_mm", "travel_mm", "retractions", "strokes", "filament_mm3",
                           "print_time_s", "covered", "deposit"}) {
    EXPECT_GT(metric(planned, name), 0) << name;
    EXPECT_NEAR(metric(printed, name), metric(planned, name), 1e-3 * metric(planned, name)) << name;
  }
  // The job is not plan(), and plan() is not the job.
  EXPECT_TRUE(std::isnan(metric(printed, "plan_wall_ns")));
  EXPECT_TRUE(std::isnan(metric(planned, "job_wall_s")));
  EXPECT_GT(metric(printed, "job_wall_s"), 0);
  EXPECT_GT(metric(printed, "job_cpu_s"), 0);
  EXPECT_GT(metric(printed, "peak_rss_bytes"), 1e5);
}

TEST_F(SlicerContender, OneThatIsNotThereIsNoFailure) {
  const ProgramRun done = run({{"nobody", command("no-such-slicer-anywhere {model} {gcode}")}});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_TRUE(done.out.starts_with("1 cells: 0 valid, 1 not_installed\n") ||
              done.out.starts_with("1 cell: 0 valid, 1 not_installed\n"))
      << done.out;
  EXPECT_NE(done.out.find("not_installed (no-such-slicer-anywhere is not there)"),
            std::string::npos)
      << done.out;
}

TEST_F(SlicerContender, OnceItIsThereItIsExecuted) {
  const std::string script = command("./mine {model} {gcode}");
  EXPECT_EQ(run({{"mine", script}}).exit_code, 0);
  EXPECT_EQ(cells().at("mine").outcome, Outcome::kNotInstalled);
  write_script("mine", "echo out of filament >&2; exit 3");
  EXPECT_EQ(run({{"mine", script}}).exit_code, 1);
  EXPECT_EQ(cells().at("mine").outcome, Outcome::kFailed);
  EXPECT_EQ(cells().at("mine").reason,
            "mine ended with exit code 3; it last wrote: out of filament");
  // Another program behind the same name is another contender's variant.
  write_script("mine", "exit 4");
  EXPECT_EQ(run({{"mine", script}}).exit_code, 1);
  EXPECT_EQ(cells().at("mine").reason, "mine ended with exit code 4");
}

TEST_F(SlicerContender, WhatGoesWrongCostsItsCellAlone) {
  write_script("silent", "true");
  write_script("babbler", "echo 'G1 X1 Y1 Z1' >$2; echo 'G1 X' >>$2");
  write_script("hanger", "sleep 1000 & echo $! >'" + in_folder("pid") + "'; wait");
  write_script("hog", "exec /usr/bin/python3 -c 'x = bytearray(900 << 20)'");
  write_script("killed", "kill -KILL $$");
  const ProgramRun done = run({{"silent", command("./silent {model} {gcode}")},
                               {"babbler", command("./babbler {model} {gcode}")},
                               {"hanger", command("./hanger {model} {gcode}")},
                               {"hog", command("./hog {model} {gcode}")},
                               {"killed", command("./killed {model} {gcode}")}},
                              "timeout_s = 5\nmemory_mb = 300");
  EXPECT_EQ(done.exit_code, 1);
  const auto found = cells();
  EXPECT_EQ(found.at("silent").reason, "silent wrote no G-code");
  EXPECT_EQ(found.at("babbler").outcome, Outcome::kFailed);
  EXPECT_TRUE(found.at("babbler").reason.starts_with("babbler: its G-code:2: "))
      << found.at("babbler").reason;
  EXPECT_EQ(found.at("hanger").outcome, Outcome::kTimedOut);
  EXPECT_EQ(found.at("hanger").reason, "no result after 5 s while the slicer ran");
  EXPECT_EQ(found.at("hog").outcome, Outcome::kOutOfMemory) << found.at("hog").reason;
  EXPECT_EQ(found.at("killed").reason, "killed was killed by SIGKILL");
  // What it had started is gone, too.
  const pid_t sleeper = std::stoi(test::content_of(folder_ / "pid"));
  EXPECT_FALSE(fs::exists("/proc/" + std::to_string(sleeper) + "/exe"));
}

TEST_F(SlicerContender, LayersOfItsOwnMakeItOffTask) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer ends a program of ours whose memory is limited";
#endif
  const ProgramRun done = run(
      {{"higher", command(std::string(ROUTEBENCH_PROGRAM) +
                          " plan shape:box?x=10&y=10&z=3 --shell greedy_shell --fill "
                          "rectilinear --task skin_layers=0 --gcode {gcode} --json {model}.json")}},
      "", "", "shape:box?x=10&y=10&z=2");
  EXPECT_EQ(done.exit_code, 1) << done.out;
  EXPECT_EQ(cells().at("higher").outcome, Outcome::kOffTask);
  EXPECT_EQ(cells().at("higher").reason,
            "5 of 15 layers of the G-code are none of the model's, the first at z = 2.2 mm");
}

TEST_F(SlicerContender, AFileOfLayersHasNoMeshToSlice) {
  write("a.wkt", "MULTIPOLYGON Z (((0 0 0.1, 9 0 0.1, 9 9 0.1, 0 9 0.1, 0 0 0.1)))\n");
  write_script("any", "exit 9");
  EXPECT_EQ(run({{"any", command("./any {model} {gcode}")}}, "", "", "a.wkt").exit_code, 1);
  EXPECT_EQ(cells().at("any").reason, "a slicer needs a mesh, but the model is a file of layers");
}

TEST_F(SlicerContender, WaysOfSlicingAreJudgedInTheWordsOfTheGate) {
  const std::string ways = "[[contender]]\nname = \"way\"\nslicing = [\"sweep\", \"voxel\"]\n";
  EXPECT_EQ(run({}, "", ways, kModel).exit_code, 1);
  const auto found = cells();
  const StoredCell& sweep = found.at("way [slicing=sweep]");
  EXPECT_EQ(sweep.outcome, Outcome::kValid) << sweep.reason;
  EXPECT_EQ(metric(sweep, "covered"), 1);
  EXPECT_EQ(metric(sweep, "spilled"), 0);
  const StoredCell& voxel = found.at("way [slicing=voxel]");
  EXPECT_EQ(voxel.outcome, Outcome::kOffTask);
  EXPECT_TRUE(voxel.reason.starts_with("spilled 0.") && voxel.reason.ends_with(" > 0.02"))
      << voxel.reason;
}

TEST_F(SlicerContender, NothingIsLeftBehind) {
  const fs::path scratch = folder_ / "scratch";
  fs::create_directory(scratch);
  setenv("TMPDIR", scratch.c_str(), 1);
  write_script("hanger", "sleep 1000");
  static_cast<void>(run(
      {{"hanger", command("./hanger {model} {gcode}")}, {"cat", command("cat {model} {gcode}")}},
      "timeout_s = 1"));
  unsetenv("TMPDIR");
  EXPECT_EQ(cells().at("cat").outcome, Outcome::kFailed);
  EXPECT_TRUE(fs::is_empty(scratch));
}

TEST_F(SlicerContender, TheThreeThatHaveANameDoTheTask) {
  std::vector<std::pair<std::string, std::string>> installed;
  for (const std::string& name : slicer_names())
    if (test::installed_slicer(name) != nullptr) installed.emplace_back(name, '"' + name + '"');
  if (installed.empty()) GTEST_SKIP() << "no slicer is installed";
  const ProgramRun done = run(installed);
  ASSERT_EQ(done.exit_code, 0) << done.out << done.err;
  for (const auto& [name, cell] : cells()) {
    SCOPED_TRACE(name);
    EXPECT_EQ(cell.outcome, Outcome::kValid) << cell.reason;
    EXPECT_GT(metric(cell, "job_cpu_s"), 0);
    EXPECT_GT(metric(cell, "outline_covered"), 0.99);
    EXPECT_NEAR(metric(cell, "deposit"), 1, 0.15);
    EXPECT_EQ(metric(cell, "spilled"), 0);
  }
}

TEST_F(SlicerContender, AForeignFilesStrokesTakeThePlaceOfPlanners) {
  const std::string gcode = in_folder("a.gcode");
  const std::string again = in_folder("b.gcode");
  const ProgramRun planned = call({"plan", kModel, "--shell", "greedy_shell", "--fill",
                                   "rectilinear", "--gcode", gcode, "--json", "-"});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const ProgramRun taken = call({"plan", kModel, "--from-gcode", gcode, "--gcode", again, "--json",
                                 "-", "--svg", in_folder("pictures")});
  ASSERT_EQ(taken.exit_code, 0) << taken.err;
  EXPECT_TRUE(fs::exists(folder_ / "pictures" / "layer_0003.svg"));
  const nlohmann::json document = taken.json();
  EXPECT_EQ(document["contender"], (nlohmann::json{{"gcode", gcode}}));
  EXPECT_TRUE(document["seed"].is_null());
  EXPECT_TRUE(document["totals"]["plan_cpu_ns"].is_null());
  for (const char* name : {"extrude_mm", "travel_mm", "retractions", "strokes", "covered"}) {
    const double before = planned.json()["totals"][name].get<double>();
    EXPECT_NEAR(document["totals"][name].get<double>(), before, 1e-3 * before) << name;
  }
  // Written again, the strokes are what they were, kind by kind.
  const auto strokes_of = [](const std::string& file) {
    std::string text;
    for (const GcodeLayer& layer : read_gcode_file(file, {}).layers)
      for (std::size_t i = 0; i < layer.kinds.size(); ++i)
        text += std::to_string(layer.route.strokes[i].points.size()) +
                (layer.kinds[i] ? std::string(to_string(*layer.kinds[i])) : "?") + " ";
    return text;
  };
  EXPECT_EQ(strokes_of(again), strokes_of(gcode));
}

TEST_F(SlicerContender, KindsThatAFileDoesNotTellFollowFromWhereStrokesLie) {
  const std::string gcode = in_folder("a.gcode");
  ASSERT_EQ(
      call({"plan", kModel, "--shell", "greedy_shell", "--fill", "rectilinear", "--gcode", gcode})
          .exit_code,
      0);
  // Without its marks.
  std::istringstream lines(test::content_of(gcode));
  std::ofstream bare(in_folder("bare.gcode"));
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with(";TYPE:")) bare << line << '\n';
  bare.close();
  const std::string again = in_folder("b.gcode");
  ASSERT_EQ(
      call({"plan", kModel, "--from-gcode", in_folder("bare.gcode"), "--gcode", again}).exit_code,
      0);
  const GcodePrint told = read_gcode_file(gcode, {});
  const GcodePrint found = read_gcode_file(again, {});
  ASSERT_EQ(told.layers.size(), found.layers.size());
  std::size_t same = 0, all = 0;
  for (std::size_t l = 0; l < told.layers.size(); ++l)
    for (std::size_t i = 0; i < std::min(told.layers[l].kinds.size(), found.layers[l].kinds.size());
         ++i) {
      ++all;
      if (told.layers[l].kinds[i] == found.layers[l].kinds[i]) ++same;
    }
  EXPECT_GT(10 * same, 9 * all);
}

TEST_F(SlicerContender, AFileAndPlannersExcludeEachOther) {
  const auto refused = [&](const std::vector<std::string>& more, const std::string& part) {
    std::vector<std::string> words{"plan", kModel};
    words.insert(words.end(), more.begin(), more.end());
    expect_refused(words, part);
  };
  refused({"--from-gcode", "a.gcode", "--shell", "greedy_shell"}, "--shell: the strokes come");
  refused({"--from-gcode", "a.gcode", "--set", "fill.angle_deg=3"}, "--set: the strokes come");
  refused({"--fill", "rectilinear", "--offset", "1,1"}, "--offset means nothing");
  refused({"--from-gcode", "nothing.gcode"}, "nothing.gcode: cannot be opened");
}

}  // namespace
}  // namespace routebench
