#pragma once
/// Foreign slicers: programs of others that print a model, as contenders.

#include <filesystem>
#include <optional>
#include <string>

#include "routebench/geometry/types.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/slicer_spec.hpp"
#include "routebench/harness/task.hpp"

namespace routebench {

/// What came of a slicer's run.
struct SlicerRun {
  GcodePrint print;
  /// What has to be added to the print's places; nothing if that must be found out.
  std::optional<Point2> offset_mm;
  double wall_s = 0;          ///< of the whole program: mesh read, sliced, G-code written
  double cpu_s = 0;           ///< of all its threads and processes
  double peak_rss_bytes = 0;  ///< of the largest of its processes
};

/// A slicer as it is, or is not, on this machine. Immutable.
class Slicer {
 public:
  /// Looks for the program and asks its version. Must be called while this process has no other
  /// thread. Throws as check_slicer does; a program that is not there is no error.
  explicit Slicer(SlicerSpec spec);

  [[nodiscard]] const SlicerSpec& spec() const noexcept { return spec_; }
  /// As the program states it; of a command the SHA-256 of the program's file. Empty if missing.
  [[nodiscard]] const std::string& version() const noexcept { return version_; }
  /// Why it cannot be run, in one line; empty if it can.
  [[nodiscard]] const std::string& missing() const noexcept { return missing_; }

  /// Has a mesh sliced for a task and a printer (experiments/README.md lists the settings).
  ///
  /// Takes   a folder that may be written; a folder of its own is made there for the time of the
  ///         run. A process in it may take memory_mb.
  /// Throws  Error{kBadInput} with the program's last words if it fails or makes no G-code that can
  ///         be read; std::bad_alloc if it failed for want of memory.
  [[nodiscard]] SlicerRun run(const Mesh& mesh, const Task& task, const Printer& printer,
                              const std::filesystem::path& scratch, int memory_mb) const;

 private:
  SlicerSpec spec_;
  std::filesystem::path program_;
  std::string version_;
  std::string missing_;
};

}  // namespace routebench
