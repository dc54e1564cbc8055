/// Moves, modes and retractions of G-code.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "gcode_texts.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using test::heights_of;
using test::kFilamentSection;
using test::kStart;
using test::Points;
using test::read_text;
using test::refusal;
using test::runs_of;

TEST(GcodeReader, ReadsStrokesAndTravels) {
  const GcodePrint print = read_text(kStart +
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
  const std::vector<Points> plain = runs_of(read_text(kStart + "G1 X10 Y2 E1\nG0 X3\nG1 Y9 E1\n"));
  EXPECT_EQ(runs_of(read_text("g21\r\n g90\r\nm83\r\n\tg1z.2\r\nG0X0Y0\r\n"
                              "N12 G01 E1. Y2.000 X+10 F99 *71\r\n(move) G0 (there) X3 ; X4\r\n\r\n"
                              "G001 E1 Y9")),
            plain);
}

TEST(GcodeReader, AbsoluteAndRelativeMeanTheSame) {
  const std::vector<Points> expected = {{{0, 0}, {10, 0}, {10, 5}}, {{4, 5}, {4, 8}}};
  const auto expect = [&](const std::string& text) {
    const GcodePrint print = read_text(text);
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
      read_text("G20\nG90\nM83\nG1 Z0.01\nG0 X0 Y0\nG1 X1 E0.1\nG2 X2 Y0 I0.5 E0.1\nG21\nG0 X0\n");
  const GcodePrint millimetres = read_text(
      "G21\nG90\nM83\nG1 Z0.254\nG0 X0 Y0\nG1 X25.4 E2.54\nG2 X50.8 Y0 I12.7 E2.54\nG0 X0\n");
  EXPECT_EQ(runs_of(inches), runs_of(millimetres));
  EXPECT_EQ(heights_of(inches), heights_of(millimetres));
  EXPECT_NEAR(inches.filament_mm3, millimetres.filament_mm3, 1e-9);
  EXPECT_EQ(runs_of(inches)[0][1].x, snap(25.4));
}

TEST(GcodeReader, G92ShiftsTheFilesCoordinatesNotTheNozzle) {
  EXPECT_EQ(runs_of(read_text(kStart + "G0 X10 Y10\nG92 X0 Y0\nG1 X1 Y2 E1\nG92 X50\nG1 X51 E1\n")),
            (std::vector<Points>{{{10, 10}, {11, 12}, {12, 12}}}));
  EXPECT_EQ(heights_of(read_text(kStart + "G92 Z0\nG1 X1 E1\nG1 Z0.2\nG1 X0 E1\n")),
            (std::vector<double>{0.2, 0.4}));
}

TEST(GcodeReader, HomingGoesToZero) {
  EXPECT_EQ(runs_of(read_text("G28\nM83\nG1 X3 E1\nG28 X\nG1 Y2 E1\n")),
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
    const GcodePrint print = read_text(kStart + "G0 X10\n" + arc.move + " E1\n");
    const Points points = runs_of(print).at(0);
    const Chords chords = chords_of(points, {0, 0}, 10);
    EXPECT_LE(chords.stray_mm, 0.001 + 1e-5) << arc.move;
    EXPECT_NEAR(chords.length_mm, 10 * std::abs(arc.turn), 1e-3 * chords.length_mm) << arc.move;
    EXPECT_EQ(points.back(), arc.to) << arc.move;
    EXPECT_GT(cross(points[0], points[1]) * arc.turn, 0) << arc.move << " turns the wrong way";
    EXPECT_NEAR(print.filament_mm3, kFilamentSection, 1e-9) << arc.move;
  }
  const GcodePrint travel = read_text(kStart + "G1 X10 E1\nG3 X0 Y10 I-10\nG1 X1 E1\n");
  EXPECT_NEAR(travel.travel_mm, 5 * half, 0.01) << "an arc may be a travel";
  EXPECT_EQ(runs_of(read_text(kStart + "G91\nG3 X-10 Y10 I-10 E1\n"))[0].back(), (Point2{-10, 10}));
}

TEST(GcodeReader, SmallArcsKeepTheirLengthToo) {
  const GcodePrint print = read_text(kStart + "G3 I0.05 E0.01\n");
  EXPECT_NEAR(chords_of(runs_of(print)[0], {0.05, 0}, 0.05).length_mm, 0.1 * std::numbers::pi,
              1e-3 * 0.314);
}

TEST(GcodeReader, RetractionsAreCountedAsTheFileHasThem) {
  const auto count = [](const std::string& between) {
    return read_text(kStart + "G1 X10 E1\n" + between + "G1 Y10 E1\n").retractions;
  };
  EXPECT_EQ(count("G0 X5\n"), 0u);
  EXPECT_EQ(count("G1 E-0.8\nG0 X5\nG1 E0.8\n"), 1u);
  EXPECT_EQ(count("G1 E-0.4\nG1 X9 E-0.2\nG1 X8 E-0.2\nG0 X5\nG1 E0.8\n"), 1u) << "a wipe";
  EXPECT_EQ(count("G10\nG0 X5\nG11\n"), 1u);
  EXPECT_EQ(count("G10 S1\nG0 X5\nG11\n"), 1u);
  EXPECT_EQ(count("G10 P0 S200\nG10 L2 X3\nG0 X5\n"), 0u) << "temperatures and offsets";
  EXPECT_EQ(count("G1 E-0.8\nG0 X5\nG1 E0.8\nG1 E-0.8\nG0 X6\nG1 E0.8\n"), 2u);
  EXPECT_EQ(read_text(kStart + "G1 E-1\nG1 E1\nG1 X5 E1\nG1 E-1\nG0 X9\nM107\n").retractions, 0u)
      << "neither before the first stroke nor after the last";
}

TEST(GcodeReader, FilamentThatComesBackWhileMovingFillsUpFirst) {
  const GcodePrint print = read_text(kStart + "G1 X10 E1\nG1 E-1\nG1 X12 E1\nG1 X15 E0.3\n");
  EXPECT_EQ(runs_of(print), (std::vector<Points>{{{0, 0}, {10, 0}}, {{12, 0}, {15, 0}}}));
  EXPECT_NEAR(print.filament_mm3, 1.3 * kFilamentSection, 1e-9);
  EXPECT_DOUBLE_EQ(print.travel_mm, 2);
  // A push on the spot makes the nozzle ready, however long it is.
  EXPECT_EQ(runs_of(read_text(kStart + "G1 X10 E1\nG1 E-1\nG0 X12\nG1 E0.9\nG1 X15 E0.3\n")).size(),
            2u);
}

TEST(GcodeReader, LiftingMakesNoLayers) {
  const GcodePrint print = read_text(kStart +
                                     "G1 X10 E1\nG1 Z0.6\nG0 X0 Y5\nG1 Z0.2\nG1 X10 E1\nG1 Z0.4\n"
                                     "G0 X0 Y0\nG1 X5 E1\nG1 Z5\nG0 X0 Y50\n");
  EXPECT_EQ(heights_of(print), (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(print.layers[0].route.strokes.size(), 2u);
  EXPECT_DOUBLE_EQ(print.travel_mm, distance({10, 0}, {0, 5}) + distance({10, 5}, {0, 0}));
}

TEST(GcodeReader, PartsPrintedOneByOneAreLayersAllTheSame) {
  const GcodePrint print = read_text(
      kStart + "G1 X1 E1\nG1 Z0.4\nG1 X0 E1\nG1 Z0.2004\nG0 X9\nG1 X8 E1\nG1 Z.4\nG1 X9 E1\n");
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
      const GcodePrint print = read_text(spiral(5, corners, mark));
      const std::vector<double> z = heights_of(print);
      ASSERT_EQ(z.size(), 5u) << corners << mark;
      for (std::size_t i = 0; i < z.size(); ++i)
        EXPECT_NEAR(z[i], 0.4 + 0.2 * static_cast<double>(i), 0.002) << corners << mark;
      EXPECT_EQ(print.travel_mm, 0);
      EXPECT_EQ(print.layers[1].route.strokes.front().points.front(),
                print.layers[0].route.strokes.back().points.back());
    }
}

TEST(GcodeReader, KlippersNamedCommandsAreIgnored) {
  const GcodePrint print =
      read_text("START_PRINT BED=60\n" + kStart +
                "SET_VELOCITY_LIMIT ACCEL=3000\nG1 X1 E1\nEXCLUDE_OBJECT_START "
                "NAME=a\nG1 X2 E1\nT0\nTx\nM117 G1 X99 E5\n");
  EXPECT_EQ(runs_of(print), (std::vector<Points>{{{0, 0}, {1, 0}, {2, 0}}}));
  EXPECT_EQ(print.ignored.at("START_PRINT"), 1u);
  EXPECT_EQ(print.ignored.at("T"), 1u);
}

TEST(GcodeReader, KlippersStatesAreKeptAndBroughtBack) {
  const std::string print = kStart + "M82\nG92 E7\nG1 X1 E8\n";
  // What is between must not matter, but where the nozzle is.
  for (const std::string between :
       {"G91\nM83\nG1 Z1 E-3\nG0 X8\nG92 X-50 E2\nG1 Z-1 E3\n", "G91\nG0 X5\nG0 X3\n", "G0 X9\n"})
    EXPECT_EQ(runs_of(read_text(print + "SAVE_GCODE_STATE NAME=here\n" + between +
                                "restore_gcode_state name=here\nG1 Y5 E9\nG1 X3 E11\n")),
              (std::vector<Points>{{{0, 0}, {1, 0}}, {{9, 0}, {9, 5}, {3, 5}}}))
        << between;
  const GcodePrint moved =
      read_text(print +
                "SAVE_GCODE_STATE\nG91\nG0 X3 Y4\nRESTORE_GCODE_STATE MOVE=1 MOVE_SPEED=9\n"
                "G1 X2 E9\n");
  EXPECT_EQ(runs_of(moved), (std::vector<Points>{{{0, 0}, {1, 0}, {2, 0}}}));
  EXPECT_EQ(moved.travel_mm, 10);
  EXPECT_EQ(refusal(print + "RESTORE_GCODE_STATE NAME=there\n"),
            "a.gcode:9: the state 'there' has not been saved");
}

TEST(GcodeReader, WhatIsPulledBackBelongsToItsTool) {
  const std::string text = kStart + "T0\nG1 X1 E1\nG1 E-10\n";
  // The other tool's first move pushes as much as the first one's pulled.
  EXPECT_EQ(runs_of(read_text(text + "T1\nG1 X5 E10\n")),
            (std::vector<Points>{{{0, 0}, {1, 0}, {5, 0}}}));
  for (const char* none : {"T0\n", "Tx\n", ""})
    EXPECT_EQ(runs_of(read_text(text + none + "G1 X5 E10\nG1 X6 E1\n")),
              (std::vector<Points>{{{0, 0}, {1, 0}}, {{5, 0}, {6, 0}}}))
        << none;
}

TEST(GcodeReader, TheMarkOfUtf8IsNoPartOfTheText) {
  EXPECT_EQ(runs_of(read_text("\xEF\xBB\xBF" + kStart + "G1 X1 E1\n")),
            (std::vector<Points>{{{0, 0}, {1, 0}}}));
}

TEST(GcodeReader, LinesMayLieAcrossTheBlocksInWhichAFileIsRead) {
  std::string text = kStart;
  Points expected = {{0, 0}};
  for (int k = 1; text.size() < 3'000'000; ++k) {
    text += "G1 X" + std::to_string(k % 97) + " Y" + std::to_string(k) + " E1 ; " +
            std::string(static_cast<std::size_t>(k % 300), 'x') + "\n";
    expected.push_back({static_cast<double>(k % 97), static_cast<double>(k)});
  }
  EXPECT_EQ(runs_of(read_text(text)), std::vector<Points>{expected});
}

}  // namespace
}  // namespace routebench
