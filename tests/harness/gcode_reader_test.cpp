#include "routebench/harness/gcode_reader.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "gcode_prints.hpp"
#include "gcode_reader.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using Points = std::vector<Point2>;

GcodePrint read(const std::string& text, const GcodeOptions& options = {}) {
  std::istringstream in(text);
  return read_gcode(in, "a.gcode", options);
}

/// The message with which a text is refused.
std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    return error.what();
  }
  return "not refused";
}

/// The strokes of all layers.
std::vector<Points> strokes_of(const GcodePrint& print) {
  std::vector<Points> strokes;
  for (const GcodeLayer& layer : print.layers)
    for (const Stroke& stroke : layer.route.strokes) strokes.push_back(stroke.points);
  return strokes;
}

/// The same with strokes that meet taken as one, as the judge does: where the tests' round numbers
/// of E would mean another width, the reader cuts.
std::vector<Points> runs_of(const GcodePrint& print) {
  std::vector<Points> runs;
  for (const Points& stroke : strokes_of(print))
    if (runs.empty() || runs.back().back() != stroke.front())
      runs.push_back(stroke);
    else
      runs.back().insert(runs.back().end(), stroke.begin() + 1, stroke.end());
  return runs;
}

std::vector<double> heights_of(const GcodePrint& print) {
  std::vector<double> z;
  for (const GcodeLayer& layer : print.layers) z.push_back(layer.z_mm);
  return z;
}

constexpr double kFilamentSection = std::numbers::pi / 4 * 1.75 * 1.75;
double section_mm2(double width_mm) { return (width_mm - 0.2) * 0.2 + std::numbers::pi * 0.01; }

const std::string kStart = "G21\nG90\nM83\nG1 Z0.2\nG0 X0 Y0\n";

TEST(GcodeReader, ReadsStrokesAndTravels) {
  const GcodePrint print = read(kStart +
                                "G1 X10 E0.5\nG1 Y5 E.25\nG1 X0 Y5 F3000\nG1 X-0.5 Y+4 E1\n"
                                "G4 P10\nM104 S200\nM107\nM104 S0 ; the end\n");
  EXPECT_EQ(runs_of(print), (std::vector<Points>{{{0, 0}, {10, 0}, {10, 5}}, {{0, 5}, {-0.5, 4}}}));
  EXPECT_EQ(heights_of(print), std::vector<double>{0.2});
  EXPECT_DOUBLE_EQ(print.travel_mm, 10);
  EXPECT_EQ(print.retractions, 0u);
  EXPECT_NEAR(print.filament_mm3, 1.75 * kFilamentSection, 1e-12);
  EXPECT_EQ(print.ignored,
            (std::map<std::string, std::size_t>{{"G4", 1}, {"M104", 2}, {"M107", 1}}));
  EXPECT_EQ(print.lines, 13u);
}

TEST(GcodeReader, TheWayALineIsWrittenDoesNotMatter) {
  const std::vector<Points> plain = runs_of(read(kStart + "G1 X10 Y2 E1\nG0 X3\nG1 Y9 E1\n"));
  EXPECT_EQ(runs_of(read("g21\r\n g90\r\nm83\r\n\tg1z.2\r\nG0X0Y0\r\n"
                         "N12 G01 E1. Y2.000 X+10 F99 *71\r\n(move) G0 (there) X3 ; X4\r\n\r\n"
                         "G001 E1 Y9")),
            plain);
}

TEST(GcodeReader, AbsoluteAndRelativeMeanTheSame) {
  const std::vector<Points> expected = {{{0, 0}, {10, 0}, {10, 5}}, {{4, 5}, {4, 8}}};
  const auto expect = [&](const std::string& text) {
    const GcodePrint print = read(text);
    EXPECT_EQ(runs_of(print), expected) << text;
    EXPECT_NEAR(print.filament_mm3, 4 * kFilamentSection, 1e-9) << text;
    EXPECT_EQ(print.retractions, 1u) << text;
  };
  expect(kStart + "G1 X10 E1\nG1 Y5 E1\nG1 E-1\nG0 X4\nG1 E1\nG1 Y8 E2\n");
  expect(kStart + "M82\nG92 E7\nG1 X10 E8\nG1 Y5 E9\nG1 E8\nG0 X4\nG1 E9\nG1 Y8 E11\n");
  expect(kStart +
         "M82\nG92 E0\nG1 X10 E1\nG92 E0\nG1 Y5 E1\nG1 E0\nG92 E0\nG0 X4\nG1 E1\n"
         "G92\nG1 X0 Y3 E2\n");
  // G91 makes E relative, too; G90 does not take back M83.
  expect(kStart + "M82\nG91\nG1 X10 E1\nG1 Y5 E1\nG1 E-1\nG0 X-6\nG1 E1\nG1 Y3 E2\n");
  expect(kStart + "G91\nG1 X10 E1\nG90\nG1 Y5 E1\nG1 E-1\nG0 X4\nG1 E1\nG1 Y8 E2\n");
}

