#include <set>

#include "gcode_reader.hpp"
#include "models.hpp"
#include "program.hpp"
#include "routebench/harness/metrics.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::keys_of;
using test::ProgramRun;

constexpr const char* kToys = ROUTEBENCH_TOY_PLUGIN;

class PlanCommand : public test::ProgramTest {
 protected:
  ProgramRun plan(const std::string& model, std::vector<std::string> more,
                  std::vector<std::string> planners = {"--shell", "greedy_shell", "--fill",
                                                       "rectilinear"}) {
    std::vector<std::string> arguments = {"plan", model};
    arguments.insert(arguments.end(), planners.begin(), planners.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(arguments);
  }
  static json without_times(json document) {
    const auto strip = [](json& scores) {
      for (const char* key : {"plan_wall_ns", "plan_cpu_ns", "peak_rss_bytes"}) scores.erase(key);
    };
    strip(document["totals"]);
    for (json& layer : document["per_layer"]) strip(layer);
    return document;
  }
};

constexpr const char* kModel = "shape:box?size=12";

TEST_F(PlanCommand, TellsItsPhasesIfAsked) {
  const json document = plan(kModel, {"--json", "-", "--phases"}).json();
  const json& cpu = document["cpu_ns"];
  EXPECT_EQ(keys_of(cpu), (std::set<std::string>{"prepare", "plan", "judge"}));
  for (const char* phase : {"prepare", "plan", "judge"}) EXPECT_GT(cpu[phase], 0) << phase;
  EXPECT_GE(cpu["plan"], document["totals"]["plan_cpu_ns"]) << "plan() is a part of it";
  const std::string table = plan(kModel, {"--phases", "--no-judge"}).out;
  EXPECT_NE(table.find("CPU of planning"), std::string::npos) << table;
  EXPECT_EQ(table.find("CPU of judging"), std::string::npos) << table;
  EXPECT_EQ(plan(kModel, {"--no-judge"}).out.find("CPU of"), std::string::npos);
  EXPECT_TRUE(
      plan(kModel, {"--json", "-", "--phases", "--no-judge"}).json()["cpu_ns"]["judge"].is_null());
}

TEST_F(PlanCommand, PrintsOneObjectWithExactlyTheMetricsOfTheTable) {
  const ProgramRun run = plan(kModel, {"--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json document = run.json();
  EXPECT_EQ(keys_of(document),
            (std::set<std::string>{"model", "contender", "task", "printer", "seed", "outcome",
                                   "reason", "layers", "totals", "per_layer", "mesh", "warnings"}));
  EXPECT_EQ(document["model"], kModel);
  EXPECT_EQ(document["outcome"], "valid");
  EXPECT_EQ(document["reason"], "");
  EXPECT_EQ(document["layers"], document["per_layer"].size());
  EXPECT_EQ(document["contender"]["name"], "greedy_shell + rectilinear");
  EXPECT_EQ(document["contender"]["shell"]["planner"], "greedy_shell");
  EXPECT_TRUE(document["contender"]["fill"]["params"].contains("angle_deg"));
  EXPECT_EQ(document["task"]["layer_height_mm"], 0.2);
  EXPECT_EQ(document["printer"]["retract_policy"], "length");
  EXPECT_EQ(document["mesh"]["open_edges"], 0);

  std::set<std::string> metrics;
  for (const MetricInfo& metric : metric_table()) metrics.emplace(metric.name);
  EXPECT_EQ(keys_of(document["totals"]), metrics);
  std::set<std::string> layer_keys = metrics;
  layer_keys.insert({"layer", "z_mm", "repaired"});
  int index = 0;
  for (const json& layer : document["per_layer"]) {
    EXPECT_EQ(keys_of(layer), layer_keys);
    EXPECT_EQ(layer["layer"], index++);
    EXPECT_TRUE(layer["peak_rss_bytes"].is_null()) << "of the process, not of a layer";
    EXPECT_GT(layer["plan_wall_ns"], 0);
  }
  EXPECT_GT(document["totals"]["peak_rss_bytes"], 1'000'000);
}

TEST_F(PlanCommand, SumsAreThoseOfTheLayers) {
  const json document = plan(kModel, {"--json", "-"}).json();
  for (const MetricInfo& metric : metric_table()) {
    if (metric.total != Total::kSum) continue;
    const std::string name(metric.name);
    double sum = 0;
    for (const json& layer : document["per_layer"]) sum += layer[name].get<double>();
    EXPECT_NEAR(document["totals"][name].get<double>(), sum, 1e-9 * (1 + sum)) << name;
  }
  EXPECT_EQ(document["per_layer"][0]["entry_travel_mm"], 0);
}

TEST_F(PlanCommand, ThreadsChangeNothing) {
  const json one = plan("shape:torus", {"--json", "-", "--jobs", "1"}).json();
  const json three = plan("shape:torus", {"--json", "-", "--jobs", "3"}).json();
  EXPECT_EQ(without_times(one), without_times(three));
}

class PlanGcode : public PlanCommand {
 protected:
  void expect_agreement(const std::string& model, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--json", "-", "--gcode", in_folder("a.gcode")});
    const ProgramRun planned = plan(model, more);
    ASSERT_LE(planned.exit_code, 1) << planned.err;
    const json totals = planned.json()["totals"];
    const test::GcodeRun run = test::read_gcode(test::content_of(in_folder("a.gcode")));
    const auto total = [&](const char* name) { return totals[name].get<double>(); };
    EXPECT_NEAR(run.extrude_mm, total("extrude_mm"), 1e-3 * total("extrude_mm")) << model;
    EXPECT_NEAR(run.travel_mm, total("travel_mm"), 1e-3 * total("travel_mm")) << model;
    EXPECT_EQ(run.retractions, total("retractions")) << model;
    EXPECT_NEAR(run.longest_travel_mm, total("max_travel_mm"), 1e-5) << model;
    const double section = std::acos(-1.0) / 4 * 1.75 * 1.75;
    EXPECT_NEAR(run.filament_mm * section, total("filament_mm3"), 1e-3 * total("filament_mm3"));
    EXPECT_NEAR(run.pulled_mm, 0, 1e-9) << "what was pulled comes back";
  }
};

TEST_F(PlanGcode, AnIndependentReaderFindsWhatTheJudgeFound) {
  for (const char* model : {"shape:torus", "shape:sphere", kModel}) expect_agreement(model);
}

TEST_F(PlanGcode, AlsoOnRealPartsUnderEveryPolicy) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  const std::string model = (models / "islands" / "hundred_cubes.stl").string();
  for (const char* policy : {"length", "length_and_crossing", "manhattan"})
    for (const char* order : {"island", "stage"})
      expect_agreement(model,
                       {"--layers", "2..4", "--order", order, "--printer",
                        std::string("retract_policy=") + policy, "--printer", "lift_mm=0.4"});
}

TEST_F(PlanCommand, LayersOfAFileScoreLikeTheModelTheyCameFrom) {
  ASSERT_EQ(call({"slice", "shape:torus", "--wkt", in_folder("torus.wkt")}).exit_code, 0);
  json of_mesh = without_times(plan("shape:torus", {"--json", "-"}).json());
  json of_file = without_times(plan(in_folder("torus.wkt"), {"--json", "-"}).json());
  EXPECT_TRUE(of_file["mesh"].is_null());
  EXPECT_EQ(of_file["totals"], of_mesh["totals"]);
  EXPECT_EQ(of_file["per_layer"], of_mesh["per_layer"]);
}

TEST_F(PlanCommand, WithoutJudgingTheRoutesAreTheSameAndNothingIsClaimed) {
  const std::string model = "shape:hotend?size=15";
  const std::string judged = in_folder("judged.gcode"), planned = in_folder("planned.gcode");
  ASSERT_EQ(plan(model, {"--gcode", judged, "--jobs", "1"}).exit_code, 0);
  const ProgramRun run =
      plan(model, {"--gcode", planned, "--no-judge", "--jobs", "3", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(test::content_of(judged), test::content_of(planned));
  const json document = run.json();
  for (const char* key : {"outcome", "reason", "totals", "per_layer"})
    EXPECT_TRUE(document[key].is_null()) << key;
  EXPECT_GT(document["layers"], 0);
  const ProgramRun table = plan(model, {"--no-judge"});
  EXPECT_NE(table.out.find("outcome    planned, not judged\n"), std::string::npos);
  EXPECT_EQ(table.out.find("Travel"), std::string::npos);
}

TEST_F(PlanCommand, PlatesOfEqualLayersAreWrittenAsIfEachLayerWerePlanned) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--layers", "1,4..30"}, {"--printer", "lift_mm=0.3"}}) {
    const auto gcode_of = [&](std::vector<std::string> options) {
      options.insert(options.end(), more.begin(), more.end());
      options.insert(options.end(), {"--gcode", in_folder("plate.gcode")});
      const ProgramRun run = plan("shape:islands?count=5&size=25&height=8", options);
      EXPECT_LE(run.exit_code, 1) << run.err;
      return test::content_of(in_folder("plate.gcode"));
    };
    const std::string judged = gcode_of({"--jobs", "1"});
    EXPECT_GT(judged.size(), 10000u);
    for (const char* jobs : {"1", "2", "4"})
      EXPECT_TRUE(gcode_of({"--no-judge", "--jobs", jobs}) == judged) << jobs << " jobs";
  }
}

TEST_F(PlanCommand, ChosenLayersAreThoseOfTheWholeModel) {
  const json all = without_times(plan(kModel, {"--json", "-"}).json());
  const json some = without_times(plan(kModel, {"--json", "-", "--layers", "10..12,3"}).json());
  EXPECT_EQ(some["layers"], 4);
  std::vector<std::size_t> indices;
  for (const json& layer : some["per_layer"]) {
    indices.push_back(layer["layer"]);
    // Skins were found with all layers there: what is deposited is the same.
    EXPECT_EQ(layer["extrude_mm"], all["per_layer"][indices.back()]["extrude_mm"]);
  }
  EXPECT_EQ(indices, (std::vector<std::size_t>{3, 10, 11, 12}));
}

TEST_F(PlanCommand, DrawsEveryLayer) {
  const ProgramRun run = plan(kModel, {"--layers", "0..2", "--svg", in_folder("pictures")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"layer_0000.svg", "layer_0001.svg", "layer_0002.svg"}) {
    const std::string svg = test::content_of(folder_ / "pictures" / name);
    EXPECT_NE(svg.find("id=\"start\""), svg.npos) << name;
    EXPECT_NE(svg.find("</svg>"), svg.npos) << name;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "pictures"), {}), 3);
}

