/// What the judge says of slicers' G-code, against a scorer that was written apart from it and
/// against the slicer's own estimate of the time.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "gcode_texts.hpp"
#include "routebench/harness/gcode_score.hpp"
#include "routebench/harness/gcode_writer.hpp"
#include "routebench/harness/parallel.hpp"
#include "sliced_abroad.hpp"

namespace routebench {
namespace {

using nlohmann::json;
using test::ScratchDir;

/// What a file's figures are by a scorer of our own.
json independent_score(const std::filesystem::path& file) {
  const std::string out = file.string() + ".json";
  const std::string command =
      "/usr/bin/python3 tests/harness/independent_scorer.py '" + file.string() + "' >'" + out + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  return json::parse(test::text_of_file(out));
}

/// Lengths must agree within 0.1 %, counts and volume within 0.5 %.
void expect_agreement(const std::filesystem::path& file, const Judge& judge) {
  const GcodePrint print = read_gcode_file(file, {});
  const Scores totals = score_gcode(judge, print, serial_for).cell.totals;
  const json other = independent_score(file);
  const auto expect_near = [&](const char* name, double ours, double share) {
    const double theirs = other[name].get<double>();
    EXPECT_GT(theirs, 0) << name;
    EXPECT_NEAR(ours, theirs, share * theirs) << name;
  };
  for (const char* name : {"extrude_mm", "travel_mm"})
    expect_near(name, totals[metric_index(name)].value(), 0.001);
  for (const char* name : {"strokes", "retractions", "filament_mm3"})
    expect_near(name, totals[metric_index(name)].value(), 0.005);
  expect_near("file_retractions", static_cast<double>(print.retractions), 0.005);
}

class ForeignPrint : public testing::TestWithParam<const char*> {
 protected:
  ScratchDir dir_;
};

TEST_P(ForeignPrint, AnIndependentScorerAgrees) {
  const slicers::SlicerKind* kind = test::installed_slicer(GetParam());
  if (kind == nullptr) GTEST_SKIP() << GetParam() << " is not installed";
  Task task;
  task.skin_layers = 2;
  const Judge judge(task, Printer{});
  for (const char* model : {"shape:gear?size=25", "shape:islands?size=25"}) {
    ASSERT_EQ(test::slice_abroad(*kind, model, task, Printer{}, dir_.path()), 0)
        << test::text_of_file(dir_.path() / "log");
    SCOPED_TRACE(model);
    expect_agreement(dir_.path() / "model.gcode", judge);
  }
}

INSTANTIATE_TEST_SUITE_P(Slicers, ForeignPrint,
                         testing::Values("prusa-slicer", "slic3r", "cura-engine"),
                         [](const testing::TestParamInfo<const char*>& slicer) {
                           std::string name = slicer.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(OwnPrint, AnIndependentScorerAgrees) {
  const ScratchDir dir;
  const Task task;
  const PlannerSet planners = load_planners({});
  const Contender contender(
      {.name = "ours", .shell = SlotSpec{"greedy_shell", {}}, .fill = SlotSpec{"rectilinear", {}}},
      planners.registry);
  const PreparedModel model = prepare_model("shape:gear?size=25", task, {}, serial_for);
  const std::vector<PlannedLayer> planned =
      plan_layers(contender, model, all_layers(model.sliced), task, 1, {}, serial_for);
  const std::filesystem::path file = dir.path() / "a.gcode";
  {
    std::ofstream out(file);
    GcodeWriter writer(out, task, Printer{}, {});
    std::vector<RoutedLayer> layers;
    for (std::size_t i = 0; i < planned.size(); ++i)
      layers.push_back({&model.sliced.layers[i], &planned[i]});
    writer.write_layers(layers);
    writer.finish();
  }
  expect_agreement(file, Judge(task, Printer{}));
}

/// Walks on a grid in layers of 0.3 mm, as programs of researchers write them: no marks, no speeds,
/// no start, E the way that was printed. Here and there the nozzle goes elsewhere with the filament
/// pulled back.
std::string walks_on_a_grid(std::uint64_t seed) {
  constexpr double kStepMm = 0.75;
  constexpr int kLayers = 40, kSteps = 300, kHalfSize = 13;
  constexpr std::array<std::array<int, 2>, 4> kWays = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> anywhere(-kHalfSize, kHalfSize), way(0, 3), chance(0, 49);
  int x = anywhere(random), y = anywhere(random);
  double e_mm = 0;
  bool printed = false;  // since the filament was pulled back
  std::string text = "; a walk\n";
  const auto go = [&](double e) {
    text += "G1 X" + test::number(x * kStepMm) + " Y" + test::number(y * kStepMm) + " E" +
            test::number(e) + "\n";
  };
  for (int layer = 1; layer <= kLayers; ++layer) {
    text += "G1 Z" + test::number(layer * 3 / 10.0) + "\n";
    go(e_mm);
    for (int step = 0; step < kSteps; ++step) {
      if (printed && chance(random) == 0) {
        printed = false;
        text += "G1 E" + test::number(e_mm - 1) + "\n";
        x = anywhere(random);
        y = anywhere(random);
        go(e_mm - 1);
        text += "G1 E" + test::number(e_mm) + "\n";
        continue;
      }
      const auto [dx, dy] = kWays.at(static_cast<std::size_t>(way(random)));
      if (std::abs(x + dx) > kHalfSize || std::abs(y + dy) > kHalfSize) continue;
      x += dx;
      y += dy;
      go(e_mm += kStepMm);
      printed = true;
    }
  }
  return text;
}

TEST(UnmarkedPrint, AnIndependentScorerAgrees) {
  const ScratchDir dir;
  Task task;
  task.layer_height_mm = 0.3;
  const std::filesystem::path file = dir.path() / "walk.gcode";
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    std::ofstream(file) << walks_on_a_grid(seed);
    SCOPED_TRACE(seed);
    expect_agreement(file, Judge(task, Printer{}));
  }
}

/// The look-ahead model against another program's, on its own G-code.
class PrusaSlicersEstimate : public testing::TestWithParam<const char*> {};

TEST_P(PrusaSlicersEstimate, IsMetWithinOneInTwenty) {
  const slicers::SlicerKind* kind = test::installed_slicer("prusa-slicer");
  if (kind == nullptr) GTEST_SKIP() << "prusa-slicer is not installed";
  const ScratchDir dir;
  Task task;
  task.skin_layers = 2;
  Printer printer;
  printer.jerk_mm_s = 8;  // the one rule of corners that both know
  const std::string model = "shape:" + std::string(GetParam()) + "?size=20";
  ASSERT_EQ(test::slice_abroad(*kind, model, task, printer, dir.path()), 0)
      << test::text_of_file(dir.path() / "log");
  const GcodePrint print = read_gcode_file(dir.path() / "model.gcode", {});
  const Scores totals = score_gcode(Judge(task, printer), print, serial_for).cell.totals;
  ASSERT_TRUE(print.stated_time_s);
  EXPECT_GT(*print.stated_time_s, 60) << "too short to say much";
  EXPECT_NEAR(totals[metric_index("print_time_s")].value(), *print.stated_time_s,
              0.05 * *print.stated_time_s);
}

INSTANTIATE_TEST_SUITE_P(Shapes, PrusaSlicersEstimate,
                         testing::Values("box", "cylinder", "hotend", "torus", "gear", "comb",
                                         "bracket", "islands", "voronoi"),
                         [](const testing::TestParamInfo<const char*>& shape) {
                           return std::string(shape.param);
                         });

}  // namespace
}  // namespace routebench