TEST(GcodeReader, InchesAreMillimetresTimes25Point4) {
  const GcodePrint inches =
      read("G20\nG90\nM83\nG1 Z0.01\nG0 X0 Y0\nG1 X1 E0.1\nG2 X2 Y0 I0.5 E0.1\nG21\nG0 X0\n");
  const GcodePrint millimetres =
      read("G21\nG90\nM83\nG1 Z0.254\nG0 X0 Y0\nG1 X25.4 E2.54\nG2 X50.8 Y0 I12.7 E2.54\nG0 X0\n");
  EXPECT_EQ(runs_of(inches), runs_of(millimetres));
  EXPECT_EQ(heights_of(inches), heights_of(millimetres));
  EXPECT_NEAR(inches.filament_mm3, millimetres.filament_mm3, 1e-9);
  EXPECT_EQ(runs_of(inches)[0][1].x, snap(25.4));
}

TEST(GcodeReader, G92ShiftsTheFilesCoordinatesNotTheNozzle) {
  EXPECT_EQ(runs_of(read(kStart + "G0 X10 Y10\nG92 X0 Y0\nG1 X1 Y2 E1\nG92 X50\nG1 X51 E1\n")),
            (std::vector<Points>{{{10, 10}, {11, 12}, {12, 12}}}));
  EXPECT_EQ(heights_of(read(kStart + "G92 Z0\nG1 X1 E1\nG1 Z0.2\nG1 X0 E1\n")),
            (std::vector<double>{0.2, 0.4}));
}

TEST(GcodeReader, HomingGoesToZero) {
  EXPECT_EQ(runs_of(read("G28\nM83\nG1 X3 E1\nG28 X\nG1 Y2 E1\n")),
            (std::vector<Points>{{{0, 0}, {3, 0}}, {{0, 0}, {0, 2}}}));
}

/// Farthest that chords stray from a circle, and their length.
struct Chords {
  double stray_mm = 0;
  double length_mm = 0;
};
Chords chords_of(const Points& points, Point2 centre, double radius) {
  Chords chords;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point2 middle = lerp(points[i - 1], points[i], 0.5);
    chords.stray_mm = std::max({chords.stray_mm, std::abs(distance(middle, centre) - radius),
                                std::abs(distance(points[i], centre) - radius)});
    chords.length_mm += distance(points[i - 1], points[i]);
  }
  return chords;
}

TEST(GcodeReader, ArcsKeepToTheirCircleAndLength) {
  struct Case {
    const char* move;
    Point2 to;
    double turn;  // positive to the left
  };
  const double half = std::numbers::pi;
  // All from (10, 0) round (0, 0).
  for (const Case& arc :
       {Case{"G3 X0 Y10 I-10 J0", {0, 10}, half / 2},
        Case{"G2 X0 Y10 I-10", {0, 10}, -3 * half / 2}, Case{"G3 X-10 I-10", {-10, 0}, half},
        Case{"G3 I-10", {10, 0}, 2 * half}, Case{"G2 I-10 J0", {10, 0}, -2 * half},
        Case{"G3 X0 Y10 R10", {0, 10}, half / 2}, Case{"G3 X0 Y-10 R-10", {0, -10}, 3 * half / 2},
        Case{"G2 X0 Y-10 R10", {0, -10}, -half / 2},
        Case{"G2 X0 Y10 R-10", {0, 10}, -3 * half / 2}}) {
    const GcodePrint print = read(kStart + "G0 X10\n" + arc.move + " E1\n");
    const Points points = runs_of(print).at(0);
    const Chords chords = chords_of(points, {0, 0}, 10);
    EXPECT_LE(chords.stray_mm, 0.001 + 1e-5) << arc.move;
    EXPECT_NEAR(chords.length_mm, 10 * std::abs(arc.turn), 1e-3 * chords.length_mm) << arc.move;
    EXPECT_EQ(points.back(), arc.to) << arc.move;
    EXPECT_GT(cross(points[0], points[1]) * arc.turn, 0) << arc.move << " turns the wrong way";
    EXPECT_NEAR(print.filament_mm3, kFilamentSection, 1e-9) << arc.move;
  }
  const GcodePrint travel = read(kStart + "G1 X10 E1\nG3 X0 Y10 I-10\nG1 X1 E1\n");
  EXPECT_NEAR(travel.travel_mm, 5 * half, 0.01) << "an arc may be a travel";
  EXPECT_EQ(runs_of(read(kStart + "G91\nG3 X-10 Y10 I-10 E1\n"))[0].back(), (Point2{-10, 10}));
}

