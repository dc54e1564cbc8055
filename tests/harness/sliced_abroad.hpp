#pragma once
/// G-code that the slicers of this machine make of small models.

#include <filesystem>
#include <string>

#include "program_path.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/stl.hpp"
#include "routebench/harness/slicer.hpp"
#include "scratch_dir.hpp"
#include "slicers/process.hpp"
#include "slicers/slicer_kind.hpp"

namespace routebench::test {

/// The slicer of a name; nullptr if this machine lacks it.
inline const slicers::SlicerKind* installed_slicer(const std::string& name) {
  for (const slicers::SlicerKind& kind : slicers::slicer_kinds())
    if (kind.name == name)
      return program_path(std::string(kind.program)) && kind.lacks().empty() ? &kind : nullptr;
  return nullptr;
}

/// Has a model sliced; returns the exit code. The G-code is `model.gcode` in the folder.
inline int slice_abroad(const slicers::SlicerKind& kind, const std::string& model, const Task& task,
                        const Printer& printer, const std::filesystem::path& folder) {
  write_stl(folder / "model.stl", load_model(model).mesh);
  const slicers::SlicerCall call =
      kind.call({task, printer, folder / "model.stl", folder / "model.gcode", folder});
  ProcessCall process{.program = *program_path(std::string(kind.program)),
                      .arguments = call.arguments,
                      .environment = call.environment,
                      .folder = folder,
                      .log = folder / "log",
                      .memory_mb = std::nullopt,
                      .timeout_s = std::nullopt};
  return run_process(process).exit_code;
}

}  // namespace routebench::test
