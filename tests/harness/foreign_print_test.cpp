/// What the judge says of slicers' G-code, against a scorer that was written apart from it and
/// against the slicer's own estimate of the time.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

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