TEST_F(PlanCommand, ThePeoplesTableNamesUnitsAndTheVerdict) {
  const ProgramRun run = plan(kModel, {});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.out.find("outcome    valid\n"), run.out.npos) << run.out;
  EXPECT_NE(run.out.find("Travel "), run.out.npos);
  EXPECT_NE(run.out.find(" mm\n"), run.out.npos);
  EXPECT_EQ(run.err, "");
}

TEST_F(PlanCommand, WhatIsNotValidIsSaidAndExitsWithOne) {
  const ProgramRun run = plan(kModel, {"--json", "-"}, {"--shell", "greedy_shell"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.json()["outcome"], "off_task");
  EXPECT_NE(run.json()["reason"], "");
  EXPECT_TRUE(run.json()["contender"]["fill"].is_null());
}

TEST_F(PlanCommand, APlannerThatBreaksItsContractHasFailed) {
  for (const char* wrong : {"one_point", "not_finite", "no_width", "exception", "number"}) {
    const ProgramRun run =
        plan(kModel,
             {"--json", "-", "--plugin", kToys, "--set", std::string("fill.wrong=") + wrong,
              "--gcode", in_folder("a.gcode")},
             {"--fill", "wrongdoer"});
    EXPECT_EQ(run.exit_code, 1) << wrong << run.err;
    EXPECT_EQ(run.json()["outcome"], "failed");
    EXPECT_NE(run.json()["reason"].get<std::string>().find("planner wrongdoer, layer 0: "),
              std::string::npos);
    EXPECT_TRUE(run.json()["totals"]["travel_mm"].is_null()) << "absence is null, not zero";
    EXPECT_TRUE(fs::is_empty(folder_)) << "there is no route to write";
  }
}

TEST_F(PlanCommand, ParametersAndSeedsReachThePlanners) {
  const json straight = plan(kModel, {"--json", "-", "--set", "fill.angle_deg=30"}).json();
  EXPECT_EQ(straight["contender"]["fill"]["params"]["angle_deg"], 30);
  const auto told = [&](const char* seed) {
    return plan(kModel, {"--json", "-", "--plugin", kToys, "--seed", seed, "--layers", "0"},
                {"--fill", "seed_teller"})
        .json()["totals"]["extrude_mm"];
  };
  EXPECT_EQ(told("5"), told("5"));
  EXPECT_NE(told("5"), told("6"));
}

TEST_F(PlanCommand, WritesWholeFilesOrNone) {
  const ProgramRun run = plan(
      kModel, {"--layers", "0", "--json", in_folder("a.json"), "--gcode", in_folder("a.gcode")});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(json::parse(test::content_of(in_folder("a.json")))["layers"], 1);
  fs::remove(in_folder("a.json"));
  fs::remove(in_folder("a.gcode"));
  expect_refused({"plan", kModel, "--fill", "rectilinear", "--gcode", in_folder("a.gcode"),
                  "--json", "/dev/null/a.json"},
                 "/dev/null/a.json: cannot be written: /dev/null is not a folder");
  expect_refused({"plan", kModel, "--fill", "rectilinear", "--svg", in_folder("new/pictures"),
                  "--json", "/dev/null/a.json"},
                 "/dev/null/a.json");
  expect_refused({"plan", kModel, "--fill", "rectilinear", "--gcode", in_folder("a"), "--json",
                  in_folder("a")},
                 "named for two outputs");
}

TEST_F(PlanCommand, MakesTheFoldersThatItsOutputsName) {
  const ProgramRun run =
      plan(kModel, {"--layers", "0", "--json", in_folder("x/y/a.json"), "--gcode",
                    in_folder("x/z/a.gcode"), "--svg", in_folder("p/q")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* file : {"x/y/a.json", "x/z/a.gcode", "p/q/layer_0000.svg"})
    EXPECT_TRUE(fs::is_regular_file(in_folder(file))) << file;
}

TEST_F(PlanCommand, APlannerThatEndsTheProgramIsNoSuccess) {
  const ProgramRun run = call({"plan", kModel, "--fill", "culprit", "--set", "fill.crime=exit",
                               "--plugin", ROUTEBENCH_CULPRIT_PLUGIN});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "routebench: a planner has ended the program before its work was done\n");
}

TEST_F(PlanCommand, AFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  expect_refused({"plan", kModel, "--fill", "rectilinear", "--gcode", "/dev/full"}, "/dev/full");
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--json", "-"}}) {
    std::vector<std::string> arguments = {"plan", kModel, "--fill", "rectilinear"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = call(arguments, "/dev/full");
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find("standard output"), run.err.npos) << run.err;
  }
}

