#pragma once
/// The slicers that are known: how each is found, asked and told what to do.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "routebench/harness/task.hpp"

namespace routebench::slicers {

/// Settings of a slicer, in its own words.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// What is to be sliced.
struct SliceJob {
  const Task& task;
  const Printer& printer;
  std::filesystem::path model;   ///< binary STL
  std::filesystem::path gcode;   ///< to be written
  std::filesystem::path folder;  ///< for what else there is to be written
};

struct SlicerCall {
  std::vector<std::string> arguments;
  std::vector<std::pair<std::string, std::string>> environment;
};

struct SlicerKind {
  std::string_view name;
  std::string_view program;
  std::string_view version_argument;  ///< makes it state its version
  std::string_view version_after;     ///< the text before that; empty: nothing stands before it
  /// Makes the call for a job, writing files into the job's folder if need be. The G-code has the
  /// model's own places.
  SlicerCall (*call)(const SliceJob& job);
  /// What it needs besides the program and lacks, in one line; empty: nothing.
  std::string (*lacks)();
};

[[nodiscard]] std::span<const SlicerKind> slicer_kinds();

// The slicers' own pages: prusa_slicer.cpp, slic3r.cpp, cura_engine.cpp.
[[nodiscard]] Settings prusa_slicer_settings(const Task& task, const Printer& printer);
[[nodiscard]] SlicerCall prusa_slicer_call(const SliceJob& job);
[[nodiscard]] Settings slic3r_settings(const Task& task, const Printer& printer);
[[nodiscard]] SlicerCall slic3r_call(const SliceJob& job);
[[nodiscard]] Settings cura_engine_settings(const Task& task, const Printer& printer);
[[nodiscard]] SlicerCall cura_engine_call(const SliceJob& job);
[[nodiscard]] std::string cura_engine_lacks();

/// A number as every slicer reads it, the shortest that is exact.
[[nodiscard]] std::string number(double value);

}  // namespace routebench::slicers
