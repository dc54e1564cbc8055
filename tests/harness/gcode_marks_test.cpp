/// What G-code says of widths, heights and types, and files that are known.

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "gcode_prints.hpp"
#include "gcode_reader.hpp"
#include "gcode_texts.hpp"

namespace routebench {
namespace {

using test::kFilamentSection;
using test::kStart;
using test::number;
using test::Points;
using test::read_text;
using test::runs_of;
using test::section_mm2;
using test::strokes_of;

TEST(GcodeReader, WidthsComeFromMarks) {
  const GcodePrint print = read_text(kStart +
                                     ";WIDTH:0.6\nG1 X10 E1\n;WIDTH:0.45\nG1 X20 E1\nG0 X0\n"
                                     "; LINE_WIDTH: 0.5\nG1 X20 E1\n");
  ASSERT_EQ(print.layers[0].route.strokes.size(), 3u);
  EXPECT_EQ(print.layers[0].route.strokes[0].width_mm, 0.6);
  EXPECT_EQ(print.layers[0].route.strokes[1].width_mm, 0.45);
  EXPECT_EQ(print.layers[0].route.strokes[2].width_mm, 0.5);
  EXPECT_EQ(print.layers[0].route.strokes[1].points.front(), (Point2{10, 0}));
}

TEST(GcodeReader, TheSlicersOwnEstimateOfTheTimeIsRead) {
  const auto stated = [](const std::string& duration) {
    return read_text(kStart + "G1 X10 E1\n; estimated printing time (normal mode) =" + duration +
                     "\n; estimated printing time (silent mode) = 9s\n")
        .stated_time_s;
  };
  EXPECT_EQ(stated(" 42s"), 42);
  EXPECT_EQ(stated(" 57m 48s"), 57 * 60 + 48);
  EXPECT_EQ(stated(" 1d 2h 3m 4s"), ((24 + 2) * 60 + 3) * 60 + 4);
  for (const char* other : {"", " ", " soon", " 3", " s", " 1h x", " 0s", " 5w"})
    EXPECT_EQ(stated(other), std::nullopt) << other;
  EXPECT_EQ(read_text(kStart + "G1 X10 E1\n").stated_time_s, std::nullopt);
}

TEST(GcodeReader, AStrokeOfAnotherHeightThanItsLayersHasTheWidthOfItsVolume) {
  const double e = section_mm2(0.6) / kFilamentSection;
  const std::string bridge = ";HEIGHT:0.4\n;WIDTH:0.4\nG1 X10 E" + number(10 * e) +
                             "\n;HEIGHT:0.2\n;WIDTH:0.45\nG1 Y10 E0.3\n";
  for (const std::string& text :
       {kStart + ";LAYER_CHANGE\n;HEIGHT:0.2\n" + bridge,
        kStart + ";LAYER_CHANGE\n;HEIGHT:0.2\n;WIDTH:0.5\nG1 X0.5 E1\nG0 X0\n" + bridge}) {
    const GcodeLayer layer = read_text(text).layers.at(0);
    EXPECT_EQ(layer.height_mm, 0.2);
    ASSERT_GE(layer.route.strokes.size(), 2u);
    EXPECT_NEAR(layer.route.strokes.rbegin()[1].width_mm, 0.6, 1e-6);
    EXPECT_EQ(layer.route.strokes.back().width_mm, 0.45);
  }
}

TEST(GcodeReader, WidthsFollowFromEWithoutMarks) {
  const auto e = [](double width, double length) {
    return number(section_mm2(width) * length / kFilamentSection);
  };
  const std::string text = kStart + "G1 X10 E" + e(0.45, 10) + "\nG1 X13 E" + e(0.45, 3) +
                           "\nG1 X33 E" + e(0.6, 20) + "\n";
  const auto expect = [](const GcodePrint& print) {
    ASSERT_EQ(print.layers[0].route.strokes.size(), 2u);
    EXPECT_NEAR(print.layers[0].route.strokes[0].width_mm, 0.45, 1e-6);
    EXPECT_NEAR(print.layers[0].route.strokes[1].width_mm, 0.6, 1e-6);
  };
  expect(read_text(text));
  // Twice the diameter of filament, a quarter of the length; the statement may stand at the end.
  std::string thick = text;
  for (std::size_t at = 0; (at = thick.find(" E", at)) != thick.npos; ++at) {
    const std::size_t end = thick.find('\n', at);
    const double value = std::stod(thick.substr(at + 2, end - at - 2)) / 4;
    thick.replace(at, end - at, " E" + number(value));
  }
  expect(read_text(thick, {.filament_mm = 3.5}));
  expect(read_text(thick + "; filament_diameter = 3.5,3.5\n"));
  // A bead narrower than high is an ellipse.
  const GcodePrint thin = read_text(
      kStart + "G1 X10 E" + number(10 * 0.1 * 0.2 * std::numbers::pi / 4 / kFilamentSection));
  EXPECT_NEAR(thin.layers[0].route.strokes[0].width_mm, 0.1, 1e-6);
  // Twice the height: another width.
  const GcodePrint high = read_text(";HEIGHT:0.1\n" + text);
  EXPECT_NEAR(high.layers[0].route.strokes[0].width_mm,
              section_mm2(0.45) / 0.1 + 0.1 * (1 - std::numbers::pi / 4), 1e-6);
}

TEST(GcodeReader, EIsAVolumeWhereTheFileSaysSo) {
  const std::string moves =
      "M82\nG92 E0\nG1 X10 E" + number(10 * section_mm2(0.45)) + "\nG10\nG0 Y3\nG11\n";
  for (const std::string& text :
       {";FLAVOR:UltiGCode\n" + kStart + moves, kStart + "M200 D2.85\n" + moves,
        kStart + "M200 D0\nM200 S1\n" + moves}) {
    const GcodePrint print = read_text(text);
    EXPECT_NEAR(print.layers[0].route.strokes[0].width_mm, 0.45, 1e-9) << text;
    EXPECT_NEAR(print.filament_mm3, 10 * section_mm2(0.45), 1e-9);
  }
  EXPECT_NEAR(read_text(kStart + "M200 D1.75\nM200 D0\n" + moves).filament_mm3,
              10 * section_mm2(0.45) * kFilamentSection, 1e-9);
}

TEST(GcodeReader, EIsAVolumeInAllOfAFileThatSaysSoAtItsEnd) {
  const std::string moves = kStart + "G1 X10 E" + number(10 * section_mm2(0.45)) + "\n";
  const GcodePrint print =
      read_text(moves + "; use_volumetric_e = 1\n; filament_diameter = 2.85\n");
  EXPECT_NEAR(print.layers[0].route.strokes[0].width_mm, 0.45, 1e-9);
  EXPECT_NEAR(print.filament_mm3, 10 * section_mm2(0.45), 1e-9);
  EXPECT_NEAR(read_text(moves + "; use_volumetric_e = 0\n").filament_mm3,
              10 * section_mm2(0.45) * kFilamentSection, 1e-9);
}

TEST(GcodeReader, MarksTellAVolumeOfTheirOwn) {
  const std::string moves = ";HEIGHT:0.2\n;WIDTH:0.45\nG1 X10 E0.1\n;WIDTH:0\nG1 X20 E0.2\n";
  const GcodePrint print = read_text(kStart + moves);
  EXPECT_NEAR(print.marked_mm3, 10 * section_mm2(0.45) + 0.2 * kFilamentSection, 1e-9);
  EXPECT_TRUE(print.filament_is_known);
  EXPECT_TRUE(read_text(kStart + moves + "; filament_diameter = 2.85,2.85\n").filament_is_known);
  const GcodePrint two = read_text(kStart + moves + "; filament_diameter = 1.75,2.85\n");
  EXPECT_FALSE(two.filament_is_known);
  EXPECT_TRUE(std::any_of(two.warnings.begin(), two.warnings.end(), [](const std::string& warning) {
    return warning.find("different diameters") != warning.npos;
  }));
}

TEST(GcodeReader, UnknownTypesFillNoScreen) {
  std::string text = kStart;
  for (int i = 0; i < 1000; ++i)
    text += ";TYPE:" + std::to_string(i) + "th\nG1 X" + std::to_string(i + 1) + " E1\n";
  const std::vector<std::string> warnings = read_text(text).warnings;
  EXPECT_LE(warnings.size(), 13u);
  EXPECT_NE(std::find(warnings.begin(), warnings.end(), "1000 unknown types in all"),
            warnings.end());
}

TEST(GcodeReader, TheHeightOfALayerIsItsMarkOrItsStep) {
  const auto heights = [](const std::string& text) {
    std::vector<double> result;
    for (const GcodeLayer& layer : read_text(text).layers) result.push_back(layer.height_mm);
    return result;
  };
  const auto expect = [&](const std::string& text, const std::vector<double>& expected) {
    const std::vector<double> found = heights(text);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-9);
  };
  const std::string lines = "G1 Z0.25\nG1 X1 E1\nG1 Z.4\nG1 X2 E1\nG1 Z2\nG1 X3 E1\n";
  expect(kStart + lines, {0.25, 0.15, 0.2});
  expect(kStart + ";HEIGHT:0.3\n" + lines, {0.3, 0.3, 0.3});
}

TEST(GcodeReader, EquallyHighLayersAreReadEquallyHighOrTheWarningCountsThem) {
  constexpr int kLayers = 40;
  constexpr double kExpectedMm = GcodeOptions{}.layer_height_mm;
  for (int hundredths = 4; hundredths <= 80; ++hundredths) {
    // Z as the shortest text of a sum, as a program without slicer's marks writes it.
    const double height_mm = hundredths / 100.0;
    std::string text = "M83\nG28\n";
    for (int i = 1; i <= kLayers; ++i)
      text +=
          "G1 Z" + number(i * hundredths / 100.0) + "\nG1 X" + (i % 2 == 0 ? "0" : "9") + " E1\n";
    const GcodePrint print = read_text(text);
    ASSERT_EQ(print.layers.size(), kLayers);
    const bool told = hundredths <= 30;
    for (const GcodeLayer& layer : print.layers)
      EXPECT_NEAR(layer.height_mm, told ? height_mm : kExpectedMm, 1e-9)
          << height_mm << ' ' << layer.z_mm;
    std::vector<std::string> warnings;
    if (!told)
      warnings.push_back(
          "the steps of Z do not tell the height of 40 of 40 layers, the first at z = " +
          to_string(ParamValue(height_mm)) + " mm: it is taken from layer_height_mm = 0.2");
    warnings.emplace_back("no type marks: all strokes count as part of the model");
    EXPECT_EQ(print.warnings, warnings) << height_mm;
  }
}

TEST(GcodeReader, ALowestLayerWithoutAStepIsAsHighAsExpected) {
  // Some programs write the lower side of a layer.
  const GcodePrint print =
      read_text("M83\nG28\nG1 Z0.0\nG1 X9 E1\nG1 Z0.3\nG1 X0 E1\n", {.layer_height_mm = 0.3});
  ASSERT_EQ(print.layers.size(), 2u);
  EXPECT_EQ(print.layers[0].height_mm, 0.3);
  EXPECT_EQ(print.layers[1].height_mm, 0.3);
  EXPECT_EQ(print.warnings.at(0),
            "the steps of Z do not tell the height of 1 of 2 layers, the first at z = 0 mm: "
            "it is taken from layer_height_mm = 0.3");
  // A gap further up needs no warning.
  EXPECT_EQ(read_text(kStart + "G1 X9 E1\nG1 Z0.4\nG1 X0 E1\nG1 Z3\nG1 X9 E1\n").warnings.size(),
            1u);
}

TEST(GcodeReader, TypesTellWhatIsPartOfTheModel) {
  const GcodePrint print = read_text(
      kStart +
      ";TYPE:Skirt/Brim\nG1 X10 E1\n;TYPE:External perimeter\nG1 Y10 E1\n;TYPE:Solid infill\n"
      "G1 X0 E1\nG0 X5\n;TYPE:WALL-INNER\nG1 X0 E1\n;TYPE:FILL\nG1 Y0 E1\n;TYPE:SUPPORT\n"
      "G1 Y-10 E1\nG0 Y-12\nG1 Y-20 E1\n; FEATURE: Sparse infill\nG1 X4 E1\n;TYPE:Novelty\nG1 X0 "
      "E1\n");
  using enum StrokeKind;
  EXPECT_EQ(print.layers.at(0).kinds, (std::vector<std::optional<StrokeKind>>{
                                          kWall, kDense, kWall, kSparse, kSparse, std::nullopt}));
  EXPECT_EQ(strokes_of(print)[0], (Points{{10, 0}, {10, 10}}));
  EXPECT_EQ(print.excluded_strokes, 3u);
  EXPECT_DOUBLE_EQ(print.excluded_mm, 10 + 10 + 8);
  ASSERT_EQ(print.warnings.size(), 1u);
  EXPECT_EQ(print.warnings[0],
            "unknown type 'Novelty', 1 times; its strokes count as part of the model");
}

TEST(GcodeReader, WhatComesBeforeTheFirstLayerMarkIsPriming) {
  const std::string purge = kStart + "G1 X100 E9\nG1 E-1\nG0 Y50\nG1 E1\n";
  const std::string part = "G0 X1 Y1\nG1 X2 E1\n";
  const GcodePrint print = read_text(purge + ";LAYER_CHANGE\n" + part);
  EXPECT_EQ(runs_of(print), (std::vector<Points>{{{1, 1}, {2, 1}}}));
  EXPECT_EQ(print.excluded_strokes, 1u);
  EXPECT_DOUBLE_EQ(print.excluded_mm, 100);
  EXPECT_EQ(print.retractions, 0u);
  EXPECT_EQ(print.travel_mm, 0);
  EXPECT_NEAR(print.filament_mm3, kFilamentSection, 1e-9);
  EXPECT_EQ(runs_of(read_text(purge + ";LAYER:0\n" + part)).size(), 1u);
  EXPECT_EQ(runs_of(read_text(purge + ";LAYER_COUNT:7\n" + part)).size(), 2u)
      << "without marks nothing can be told apart";
}

TEST(GcodeReader, FilesOfTheWriterReadBackExactly) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const test::Print print = test::random_print(seed);
    Printer printer;
    constexpr std::array kFlavours = {"marlin", "klipper", "reprap", "ultigcode"};
    printer.flavour = kFlavours.at(seed % kFlavours.size());
    const GcodePrint back = read_text(test::gcode_of(print, {}, printer));
    ASSERT_EQ(back.layers.size(), print.layers.size());
    for (std::size_t i = 0; i < print.layers.size(); ++i) {
      const PlannedLayer& planned = print.planned[i];
      EXPECT_NEAR(back.layers[i].z_mm, print.layers[i].z_mm + 0.1, 1e-5);
      EXPECT_NEAR(back.layers[i].height_mm, 0.2, 1e-9);
      ASSERT_EQ(back.layers[i].route.strokes.size(), planned.route.strokes.size());
      for (std::size_t s = 0; s < planned.route.strokes.size(); ++s) {
        EXPECT_EQ(back.layers[i].route.strokes[s].points, planned.route.strokes[s].points);
        EXPECT_EQ(back.layers[i].route.strokes[s].width_mm, planned.route.strokes[s].width_mm);
        EXPECT_EQ(back.layers[i].kinds[s], planned.kinds[s]);
      }
    }
    EXPECT_TRUE(back.warnings.empty());
  }
}

TEST(GcodeReader, AgreesWithTheIndependentReader) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Printer printer;
    printer.lift_mm = seed % 2 == 0 ? 0.4 : 0;
    const std::string text = test::gcode_of(test::random_print(seed), {}, printer);
    const test::GcodeRun run = test::read_gcode(text);
    const GcodePrint print = read_text(text);
    EXPECT_EQ(print.retractions, static_cast<std::size_t>(run.retractions));
    EXPECT_NEAR(print.travel_mm, run.travel_mm, 1e-4);
    EXPECT_NEAR(print.filament_mm3, run.filament_mm * kFilamentSection, 1e-6);
    EXPECT_EQ(strokes_of(print).size(), run.strokes.size());
  }
}

}  // namespace
}  // namespace routebench