TEST_F(PlanCommand, BadUsageIsOneLineThatHelps) {
  const auto refused = [&](std::vector<std::string> more, const std::string& part) {
    std::vector<std::string> arguments = {"plan", kModel};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_refused(arguments, part);
  };
  refused({}, "no planner: give --shell NAME, --fill NAME or both");
  refused({"--shell", "rectilinear"}, "rectilinear is no shell planner");
  refused({"--shell", "greedy_shel"}, "greedy_shell");
  const std::vector<std::string> fill = {"--fill", "rectilinear"};
  const auto with_fill = [&](std::vector<std::string> more, const std::string& part) {
    more.insert(more.begin(), fill.begin(), fill.end());
    refused(more, part);
  };
  with_fill({"--set", "fill.angel_deg=3"}, "angle_deg");
  with_fill({"--set", "fill.angle_deg=steep"}, "'steep'");
  with_fill({"--set", "fill.angle_deg"}, "write key=value");
  with_fill({"--set", "angle_deg=3"}, "names no slot");
  with_fill({"--set", "shell.perimeters=3"}, "give --shell too");
  with_fill({"--task", "layer_hight_mm=0.3"}, "layer_height_mm");
  with_fill({"--task", "layer_height_mm=high"}, "'high'");
  with_fill({"--task", "line_width_mm=0.1"}, "a bead is at least as wide");
  with_fill({"--printer", "retract_police=length"}, "retract_policy");
  with_fill({"--printer", "flavour=marlyn"}, "marlin");
  with_fill({"--layers", "1000000"}, "there is no layer 1000000; the model has layers 0..");
  with_fill({"--layers", "5..3"}, "'5..3'");
  with_fill({"--layers", "3,"}, "''");
  with_fill({"--layers", "-1"}, "--layers");
  with_fill({"--order", "isle"}, "it is island or stage");
  with_fill({"--plugin", "/no/such/plugin.so"}, "plugin /no/such/plugin.so: refused: ");
  with_fill({"--jobs", "many"}, "--jobs");
  with_fill({"--seed", "-1"}, "--seed");
  with_fill({"--shel", "greedy_shell"}, "did you mean '--shell'?");
  expect_refused({"plan", in_folder("missing.stl"), "--fill", "rectilinear"}, "missing.stl");
  expect_refused({"plan", in_folder("missing.wkt"), "--fill", "rectilinear"}, "missing.wkt");
  expect_refused({"plan"}, "MODEL");
}

TEST_F(PlanCommand, LayersOfAnotherHeightThanTheTasksAreRefused) {
  ASSERT_EQ(call({"slice", kModel, "--task", "layer_height_mm=0.3", "--wkt", in_folder("a.wkt")})
                .exit_code,
            0);
  const ProgramRun run = plan(in_folder("a.wkt"), {});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("layer 0 is 0.3 mm high but the task's layer_height_mm is 0.2"),
            run.err.npos)
      << run.err;
  EXPECT_EQ(plan(in_folder("a.wkt"), {"--task", "layer_height_mm=0.3"}).exit_code, 0);
}

}  // namespace
}  // namespace routebench
