/// The command score, and the pairing of layers behind it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include "models.hpp"
#include "program.hpp"
#include "random_polygons.hpp"
#include "routebench/harness/gcode_score.hpp"
#include "routebench/harness/metrics.hpp"

namespace routebench {
namespace {

using nlohmann::json;
using test::keys_of;
using test::ProgramRun;

std::vector<Layer> layers_of(int count, double height_mm) {
  std::vector<Layer> layers;
  for (int i = 0; i < count; ++i)
    layers.push_back({.index = i,
                      .z_mm = (i + 0.5) * height_mm,
                      .height_mm = height_mm,
                      .polygons = {{test::rectangle(0, 0, 10, 20), {}}},
                      .solid = {}});
  return layers;
}

/// Layers of a file at these heights, each with a wall round a rectangle and one stroke that is
/// none.
std::vector<GcodeLayer> file_layers(const std::vector<double>& z_mm, Point2 lower = {0, 0}) {
  std::vector<GcodeLayer> layers;
  for (const double z : z_mm)
    layers.push_back({z,
                      0.2,
                      {{{{lower, {lower.x + 9, lower.y}, {lower.x + 9, lower.y + 19}}, 0.45},
                        {{{-100, -100}, {100, 500}}, 0.45}}},
                      {StrokeKind::kWall, std::nullopt}});
  return layers;
}

TEST(GcodeScore, LayersPairByTheirTops) {
  using Pairs = std::vector<std::optional<std::size_t>>;
  const std::vector<Layer> model = layers_of(4, 0.2);  // tops 0.2 0.4 0.6 0.8
  const auto pairs = [&](const std::vector<double>& z) {
    return pair_layers(model, file_layers(z));
  };
  EXPECT_EQ(pairs({0.2, 0.4, 0.6, 0.8}).file_layers, (Pairs{0, 1, 2, 3}));
  EXPECT_EQ(pairs({0.3, 0.5, 0.7, 0.9}).file_layers, (Pairs{0, 1, 2, 3}))
      << "a thicker first layer";
  const LayerPairs gaps = pairs({0.6, 0.62, 1.4});
  EXPECT_EQ(gaps.file_layers, (Pairs{std::nullopt, std::nullopt, 0, std::nullopt}));
  EXPECT_EQ(gaps.unpaired, (std::vector<std::size_t>{1, 2}));
  const LayerPairs nearer = pairs({0.33, 0.4});
  EXPECT_EQ(nearer.file_layers, (Pairs{std::nullopt, 1, std::nullopt, std::nullopt}));
  EXPECT_EQ(nearer.unpaired, std::vector<std::size_t>{0});
  EXPECT_EQ(pair_layers({}, file_layers({0.2})).unpaired.size(), 1u);
}

TEST(GcodeScore, BoxesOfWallsAreAligned) {
  const std::vector<Layer> model = layers_of(3, 0.2);
  const auto offset = [&](Point2 lower) {
    std::vector<GcodeLayer> file = file_layers({0.2, 0.4, 0.6}, lower);
    // One layer with something beside the part does no harm.
    file[0].route.strokes[0].points.push_back({300, 0});
    return offset_to_model(model, file, pair_layers(model, file), 0.45);
  };
  EXPECT_EQ(offset({0.5, 0.5}), (Point2{0, 0}));
  EXPECT_EQ(offset({-20.5, 100.5}), (Point2{21, -100}));
  EXPECT_EQ(offset({0.7, 0.4}), (Point2{0, 0})) << "less than half a line is no shift";
  EXPECT_NE(offset({0.8, 0.5}), (Point2{0, 0}));
}

class ScoreCommand : public test::ProgramTest {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  /// Plans a model, writes its G-code, and returns the document.
  json planned(const std::string& model, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"plan",    model,
                                          "--shell", "greedy_shell",
                                          "--fill",  "rectilinear",
                                          "--gcode", in_folder("a.gcode"),
                                          "--json",  "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramRun run = call(arguments);
    EXPECT_LE(run.exit_code, 1) << run.err;
    return run.json();
  }
  ProgramRun score(std::vector<std::string> more, const std::string& file = "a.gcode") {
    std::vector<std::string> arguments = {"score", in_folder(file), "--json", "-"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(arguments);
  }
};

/// Every metric but those of planning within 0.1 %, counts exactly.
void expect_same_scores(const json& planned, const json& scored, const std::string& what) {
  for (const MetricInfo& metric : metric_table()) {
    const std::string name(metric.name);
    const json& one = planned["totals"][name];
    const json& other = scored["totals"][name];
    if (name.starts_with("plan_") || name == "peak_rss_bytes") {
      EXPECT_TRUE(other.is_null()) << what << name;
      continue;
    }
    ASSERT_EQ(one.is_null(), other.is_null()) << what << name;
    if (one.is_null()) continue;
    EXPECT_NEAR(one.get<double>(), other.get<double>(), 1e-3 * std::abs(one.get<double>()))
        << what << name;
  }
  EXPECT_EQ(planned["outcome"], scored["outcome"]) << what;
  EXPECT_EQ(planned["reason"], scored["reason"]) << what;
  EXPECT_EQ(planned["layers"], scored["layers"]) << what;
}

TEST_F(ScoreCommand, ARouteReadBackScoresTheSame) {
  for (const std::string model :
       {"shape:box?size=12", "shape:torus", "shape:gear?teeth=9", "shape:comb", "shape:islands"}) {
    const json plan = planned(model, {"--layers", "0..5"});
    const json scored = score({"--model", model, "--layers", "0..5"}).json();
    expect_same_scores(plan, scored, model + " ");
    EXPECT_EQ(scored["offset_mm"], (json{0, 0})) << model;
    EXPECT_EQ(scored["file_retractions"], plan["totals"]["retractions"]) << model;
    EXPECT_EQ(scored["paired_layers"], plan["layers"]) << model;
    EXPECT_TRUE(scored["warnings"].empty()) << scored["warnings"];
  }
}

TEST_F(ScoreCommand, AlsoUnderOtherTasksOrdersPoliciesAndFlavours) {
  const std::string model = "shape:bracket";
  const auto same = [&](const std::vector<std::string>& plan_more,
                        const std::vector<std::string>& both) {
    std::vector<std::string> all = plan_more, again = {"--model", model};
    for (std::vector<std::string>* arguments : {&all, &again}) {
      arguments->insert(arguments->end(), {"--layers", "3,5..8"});
      arguments->insert(arguments->end(), both.begin(), both.end());
    }
    const json plan = planned(model, all);
    expect_same_scores(plan, score(again).json(), both.empty() ? "" : both.back() + " ");
  };
  for (const char* policy : {"length", "length_and_crossing", "manhattan"})
    same({}, {"--printer", "lift_mm=0.3", "--printer", std::string("retract_policy=") + policy});
  same({"--set", "fill.angle_deg=30", "--order", "stage"}, {"--task", "density=1"});
  for (const char* flavour : {"klipper", "reprap", "ultigcode"})
    same({}, {"--printer", std::string("flavour=") + flavour});
  same({}, {"--task", "line_width_mm=0.6", "--task", "layer_height_mm=0.3"});
}

TEST_F(ScoreCommand, TheRoutesOfEveryPlannerScoreTheSame) {
  const json known = call({"planners", "--json"}).json();
  for (const json& planner : known["planners"]) {
    const std::string name = planner["name"];
    const bool shell = planner["role"] == "shell";
    const ProgramRun run = call(
        {"plan", "shape:bracket", "--layers", "1..4", "--gcode", in_folder("a.gcode"), "--json",
         "-", "--shell", shell ? name : "greedy_shell", "--fill", shell ? "rectilinear" : name});
    ASSERT_LE(run.exit_code, 1) << run.err;
    expect_same_scores(run.json(), score({"--model", "shape:bracket", "--layers", "1..4"}).json(),
                       name + " ");
  }
}

TEST_F(ScoreCommand, TheWallsOrTheFillingAloneAreAlignedToo) {
  for (const std::vector<std::string>& planner :
       {std::vector<std::string>{"--shell", "greedy_shell"},
        std::vector<std::string>{"--fill", "rectilinear"}}) {
    std::vector<std::string> arguments = {
        "plan", "shape:box?size=12", "--gcode", in_folder("a.gcode"), "--json", "-"};
    arguments.insert(arguments.end(), planner.begin(), planner.end());
    const json plan = call(arguments).json();
    const ProgramRun run = score({"--model", "shape:box?size=12"});
    EXPECT_EQ(run.exit_code, 1) << "half a task is off task";
    expect_same_scores(plan, run.json(), planner[1] + " ");
  }
}

TEST_F(ScoreCommand, AFileElsewhereOnTheBedIsMovedToTheModel) {
  const std::string model = "shape:gear?teeth=9";
  const json plan = planned(model, {"--layers", "0..5"});
  // The same file with its origin shifted: what G92 calls 0 is 100, -50.
  std::string text = test::content_of(in_folder("a.gcode"));
  text.insert(text.find("G21"), "G28\nG0 X100 Y-50\nG92 X0 Y0\n");
  write("b.gcode", text);
  const std::vector<std::string> arguments = {"--model", model, "--layers", "0..5"};
  const auto score_at = [&](const std::string& offset) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--offset", offset});
    return score(all, "b.gcode");
  };
  const json found = score(arguments, "b.gcode").json();
  EXPECT_NEAR(found["offset_mm"][0].get<double>(), -100, 0.02);
  EXPECT_NEAR(found["offset_mm"][1].get<double>(), 50, 0.02);
  EXPECT_EQ(found["outcome"], "valid");
  expect_same_scores(plan, score_at("-100,50").json(), "");
  const ProgramRun wrong = score_at("0,0");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(wrong.json()["totals"]["covered"], 0);
}

TEST_F(ScoreCommand, LayersWithoutCounterpartAreReported) {
  planned("shape:box?size=12", {"--layers", "0..9"});
  const ProgramRun half = score({"--model", "shape:box?size=12"});
  EXPECT_EQ(half.exit_code, 1) << "what is not printed is not done";
  const json document = half.json();
  EXPECT_EQ(document["paired_layers"], 10);
  EXPECT_EQ(document["missing_layers"].size(), document["layers"].get<std::size_t>() - 10);
  EXPECT_EQ(document["missing_layers"][0], 10);
  EXPECT_EQ(document["totals"]["worst_layer"], 1);
  EXPECT_EQ(score({"--model", "shape:box?size=12", "--layers", "0..9"}).exit_code, 0);

  planned("shape:box?x=12&y=12&z=2");
  const json higher = score({"--model", "shape:box?x=12&y=12&z=1"}).json();
  EXPECT_EQ(higher["unpaired_z_mm"].size(), 5u);
  EXPECT_NEAR(higher["unpaired_z_mm"][0].get<double>(), 1.2, 1e-9);
  EXPECT_EQ(higher["outcome"], "off_task") << "what is not judged is not valid";
  EXPECT_TRUE(higher["reason"].get<std::string>().ends_with(
      "5 of 10 layers of the G-code are none of the model's, the first at z = 1.2 mm"))
      << higher["reason"];
}

TEST_F(ScoreCommand, WithoutAModelWhatNeedsNoneIsMeasured) {
  const json plan = planned("shape:torus", {"--layers", "0..9"});
  const ProgramRun run = score({});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const json scored = run.json();
  const std::set<std::string> absent = {
      "crossings",      "travel_outside_mm", "hollow_mm",    "covered",
      "skipped",        "worst_layer",       "deposit",      "doubled",
      "spilled",        "outline_covered",   "plan_wall_ns", "plan_cpu_ns",
      "peak_rss_bytes", "job_wall_s",        "job_cpu_s",    "stated_time_s"};
  for (const MetricInfo& metric : metric_table()) {
    const std::string name(metric.name);
    const json& value = scored["totals"][name];
    EXPECT_EQ(value.is_null(), absent.contains(name)) << name;
    if (value.is_null()) continue;
    const double expected = plan["totals"][name].get<double>();
    EXPECT_NEAR(value.get<double>(), expected, 1e-3 * expected) << name;
  }
  EXPECT_TRUE(scored["outcome"].is_null());
  EXPECT_TRUE(scored["offset_mm"].is_null());
  const json by_crossing = score({"--printer", "retract_policy=length_and_crossing"}).json();
  EXPECT_TRUE(by_crossing["totals"]["retractions"].is_null()) << "that needs the polygons";
  EXPECT_TRUE(by_crossing["totals"]["print_time_s"].is_null());
  EXPECT_FALSE(by_crossing["totals"]["print_extrude_s"].is_null());
  EXPECT_FALSE(by_crossing["file_retractions"].is_null());
}

TEST_F(ScoreCommand, PrintsOneObjectWithTheMetricsOfPlan) {
  const json plan = planned("shape:box?size=12");
  const json scored = score({"--model", "shape:box?size=12"}).json();
  EXPECT_EQ(keys_of(scored["totals"]), keys_of(plan["totals"]));
  EXPECT_EQ(keys_of(scored["per_layer"][0]), keys_of(plan["per_layer"][0]));
  EXPECT_EQ(keys_of(scored), (std::set<std::string>{"file",
                                                    "model",
                                                    "task",
                                                    "printer",
                                                    "outcome",
                                                    "reason",
                                                    "layers",
                                                    "offset_mm",
                                                    "z_offset_mm",
                                                    "paired_layers",
                                                    "missing_layers",
                                                    "unpaired_z_mm",
                                                    "file_layers",
                                                    "file_retractions",
                                                    "file_travel_mm",
                                                    "file_filament_mm3",
                                                    "file_excluded_strokes",
                                                    "file_excluded_mm",
                                                    "file_ignored",
                                                    "totals",
                                                    "per_layer",
                                                    "mesh",
                                                    "warnings"}));
  EXPECT_NEAR(scored["file_filament_mm3"].get<double>(),
              scored["totals"]["filament_mm3"].get<double>(), 0.1);
  const ProgramRun table = call({"score", in_folder("a.gcode"), "--model", "shape:box?size=12"});
  EXPECT_EQ(table.exit_code, 0);
  for (const char* part : {"outcome    valid\n", "offset     0, 0 mm\n", "Retractions of the file"})
    EXPECT_NE(table.out.find(part), std::string::npos) << table.out;
}

TEST_F(ScoreCommand, AnOffsetOfHeightsTakesARaftAway) {
  planned("shape:box?size=12");
  const json flat = score({"--model", "shape:box?size=12"}).json();
  EXPECT_EQ(flat["z_offset_mm"], 0);
  EXPECT_TRUE(flat["warnings"].empty()) << flat["warnings"];
  std::istringstream lines(test::content_of(in_folder("a.gcode")));
  std::string raised;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("G1 Z")) line = "G1 Z" + std::to_string(std::stod(line.substr(4)) + 0.9);
    raised += line + '\n';
  }
  write("a.gcode", raised);
  const json misplaced = score({"--model", "shape:box?size=12"}).json();
  EXPECT_EQ(misplaced["outcome"], "off_task");
  EXPECT_NE(misplaced["warnings"].dump().find("its lowest layer lies 0.9 mm above the model's"),
            std::string::npos)
      << misplaced["warnings"];
  const json taken_away = score({"--model", "shape:box?size=12", "--z-offset", "-0.9"}).json();
  EXPECT_EQ(taken_away["z_offset_mm"], -0.9);
  EXPECT_EQ(taken_away["totals"], flat["totals"]);
  EXPECT_EQ(taken_away["warnings"], flat["warnings"]);
}

