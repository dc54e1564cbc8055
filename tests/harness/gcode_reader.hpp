#pragma once
/// A small reader of G-code for tests: knows nothing of the writer but the G-code language.

#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::test {

struct GcodeRun {
  double extrude_mm = 0;   ///< XY length of moves that push filament
  double travel_mm = 0;    ///< XY length of moves that do not, after the first push
  double filament_mm = 0;  ///< pushed while moving
  int retractions = 0;     ///< times that filament was pulled
  double pulled_mm = 0;    ///< balance of pulled and returned filament: 0 if all came back
  double longest_travel_mm = 0;
  std::vector<std::vector<Point2>> strokes;  ///< runs of pushing moves
  std::vector<double> stroke_z_mm;           ///< height of each
  std::vector<double> travel_heights_mm;     ///< height of each travelling move
  std::vector<std::string> comments;
  std::vector<std::string> fan_changes;
};

/// Follows absolute X Y Z, relative or absolute E, and G10 and G11 as pulls of 1. Throws
/// std::runtime_error for what it does not know.
inline GcodeRun read_gcode(const std::string& text) {
  GcodeRun run;
  std::optional<double> x, y, z;
  bool absolute_xyz = false, relative_e = false, absolute_e = false, millimetres = false;
  bool pushing = false;
  double counter = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (const auto semicolon = line.find(';'); semicolon != line.npos) {
      run.comments.push_back(line.substr(semicolon));
      line.resize(semicolon);
    }
    std::istringstream words(line);
    std::string code;
    if (!(words >> code)) continue;
    if (code == "G21") {
      millimetres = true;
    } else if (code == "G90") {
      absolute_xyz = true;
    } else if (code == "M83") {
      relative_e = true;
    } else if (code == "M82") {
      absolute_e = true;
    } else if (code == "G92" || code == "M106" || code == "M107" || code == "M84") {
      std::string word;
      if (code == "G92" && (!(words >> word) || word != "E0")) throw std::runtime_error(line);
      if (code == "M106" || code == "M107") run.fan_changes.push_back(line.substr(0, 6));
      if (code == "G92") counter = 0;
    } else if (code == "G10" || code == "G11") {
      pushing = false;
      run.retractions += code == "G10" ? 1 : 0;
      run.pulled_mm += code == "G10" ? 1 : -1;
    } else if (code == "G0" || code == "G1") {
      if (!absolute_xyz || relative_e == absolute_e || !millimetres)
        throw std::runtime_error("modes unsaid");
      std::map<char, double> word;
      for (std::string w; words >> w;) {
        if (w.find_first_not_of("0123456789.-", 1) != w.npos) throw std::runtime_error(line);
        word[w[0]] = std::stod(w.substr(1));
      }
      double e = word.count('E') ? word['E'] : 0;
      if (absolute_e && word.count('E')) e -= std::exchange(counter, e);
      const bool moves = word.count('X') || word.count('Y');
      const Point2 from{x.value_or(0), y.value_or(0)};
      if (word.count('X')) x = word['X'];
      if (word.count('Y')) y = word['Y'];
      if (word.count('Z')) z = word['Z'];
      const double length = std::hypot(x.value_or(0) - from.x, y.value_or(0) - from.y);
      if (moves && e > 0) {
        if (!pushing) {
          run.strokes.push_back({from});
          run.stroke_z_mm.push_back(*z);
        }
        pushing = true;
        run.strokes.back().push_back({*x, *y});
        run.extrude_mm += length;
        run.filament_mm += e;
      } else if (moves) {
        pushing = false;
        if (run.strokes.empty()) continue;  // the way to the first stroke
        run.travel_mm += length;
        run.longest_travel_mm = std::max(run.longest_travel_mm, length);
        run.travel_heights_mm.push_back(*z);
      } else if (e != 0) {
        pushing = false;
        if (e < 0) ++run.retractions;
        run.pulled_mm -= e;
      } else {
        pushing = false;
      }
    } else {
      throw std::runtime_error("unknown code " + code);
    }
  }
  return run;
}

}  // namespace routebench::test
