/// G-code of the slicers that this machine has: what they say of it, and what the judge says.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "program.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/stl.hpp"

namespace routebench {
namespace {

using nlohmann::json;

/// What PrusaSlicer and Slic3r call the same.
constexpr const char* kSettings = R"(layer_height = 0.2
first_layer_height = 0.2
nozzle_diameter = 0.4
filament_diameter = 1.75
extrusion_width = 0.45
perimeter_extrusion_width = 0.45
external_perimeter_extrusion_width = 0.45
infill_extrusion_width = 0.45
solid_infill_extrusion_width = 0.45
top_infill_extrusion_width = 0.45
first_layer_extrusion_width = 0.45
perimeters = 2
fill_density = 20%
fill_pattern = rectilinear
solid_infill_below_area = 0
top_solid_layers = 0
bottom_solid_layers = 0
retract_length = 0.8
retract_before_travel = 2
retract_layer_change = 0
only_retract_when_crossing_perimeters = 0
skirts = 0
)";

class ForeignGcode : public test::ProgramTest {
 protected:
  /// Slices a box of 16 x 12 x 3 mm and returns what `score` says of the file. Takes the slicer and
  /// its way to say what it is to do.
  json scored(const std::string& slicer, const std::string& call_it) {
    write_stl(in_folder("box.stl"), load_model(kModel).mesh);
    std::ofstream(folder_ / "settings.ini") << kSettings;
    const std::string command = "cd '" + folder_.string() + "' && " + slicer + " " + call_it +
                                " --output a.gcode box.stl >log 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << test::content_of(folder_ / "log");
    const test::ProgramRun run = call({"score", in_folder("a.gcode"), "--model", kModel, "--task",
                                       "skin_layers=0", "--json", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.json();
  }

  /// The mm of filament that stand in the file behind a text.
  [[nodiscard]] double filament_mm(const std::string& text) const {
    const std::string gcode = test::content_of(folder_ / "a.gcode");
    const std::size_t at = gcode.find(text);
    return at == gcode.npos ? -1 : std::stod(gcode.substr(at + text.size()));
  }

  void expect_sound(const json& score, double stated_filament_mm) {
    EXPECT_EQ(score["outcome"], "valid") << score["reason"];
    EXPECT_EQ(score["paired_layers"], 15);
    EXPECT_EQ(score["file_layers"], 15);
    EXPECT_TRUE(score["unpaired_z_mm"].empty());
    const double by_e = score["file_filament_mm3"].get<double>();
    const double stated = stated_filament_mm * std::numbers::pi / 4 * 1.75 * 1.75;
    EXPECT_NEAR(by_e, stated, 1e-3 * stated) << "the slicer's own count";
    const json& totals = score["totals"];
    EXPECT_NEAR(totals["filament_mm3"].get<double>(), by_e, 1e-3 * by_e) << "widths and E agree";
    EXPECT_EQ(score["file_retractions"], totals["retractions"]) << "the policy is the slicer's";
    EXPECT_EQ(totals["outline_covered"], 1);
    EXPECT_EQ(totals["hollow_mm"], 0);
  }

  static constexpr const char* kModel = "shape:box?x=16&y=12&z=3";
};

bool installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

TEST_F(ForeignGcode, PrusaSlicers) {
  if (!installed("prusa-slicer")) GTEST_SKIP() << "prusa-slicer is not installed";
  const json score =
      scored("prusa-slicer", "--load settings.ini --loglevel 1 --center 100,70 --export-gcode");
  expect_sound(score, filament_mm("; filament used [mm] = "));
  EXPECT_TRUE(score["warnings"].empty()) << score["warnings"];
}

TEST_F(ForeignGcode, Slic3rs) {
  if (!installed("slic3r")) GTEST_SKIP() << "slic3r is not installed";
  const json score =
      scored("slic3r", "--no-gui --load settings.ini --print-center 100,70 --threads 1");
  expect_sound(score, filament_mm("; filament used = "));
}

}  // namespace
}  // namespace routebench