TEST_F(ScoreCommand, AnotherLayerHeightIsSaid) {
  planned("shape:box?size=12", {"--task", "layer_height_mm=0.3"});
  const json scored = score({"--model", "shape:box?size=12"}).json();
  ASSERT_FALSE(scored["warnings"].empty());
  EXPECT_NE(scored["warnings"][0].get<std::string>().find(
                "layers are not as high as the task's layer_height_mm = 0.2"),
            std::string::npos)
      << scored["warnings"];
}

TEST_F(ScoreCommand, ExtrudedTravelsAreCaught) {
  planned("shape:islands", {"--layers", "0..3"});
  // Every travel pushes filament: no travel at all, and strokes across the gaps.
  std::string text = test::content_of(in_folder("a.gcode"));
  for (std::size_t at = text.find("\nG1 X"); (at = text.find("\nG0 X", at)) != text.npos; ++at) {
    const std::size_t end = text.find('\n', at + 1);
    text.insert(end, " E1.5");  // more than was pulled back
  }
  write("b.gcode", text);
  const ProgramRun run = score({"--model", "shape:islands", "--layers", "0..3"}, "b.gcode");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.json()["outcome"], "off_task");
  EXPECT_NE(run.json()["reason"].get<std::string>().find("hollow_mm"), std::string::npos);
}

