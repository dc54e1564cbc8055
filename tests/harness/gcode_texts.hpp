#pragma once
/// Texts of G-code through the reader.

#include <gtest/gtest.h>

#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "routebench/geometry/error.hpp"
#include "routebench/harness/gcode_reader.hpp"

namespace routebench::test {

using Points = std::vector<Point2>;

inline GcodePrint read_text(const std::string& text, const GcodeOptions& options = {}) {
  std::istringstream in(text);
  return read_gcode(in, "a.gcode", options);
}

/// The message with which a text is refused.
inline std::string refusal(const std::string& text) {
  try {
    static_cast<void>(read_text(text));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    return error.what();
  }
  return "not refused";
}

/// The strokes of all layers.
inline std::vector<Points> strokes_of(const GcodePrint& print) {
  std::vector<Points> strokes;
  for (const GcodeLayer& layer : print.layers)
    for (const Stroke& stroke : layer.route.strokes) strokes.push_back(stroke.points);
  return strokes;
}

/// The same with strokes that meet taken as one, as the judge does: where the tests' round numbers
/// of E would mean another width, the reader cuts.
inline std::vector<Points> runs_of(const GcodePrint& print) {
  std::vector<Points> runs;
  for (const Points& stroke : strokes_of(print))
    if (runs.empty() || runs.back().back() != stroke.front())
      runs.push_back(stroke);
    else
      runs.back().insert(runs.back().end(), stroke.begin() + 1, stroke.end());
  return runs;
}

inline std::vector<double> heights_of(const GcodePrint& print) {
  std::vector<double> z;
  for (const GcodeLayer& layer : print.layers) z.push_back(layer.z_mm);
  return z;
}

inline constexpr double kFilamentSection = std::numbers::pi / 4 * 1.75 * 1.75;
inline double section_mm2(double width_mm) {
  return (width_mm - 0.2) * 0.2 + std::numbers::pi * 0.01;
}

inline const std::string kStart = "G21\nG90\nM83\nG1 Z0.2\nG0 X0 Y0\n";

inline std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

}  // namespace routebench::test
