#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "arguments.hpp"
#include "program_path.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/provenance.hpp"
#include "routebench/harness/version.hpp"
#include "routebench/planning/plugin.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

/// The Python that plots run with.
constexpr const char* kPython = "/usr/bin/python3";
constexpr const char* kPythonProbe =
    "import sys, numpy, matplotlib; print(sys.version.split()[0] + ', numpy ' + numpy.__version__ "
    "+ ', matplotlib ' + matplotlib.__version__)";

/// One thing that was looked at.
struct Finding {
  std::string name;
  bool ok = true;
  std::string detail;  ///< what was found, or what is missing and what that costs
};

Finding program() {
  const Provenance here = collect_provenance();
  std::string detail = here.routebench_version;
  if (here.git_commit)
    detail += ", commit " + here.git_commit->substr(0, 12) +
              (here.git_dirty.value_or(false) ? " with changes" : "");
  return {"routebench", true,
          detail + ", built by " + here.compiler + " with " + here.compiler_flags};
}

Finding libraries() {
  std::string detail;
  const Json versions = Json::parse(collect_provenance().libraries_json);
  for (const auto& [name, version] : versions.items())
    detail += (detail.empty() ? "" : ", ") + name + " " + version.get<std::string>();
  return {"libraries", true, detail};
}

Finding machine() {
  const Provenance here = collect_provenance();
  return {"machine", true,
          here.cpu + ", " + std::to_string(here.cores) + " cores, " +
              readable(std::trunc(static_cast<double>(here.memory_bytes) / (1 << 20))) + " MB, " +
              here.os};
}

/// The smallest step that two readings of a clock show.
std::int64_t smallest_step_ns(clockid_t clock) {
  const auto now = [clock] {
    std::timespec time{};
    clock_gettime(clock, &time);
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
  };
  std::int64_t smallest = std::int64_t{1} << 60;
  constexpr int kReadings = 1000;
  for (int i = 0; i < kReadings; ++i) {
    const std::int64_t before = now();
    std::int64_t after = now();
    while (after == before) after = now();
    smallest = std::min(smallest, after - before);
  }
  return smallest;
}

Finding timers() {
  const std::int64_t wall = smallest_step_ns(CLOCK_MONOTONIC);
  const std::int64_t cpu = smallest_step_ns(CLOCK_THREAD_CPUTIME_ID);
  constexpr std::int64_t kCoarseNs = 100'000;
  const std::string steps = "smallest step of the wall clock " + std::to_string(wall) +
                            " ns, of a thread's CPU clock " + std::to_string(cpu) + " ns";
  if (wall < kCoarseNs && cpu < kCoarseNs) return {"timers", true, steps};
  return {"timers", false, steps + ": too coarse to time the planning of single layers"};
}

Finding planners(const std::vector<std::string>& plugin_files) {
  const PlannerSet planners = load_planners(plugin_files);
  std::string names;
  for (const auto& [name, entry] : planners.registry.entries())
    names += (names.empty() ? "" : ", ") + name;
  Finding finding{"planners", true, names.empty() ? "none" : names};
  for (const PluginRecord& plugin : planners.plugins) {
    if (plugin.loaded) continue;
    finding.ok = false;
    finding.detail += "; refused " + plugin.file + ": " + plugin.refused_because;
  }
  return finding;
}

/// What a command prints on its first line; nothing if it fails.
std::optional<std::string> first_line_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) return std::nullopt;
  std::array<char, 512> line{};
  if (std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) == nullptr)
    return std::nullopt;
  std::string text = line.data();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

Finding python() {
  const auto versions =
      first_line_of(std::string(kPython) + " -I -c \"" + kPythonProbe + "\" 2>/dev/null");
  if (versions) return {"python", true, *versions + " (" + kPython + ")"};
  return {"python", false,
          std::string(kPython) + " with numpy and matplotlib: needed for plots; install " +
              "python3-numpy and python3-matplotlib"};
}

Finding scans() {
  try {
    const Model model = load_model("cgal:meshes/elephant.off");
    return {"cgal: models", true,
            "elephant.off has " + std::to_string(model.report.triangles) + " triangles"};
  } catch (const Error& error) {
    return {"cgal: models", false, error.what()};
  }
}

Finding slicer(const std::string& name, const std::string& package) {
  if (const auto file = program_path(name)) return {name, true, file->string()};
  return {name, false, "needed only to compare with this slicer; install " + package};
}

Finding write_access() {
  std::error_code error;
  const fs::path here = fs::current_path(error);
  if (!error && access(here.c_str(), W_OK | X_OK) == 0)
    return {"write access", true, here.string()};
  return {"write access", false,
          "files cannot be written in " + here.string() + "; results need --out"};
}

void examine(const std::vector<std::string>& plugin_files) {
  const std::vector<Finding> findings = {program(),
                                         libraries(),
                                         machine(),
                                         timers(),
                                         planners(plugin_files),
                                         write_access(),
                                         python(),
                                         scans(),
                                         slicer("prusa-slicer", "prusa-slicer"),
                                         slicer("slic3r", "slic3r"),
                                         slicer("CuraEngine", "cura-engine")};
  std::size_t widest = 0;
  for (const Finding& finding : findings) widest = std::max(widest, finding.name.size());
  for (const Finding& finding : findings)
    std::cout << (finding.ok ? "ok       " : "missing  ") << finding.name
              << std::string(widest - finding.name.size() + 2, ' ') << finding.detail << '\n';
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  const auto plugins = std::make_shared<std::vector<std::string>>();
  CLI::App& command = *app.add_subcommand("doctor", "Tell what this machine has and lacks");
  add_plugin_option(command, *plugins);
  command.callback([plugins, &exit_code] {
    examine(*plugins);
    exit_code = 0;
  });
}

}  // namespace routebench