TEST(GcodeReader, SmallArcsKeepTheirLengthToo) {
  const GcodePrint print = read(kStart + "G3 I0.05 E0.01\n");
  EXPECT_NEAR(chords_of(runs_of(print)[0], {0.05, 0}, 0.05).length_mm, 0.1 * std::numbers::pi,
              1e-3 * 0.314);
}

TEST(GcodeReader, RetractionsAreCountedAsTheFileHasThem) {
  const auto count = [](const std::string& between) {
    return read(kStart + "G1 X10 E1\n" + between + "G1 Y10 E1\n").retractions;
  };
  EXPECT_EQ(count("G0 X5\n"), 0u);
  EXPECT_EQ(count("G1 E-0.8\nG0 X5\nG1 E0.8\n"), 1u);
  EXPECT_EQ(count("G1 E-0.4\nG1 X9 E-0.2\nG1 X8 E-0.2\nG0 X5\nG1 E0.8\n"), 1u) << "a wipe";
  EXPECT_EQ(count("G10\nG0 X5\nG11\n"), 1u);
  EXPECT_EQ(count("G10 S1\nG0 X5\nG11\n"), 1u);
  EXPECT_EQ(count("G10 P0 S200\nG10 L2 X3\nG0 X5\n"), 0u) << "temperatures and offsets";
  EXPECT_EQ(count("G1 E-0.8\nG0 X5\nG1 E0.8\nG1 E-0.8\nG0 X6\nG1 E0.8\n"), 2u);
  EXPECT_EQ(read(kStart + "G1 E-1\nG1 E1\nG1 X5 E1\nG1 E-1\nG0 X9\nM107\n").retractions, 0u)
      << "neither before the first stroke nor after the last";
}

TEST(GcodeReader, FilamentThatComesBackWhileMovingFillsUpFirst) {
  const GcodePrint print = read(kStart + "G1 X10 E1\nG1 E-1\nG1 X12 E1\nG1 X15 E0.3\n");
  EXPECT_EQ(runs_of(print), (std::vector<Points>{{{0, 0}, {10, 0}}, {{12, 0}, {15, 0}}}));
  EXPECT_NEAR(print.filament_mm3, 1.3 * kFilamentSection, 1e-9);
  EXPECT_DOUBLE_EQ(print.travel_mm, 2);
  // A push on the spot makes the nozzle ready, however long it is.
  EXPECT_EQ(runs_of(read(kStart + "G1 X10 E1\nG1 E-1\nG0 X12\nG1 E0.9\nG1 X15 E0.3\n")).size(), 2u);
}