TEST_F(ScoreCommand, MarksThatEGivesTheLieAreCaught) {
  planned("shape:box?size=12");
  const std::string text = test::content_of(in_folder("a.gcode"));
  const auto scored_with_e = [&](double share) {
    std::string other;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line); other += line + "\n") {
      const std::size_t e = line.find(" E");
      if (!line.starts_with("G1 X") || e == line.npos) continue;
      const std::size_t end = std::min(line.find(' ', e + 1), line.size());
      const double value = std::stod(line.substr(e + 2, end - e - 2));
      line.replace(e, end - e, " E" + std::to_string(share * value));
    }
    write("b.gcode", other);
    return score({"--model", "shape:box?size=12"}, "b.gcode").json();
  };
  for (const double share : {0.9, 1.0, 1.1}) EXPECT_EQ(scored_with_e(share)["outcome"], "valid");
  for (const double share : {0.01, 0.8, 1.2}) {
    const json scored = scored_with_e(share);
    EXPECT_EQ(scored["outcome"], "off_task") << share;
    EXPECT_TRUE(scored["reason"].get<std::string>().starts_with("its E makes "))
        << scored["reason"];
  }
}

TEST_F(ScoreCommand, BadFilesAndBadUsageAreRefused) {
  expect_refused({"score", in_folder("none.gcode")},
                 "none.gcode: cannot be opened: No such file or directory");
  expect_refused({"score", "/"}, "is a folder");
  expect_refused({"score"}, "FILE");
  expect_refused({"score", "/dev/null"}, "/dev/null: lays no material");
  expect_refused({"score", "/dev/null", "--offset", "1,2"}, "--offset means nothing without");
  expect_refused({"score", "/dev/null", "--z-offset", "1"}, "--z-offset means nothing without");
  expect_refused({"score", "/dev/null", "--model", "shape:box", "--z-offset", "nan"},
                 "--z-offset: nan is no height");
  expect_refused({"score", "/dev/null", "--layers", "1"}, "--layers means nothing without");
  for (const char* offset : {"1", "1,", ",1", "1,2,3", "a,b", "1;2", "nan,0", "1e9,0"})
    expect_refused({"score", "/dev/null", "--model", "shape:box", "--offset", offset},
                   "--offset: '");
}

TEST_F(ScoreCommand, AMalformedFileIsRefusedByLine) {
  write("bad.gcode", "G28\nM83\nG1 X1 E1\nG1 X2 Ebad\n");
  const ProgramRun run = call({"score", in_folder("bad.gcode")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find("bad.gcode:4: "), std::string::npos) << run.err;
}

}  // namespace
}  // namespace routebench
