#include "routebench/harness/slicer.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <new>

#include "program_path.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/nearest_name.hpp"
#include "routebench/geometry/stl.hpp"
#include "routebench/planning/params.hpp"
#include "routebench/planning/sha256.hpp"
#include "run_child.hpp"
#include "scratch_folder.hpp"
#include "slicers/command.hpp"
#include "slicers/process.hpp"
#include "slicers/slicer_kind.hpp"

namespace routebench {
namespace fs = std::filesystem;
namespace slicers {

std::string number(double value) { return to_string(ParamValue(value)); }

std::span<const SlicerKind> slicer_kinds() {
  static constexpr auto kNothing = [] { return std::string(); };
  static constexpr std::array kKinds{
      SlicerKind{"prusa-slicer", "prusa-slicer", "--help", "PrusaSlicer-", prusa_slicer_call,
                 kNothing},
      SlicerKind{"slic3r", "slic3r", "--version", "", slic3r_call, kNothing},
      SlicerKind{"cura-engine", "CuraEngine", "help", "version ", cura_engine_call,
                 cura_engine_lacks},
  };
  return kKinds;
}

}  // namespace slicers

namespace {

using slicers::SliceJob;
using slicers::SlicerKind;

constexpr double kVersionTimeoutS = 30;
/// A process that failed within this share of its memory limit is taken to have failed for it.
constexpr double kAtMemoryLimit = 0.9;

const SlicerKind& kind_named(const std::string& name) {
  for (const SlicerKind& kind : slicers::slicer_kinds())
    if (kind.name == name) return kind;
  const std::vector<std::string> names = slicer_names();
  const std::optional<std::string> near = nearest_name(name, names);
  std::string known;
  for (const std::string& other : names) known += (known.empty() ? "" : ", ") + other;
  throw Error(ErrorKind::kBadInput,
              "unknown slicer '" + name + "'" +
                  (near ? "; did you mean " + *near + "?"
                        : "; known are " + known + "; or give { command = \"...\" }"));
}

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The last lines that say something, in one line.
std::string last_words(const std::string& log) {
  constexpr std::size_t kMostBytes = 300;
  std::string words;
  std::size_t end = log.size();
  while (end > 0 && end != log.npos) {
    const std::size_t before = log.find_last_of("\r\n", end - 1);
    std::string line = log.substr(before == log.npos ? 0 : before + 1,
                                  before == log.npos ? end : end - before - 1);
    end = before;
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    if (line.find_first_not_of(" ?") == line.npos) continue;
    if (line.size() > kMostBytes) line.resize(kMostBytes);
    if (!words.empty() && line.size() + words.size() > kMostBytes) break;
    words = line + (words.empty() ? "" : " / ") + words;
  }
  return words;
}

/// What a known slicer says of its version; "unknown" if that cannot be found in what it says.
std::string version_of(const SlicerKind& kind, const fs::path& program) {
  const ScratchFolder scratch(fs::temp_directory_path());
  const fs::path log = scratch.path() / "log";
  static_cast<void>(run_process({program,
                                 {std::string(kind.version_argument)},
                                 {{"LC_ALL", "C"}, {"HOME", scratch.path()}},
                                 scratch.path(),
                                 log,
                                 std::nullopt,
                                 kVersionTimeoutS}));
  const std::string text = text_of_file(log);
  const std::size_t before = text.find(kind.version_after);
  if (before == text.npos) return "unknown";
  const std::size_t begin = text.find_first_not_of(" \n", before + kind.version_after.size());
  if (begin == text.npos) return "unknown";
  return text.substr(begin, text.find_first_of(" \n", begin) - begin);
}

/// Throws if the program did not end well.
void require_success(const ProcessEnd& end, const fs::path& program, const std::string& log,
                     int memory_mb) {
  if (end.signal == 0 && end.exit_code == 0) return;
  const double limit_bytes = static_cast<double>(memory_mb) * (1 << 20);
  if (end.peak_rss_bytes > kAtMemoryLimit * limit_bytes ||
      log.find("bad_alloc") != std::string::npos)
    throw std::bad_alloc();
  const std::string words = last_words(log);
  throw Error(ErrorKind::kBadInput,
              program.filename().string() +
                  (end.signal != 0 ? " was killed by " + signal_name(end.signal)
                                   : " ended with exit code " + std::to_string(end.exit_code)) +
                  (words.empty() ? "" : "; it last wrote: " + words));
}

}  // namespace

std::vector<std::string> slicer_names() {
  std::vector<std::string> names;
  for (const SlicerKind& kind : slicers::slicer_kinds()) names.emplace_back(kind.name);
  return names;
}

void check_slicer(const SlicerSpec& spec) {
  if (spec.command.empty())
    static_cast<void>(kind_named(spec.name));
  else
    static_cast<void>(slicers::command_words(spec.command));
}

Slicer::Slicer(SlicerSpec spec) : spec_(std::move(spec)) {
  const bool known = spec_.command.empty();
  const SlicerKind* kind = known ? &kind_named(spec_.name) : nullptr;
  std::string name =
      known ? std::string(kind->program) : slicers::command_words(spec_.command).front();
  if (name.find('/') != name.npos) name = spec_.folder / name;
  const std::optional<fs::path> found = program_path(name);
  if (!found) {
    missing_ =
        name + " is not there" + (known ? "; experiments/install_slicers.sh installs it" : "");
    return;
  }
  program_ = fs::absolute(*found);
  if (!known) {
    version_ = "sha256:" + sha256_of_file(program_).value_or("unknown");
    return;
  }
  missing_ = kind->lacks();
  if (missing_.empty()) version_ = version_of(*kind, program_);
}

SlicerRun Slicer::run(const Mesh& mesh, const Task& task, const Printer& printer,
                      const fs::path& scratch, int memory_mb) const {
  const ScratchFolder folder(scratch);
  const SliceJob job{task, printer, folder.path() / "model.stl", folder.path() / "model.gcode",
                     folder.path()};
  write_stl(job.model, mesh);
  ProcessCall call{.program = program_,
                   .arguments = {},
                   .environment = {{"LC_ALL", "C"}},
                   .folder = folder.path(),
                   .log = folder.path() / "log",
                   .memory_mb = memory_mb,
                   .timeout_s = std::nullopt};
  if (spec_.command.empty()) {
    slicers::SlicerCall known = kind_named(spec_.name).call(job);
    call.arguments = std::move(known.arguments);
    for (auto& variable : known.environment) call.environment.push_back(std::move(variable));
  } else {
    call.arguments = slicers::filled_words(slicers::command_words(spec_.command), job);
    call.arguments.erase(call.arguments.begin());
  }
  const ProcessEnd end = run_process(call);
  require_success(end, program_, text_of_file(call.log), memory_mb);
  SlicerRun run;
  run.wall_s = end.wall_s;
  run.cpu_s = end.cpu_s;
  run.peak_rss_bytes = end.peak_rss_bytes;
  if (spec_.command.empty()) run.offset_mm = Point2{};
  if (!fs::exists(job.gcode))
    throw Error(ErrorKind::kBadInput, program_.filename().string() + " wrote no G-code");
  try {
    run.print = read_gcode_file(
        job.gcode, {.layer_height_mm = task.layer_height_mm, .filament_mm = printer.filament_mm});
  } catch (const Error& error) {
    // Without the folder, which nobody can look into any more.
    std::string reason = error.what();
    const std::string path = job.gcode.string();
    if (reason.starts_with(path)) reason = "its G-code" + reason.substr(path.size());
    throw Error(ErrorKind::kBadInput, program_.filename().string() + ": " + reason);
  }
  return run;
}

}  // namespace routebench