TEST(GcodeReader, LiftingMakesNoLayers) {
  const GcodePrint print = read(kStart +
                                "G1 X10 E1\nG1 Z0.6\nG0 X0 Y5\nG1 Z0.2\nG1 X10 E1\nG1 Z0.4\n"
                                "G0 X0 Y0\nG1 X5 E1\nG1 Z5\nG0 X0 Y50\n");
  EXPECT_EQ(heights_of(print), (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(print.layers[0].route.strokes.size(), 2u);
  EXPECT_DOUBLE_EQ(print.travel_mm, distance({10, 0}, {0, 5}) + distance({10, 5}, {0, 0}));
}

TEST(GcodeReader, PartsPrintedOneByOneAreLayersAllTheSame) {
  const GcodePrint print =
      read(kStart + "G1 X1 E1\nG1 Z0.4\nG1 X0 E1\nG1 Z0.2004\nG0 X9\nG1 X8 E1\nG1 Z.4\nG1 X9 E1\n");
  EXPECT_EQ(heights_of(print), (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(print.layers[0].route.strokes.size(), 2u);
  EXPECT_NE(print.warnings.at(0).find("lower layers"), std::string::npos);
}

/// A spiral of `turns` turns with `corners` corners each, climbing 0.2 mm a turn from 0.2 mm.
std::string spiral(int turns, int corners, const std::string& mark) {
  std::string text = kStart + "G0 X10 Y0\n";
  for (int k = 1; k <= turns * corners; ++k) {
    if (k % corners == 1) text += mark;
    const double angle = 2 * std::numbers::pi * k / corners;
    std::ostringstream move;
    move << std::fixed << "G1 X" << 10 * std::cos(angle) << " Y" << 10 * std::sin(angle) << " Z"
         << std::round(1000 * (0.2 + 0.2 * k / corners)) / 1000 << " E0.1\n";
    text += move.str();
  }
  return text;
}

TEST(GcodeReader, ASpiralHasALayerATurn) {
  // With many corners the written height stands still from time to time.
  for (const int corners : {10, 400})
    for (const char* mark : {"", ";LAYER_CHANGE\n", ";LAYER:3\n"}) {
      const GcodePrint print = read(spiral(5, corners, mark));
      const std::vector<double> z = heights_of(print);
      ASSERT_EQ(z.size(), 5u) << corners << mark;
      for (std::size_t i = 0; i < z.size(); ++i)
        EXPECT_NEAR(z[i], 0.4 + 0.2 * static_cast<double>(i), 0.002) << corners << mark;
      EXPECT_EQ(print.travel_mm, 0);
      EXPECT_EQ(print.layers[1].route.strokes.front().points.front(),
                print.layers[0].route.strokes.back().points.back());
    }
}

TEST(GcodeReader, WidthsComeFromMarks) {
  const GcodePrint print = read(kStart +
                                ";WIDTH:0.6\nG1 X10 E1\n;WIDTH:0.45\nG1 X20 E1\nG0 X0\n"
                                "; LINE_WIDTH: 0.5\nG1 X20 E1\n");
  ASSERT_EQ(print.layers[0].route.strokes.size(), 3u);
  EXPECT_EQ(print.layers[0].route.strokes[0].width_mm, 0.6);
  EXPECT_EQ(print.layers[0].route.strokes[1].width_mm, 0.45);
  EXPECT_EQ(print.layers[0].route.strokes[2].width_mm, 0.5);
  EXPECT_EQ(print.layers[0].route.strokes[1].points.front(), (Point2{10, 0}));
}

std::string number(double value);

TEST(GcodeReader, AStrokeOfAnotherHeightThanItsLayersHasTheWidthOfItsVolume) {
  const double e = section_mm2(0.6) / kFilamentSection;
  const std::string bridge = ";HEIGHT:0.4\n;WIDTH:0.4\nG1 X10 E" + number(10 * e) +
                             "\n;HEIGHT:0.2\n;WIDTH:0.45\nG1 Y10 E0.3\n";
  for (const std::string& text :
       {kStart + ";LAYER_CHANGE\n;HEIGHT:0.2\n" + bridge,
        kStart + ";LAYER_CHANGE\n;HEIGHT:0.2\n;WIDTH:0.5\nG1 X0.5 E1\nG0 X0\n" + bridge}) {
    const GcodeLayer layer = read(text).layers.at(0);
    EXPECT_EQ(layer.height_mm, 0.2);
    ASSERT_GE(layer.route.strokes.size(), 2u);
    EXPECT_NEAR(layer.route.strokes.rbegin()[1].width_mm, 0.6, 1e-6);
    EXPECT_EQ(layer.route.strokes.back().width_mm, 0.45);
  }
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
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
  expect(read(text));
  // Twice the diameter of filament, a quarter of the length; the statement may stand at the end.
  std::string thick = text;
  for (std::size_t at = 0; (at = thick.find(" E", at)) != thick.npos; ++at) {
    const std::size_t end = thick.find('\n', at);
    const double value = std::stod(thick.substr(at + 2, end - at - 2)) / 4;
    thick.replace(at, end - at, " E" + number(value));
  }
  expect(read(thick, {.filament_mm = 3.5}));
  expect(read(thick + "; filament_diameter = 3.5,3.5\n"));
  // A bead narrower than high is an ellipse.
  const GcodePrint thin =
      read(kStart + "G1 X10 E" + number(10 * 0.1 * 0.2 * std::numbers::pi / 4 / kFilamentSection));
  EXPECT_NEAR(thin.layers[0].route.strokes[0].width_mm, 0.1, 1e-6);
  // Twice the height: another width.
  const GcodePrint high = read(";HEIGHT:0.1\n" + text);
  EXPECT_NEAR(high.layers[0].route.strokes[0].width_mm,
              section_mm2(0.45) / 0.1 + 0.1 * (1 - std::numbers::pi / 4), 1e-6);
}

TEST(GcodeReader, EIsAVolumeWhereTheFileSaysSo) {
  const std::string moves =
      "M82\nG92 E0\nG1 X10 E" + number(10 * section_mm2(0.45)) + "\nG10\nG0 Y3\nG11\n";
  for (const std::string& text :
       {";FLAVOR:UltiGCode\n" + kStart + moves, kStart + "M200 D2.85\n" + moves,
        kStart + "M200 D0\nM200 S1\n" + moves}) {
    const GcodePrint print = read(text);
    EXPECT_NEAR(print.layers[0].route.strokes[0].width_mm, 0.45, 1e-9) << text;
    EXPECT_NEAR(print.filament_mm3, 10 * section_mm2(0.45), 1e-9);
  }
  EXPECT_NEAR(read(kStart + "M200 D1.75\nM200 D0\n" + moves).filament_mm3,
              10 * section_mm2(0.45) * kFilamentSection, 1e-9);
}

TEST(GcodeReader, TheHeightOfALayerIsItsMarkOrItsStep) {
  const auto heights = [](const std::string& text) {
    std::vector<double> result;
    for (const GcodeLayer& layer : read(text).layers) result.push_back(layer.height_mm);
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

TEST(GcodeReader, TypesTellWhatIsPartOfTheModel) {
  const GcodePrint print = read(
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
  const GcodePrint print = read(purge + ";LAYER_CHANGE\n" + part);
  EXPECT_EQ(runs_of(print), (std::vector<Points>{{{1, 1}, {2, 1}}}));
  EXPECT_EQ(print.excluded_strokes, 1u);
  EXPECT_DOUBLE_EQ(print.excluded_mm, 100);
  EXPECT_EQ(print.retractions, 0u);
  EXPECT_EQ(print.travel_mm, 0);
  EXPECT_NEAR(print.filament_mm3, kFilamentSection, 1e-9);
  EXPECT_EQ(runs_of(read(purge + ";LAYER:0\n" + part)).size(), 1u);
  EXPECT_EQ(runs_of(read(purge + ";LAYER_COUNT:7\n" + part)).size(), 2u)
      << "without marks nothing can be told apart";
}

TEST(GcodeReader, KlippersNamedCommandsAreIgnored) {
  const GcodePrint print = read("START_PRINT BED=60\n" + kStart +
                                "SET_VELOCITY_LIMIT ACCEL=3000\nG1 X1 E1\nEXCLUDE_OBJECT_START "
                                "NAME=a\nG1 X2 E1\nT0\nTx\nM117 G1 X99 E5\n");
  EXPECT_EQ(runs_of(print), (std::vector<Points>{{{0, 0}, {1, 0}, {2, 0}}}));
  EXPECT_EQ(print.ignored.at("START_PRINT"), 1u);
  EXPECT_EQ(print.ignored.at("T"), 1u);
}

TEST(GcodeReader, MalformedInputIsRefusedWithItsLine) {
  struct Case {
    const char* line;
    const char* reason;
  };
  for (const Case& bad : {
           Case{"G1 Xa", "X has no number"},
           Case{"G1 X#", "X'#' is not a number"},
           Case{"G1 X1.2.3", "is not a number"},
           Case{"G1 X1-2", "is not a number"},
           Case{"G1 X--1", "is not a number"},
           Case{"G1 Xnan", "N is given twice"},
           Case{"G1 Xinf", "X has no number"},
           Case{"G1 X", "X has no number"},
           Case{"G92 E", "E has no number"},
           Case{"G1 X1 X2", "X is given twice"},
           Case{"G1 X2000000", "X is more than 1 km away"},
           Case{"G1 X1 E2000000", "more than 1 km of filament"},
           Case{"G1 X1 G1 Y1", "a second command"},
           Case{"G1 X1 #3", "'#' is no word"},
           Case{"X10 Y10", "the line begins with no command but with 'X10 Y10'"},
           Case{"hello world", ""},  // a named command for Klipper
           Case{"\x01\x02", "the byte 0x01"},
           Case{"G", "'G' is not a command"},
           Case{"G-1", "is not a command"},
           Case{"Mx", "is not a command"},
           Case{"G5 X1 Y1 I1 J1 P1 Q1", "G5 is not known"},
           Case{"G53", "G53 is not known"},
           Case{"G92.1", "G92.1 is not known"},
           Case{"G18", "G18 is not known"},
           Case{"G1 X1 (never closed", "a comment in brackets does not end"},
           Case{"while iterations < 3", "cannot be followed"},
           Case{"if true", "begins with no command"},
           Case{"G2 X1 E1", "an arc needs its centre"},
           Case{"G2 X5 I2.5 R3 E1", "either I and J or R"},
           Case{"G2 X10 R4 E1", "does not reach"},
           Case{"G2 R4 E1", "ends where it begins"},
           Case{"G2 X5 I0 J0 E1", "the centre of the arc"},
           Case{"G2 X5 I4 E1", "not on its circle"},
           Case{"G2 X5 I2.5 P2 E1", "several turns"},
           Case{";WIDTH:wide", "the mark of a width is not a number"},
           Case{";HEIGHT:1e9", "the mark of a height is not a number"},
           Case{";HEIGHT:0", "not positive"},
           Case{"G1 X0.0001 E1000", "over 1 m wide"},
       }) {
    const std::string text = kStart + bad.line + "\nG1 X3 Y3 E1\n";
    if (*bad.reason == 0) {
      EXPECT_NO_THROW(read(text)) << bad.line;
      continue;
    }
    const std::string message = refusal(text);
    EXPECT_TRUE(message.starts_with("a.gcode:6: ")) << bad.line << ": " << message;
    EXPECT_NE(message.find(bad.reason), message.npos) << bad.line << ": " << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
  }
}

TEST(GcodeReader, MaterialNeedsAPlace) {
  EXPECT_EQ(refusal("M83\nG1 X1 E1\n"),
            "a.gcode:2: material is laid before any move has said where X is");
  EXPECT_EQ(refusal("M83\nG0 X1 Y1\nG1 X2 E1\n"),
            "a.gcode:3: material is laid before any move has said where Z is");
  EXPECT_EQ(refusal("M83\nG91\nG0 X1 Y1 Z1\nG1 X2 E1\n"),
            "a.gcode:4: material is laid before any move has said where X is");
  EXPECT_EQ(refusal("G2 X1 Y1 I1\n"), "a.gcode:1: an arc begins at an unknown place");
}

TEST(GcodeReader, AFileWithoutMaterialIsRefused) {
  EXPECT_EQ(refusal(""), "a.gcode: lays no material");
  EXPECT_EQ(refusal(kStart + "G0 X5\n"), "a.gcode: lays no material");
  EXPECT_EQ(refusal(kStart + ";TYPE:Skirt\nG1 X5 E1\n"),
            "a.gcode: lays no material that is part of a model");
  EXPECT_NE(refusal("GCDE\x01").find("a.gcode:1: this is binary G-code"), std::string::npos);
  EXPECT_NE(refusal(kStart + std::string(3'000'000, ' ')).find("a.gcode:6: the line is longer"),
            std::string::npos);
  EXPECT_THROW(static_cast<void>(read_gcode_file("/no/such.gcode", {})), Error);
  EXPECT_THROW(static_cast<void>(read_gcode_file("/tmp", {})), Error);
}

TEST(GcodeReader, LinesMayLieAcrossTheBlocksInWhichAFileIsRead) {
  std::string text = kStart;
  Points expected = {{0, 0}};
  for (int k = 1; text.size() < 3'000'000; ++k) {
    text += "G1 X" + std::to_string(k % 97) + " Y" + std::to_string(k) + " E1 ; " +
            std::string(static_cast<std::size_t>(k % 300), 'x') + "\n";
    expected.push_back({static_cast<double>(k % 97), static_cast<double>(k)});
  }
  EXPECT_EQ(runs_of(read(text)), std::vector<Points>{expected});
}

TEST(GcodeReader, FilesOfTheWriterReadBackExactly) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const test::Print print = test::random_print(seed);
    Printer printer;
    constexpr std::array kFlavours = {"marlin", "klipper", "reprap", "ultigcode"};
    printer.flavour = kFlavours.at(seed % kFlavours.size());
    const GcodePrint back = read(test::gcode_of(print, {}, printer));
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
    const GcodePrint print = read(text);
    EXPECT_EQ(print.retractions, static_cast<std::size_t>(run.retractions));
    EXPECT_NEAR(print.travel_mm, run.travel_mm, 1e-4);
    EXPECT_NEAR(print.filament_mm3, run.filament_mm * kFilamentSection, 1e-6);
    EXPECT_EQ(strokes_of(print).size(), run.strokes.size());
  }
}

}  // namespace
}  // namespace routebench
