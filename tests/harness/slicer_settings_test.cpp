/// What slicers are told: the task and the printer, in their own words.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "slicers/slicer_kind.hpp"

namespace routebench::slicers {
namespace {

using Make = Settings (*)(const Task&, const Printer&);
constexpr Make kAll[] = {prusa_slicer_settings, slic3r_settings, cura_engine_settings};

std::map<std::string, std::string> map_of(const Settings& settings) {
  return {settings.begin(), settings.end()};
}

TEST(SlicerSettings, NoSettingIsGivenTwice) {
  for (const Make make : kAll) {
    const Settings settings = make(Task{}, Printer{});
    EXPECT_EQ(map_of(settings).size(), settings.size());
  }
}

TEST(SlicerSettings, NoValueCanBreakOutOfItsLine) {
  for (const Make make : kAll)
    for (const auto& [key, value] : make(Task{}, Printer{}))
      EXPECT_EQ((key + value).find_first_of("\n\r=;"), std::string::npos) << key << " " << value;
}

/// Every key of the task and the printer that a slicer can follow changes what it is told.
TEST(SlicerSettings, FollowTaskAndPrinter) {
  const std::pair<const char*, const char*> task_changes[] = {
      {"layer_height_mm", "0.15"}, {"line_width_mm", "0.5"}, {"perimeters", "3"},
      {"density", "0.35"},         {"skin_layers", "4"},
  };
  const std::pair<const char*, const char*> printer_changes[] = {
      {"retract_over_mm", "1.5"}, {"retract_mm", "1"},    {"retract_mm_s", "35"},
      {"lift_mm", "0.3"},         {"extrude_mm_s", "50"}, {"travel_mm_s", "180"},
      {"filament_mm", "2.85"},
  };
  for (const Make make : kAll) {
    const Settings before = make(Task{}, Printer{});
    for (const auto& [key, value] : task_changes) {
      Task task;
      set_task_value(task, key, value);
      EXPECT_NE(make(task, Printer{}), before) << key;
    }
    for (const auto& [key, value] : printer_changes) {
      Printer printer;
      set_printer_value(printer, key, value);
      EXPECT_NE(make(Task{}, printer), before) << key;
    }
  }
  Printer printer;
  printer.accel_mm_s2 = 2000;
  EXPECT_NE(prusa_slicer_settings(Task{}, printer), prusa_slicer_settings(Task{}, Printer{}));
}

TEST(SlicerSettings, BeadsHoldTheSameVolumeEverywhere) {
  Task task;
  task.layer_height_mm = 0.25;
  task.line_width_mm = 0.6;
  // Rectangle with round ends, 0.6 wide and 0.25 high.
  const double section_mm2 = (0.6 - 0.25) * 0.25 + std::numbers::pi / 4 * 0.25 * 0.25;
  for (const Make make : {prusa_slicer_settings, slic3r_settings})
    EXPECT_EQ(map_of(make(task, Printer{})).at("extrusion_width"), "0.6");
  const auto cura = map_of(cura_engine_settings(task, Printer{}));
  EXPECT_NEAR(std::stod(cura.at("line_width")) * 0.25, section_mm2, 1e-12);
  EXPECT_NEAR(std::stod(cura.at("infill_line_distance")),
              std::stod(cura.at("line_width")) / task.density, 1e-12);
}

TEST(SlicerSettings, FirstLayerAndNozzleFitTheTask) {
  for (const double height_mm : {0.05, 0.2, 0.44}) {
    Task task;
    task.layer_height_mm = height_mm;
    for (const Make make : {prusa_slicer_settings, slic3r_settings}) {
      const auto settings = map_of(make(task, Printer{}));
      EXPECT_EQ(settings.at("first_layer_height"), settings.at("layer_height"));
      EXPECT_GE(std::stod(settings.at("nozzle_diameter")), height_mm);
    }
    const auto cura = map_of(cura_engine_settings(task, Printer{}));
    EXPECT_EQ(cura.at("layer_height_0"), cura.at("layer_height"));
  }
}

TEST(SlicerSettings, ARightAngleIsTakenAboutAsFastByJerkAsByJunctionDeviation) {
  const Printer printer;
  const double jerk =
      std::stod(map_of(prusa_slicer_settings(Task{}, printer)).at("machine_max_jerk_x"));
  // v^2 = a d sin(t/2) / (1 - sin(t/2)) at t = 90 degrees.
  const double half = std::sqrt(0.5);
  const double corner = std::sqrt(printer.accel_mm_s2 * printer.junction_mm * half / (1 - half));
  EXPECT_GT(jerk, corner) << "the change of each axis where the sides lie along the axes";
  Printer jerky;
  jerky.jerk_mm_s = 8;
  EXPECT_EQ(map_of(prusa_slicer_settings(Task{}, jerky)).at("machine_max_jerk_y"), "8");
  EXPECT_LT(jerk, 4 / std::numbers::pi * corner) << "on the mean of all directions";
}

}  // namespace
}  // namespace routebench::slicers
