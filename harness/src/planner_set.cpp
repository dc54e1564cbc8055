/// Which planners a program has: built in, from plugin files, from commands.

#include <filesystem>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "plugin_files.hpp"
#include "process_planner.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/config.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/planning/sha256.hpp"

namespace routebench {
namespace {

void add_plugin(PlannerSet& planners, const std::filesystem::path& file, bool by_name) {
  PluginRecord record;
  if (is_python_plugin(file.string())) {
    record = load_python_plugin(planners.registry, file.string());
  } else if (const std::string trouble = trouble_of_plugin(planners.registry, file);
             trouble.empty()) {
    record = load_plugin(planners.registry, file);
  } else {
    record.file = file.string();
    record.sha256 = sha256_of_file(file).value_or("");
    record.refused_because = trouble;
  }
  record.by_name = by_name;
  planners.plugins.push_back(std::move(record));
}

[[noreturn]] void refuse(const PluginRecord& plugin) {
  throw Error(ErrorKind::kBadInput,
              "plugin " + plugin.file + ": refused: " + plugin.refused_because);
}

/// A planner that is not there.
class StandIn final : public Planner {
 public:
  explicit StandIn(std::string reason) : reason_(std::move(reason)) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override {
    throw Error(ErrorKind::kBadInput, reason_);
  }

 private:
  std::string reason_;
};

Registry::Entry stand_in(const std::string& name, PlannerRole role, const std::string& origin,
                         const std::string& reason) {
  Registry::Entry entry;
  entry.info = {name, role, "not there", ""};
  entry.origin = origin;
  entry.resolve = [](const ParamSet& given) { return given; };
  entry.make = [reason](const ParamSet&) { return std::make_unique<const StandIn>(reason); };
  return entry;
}

/// What a contender's slot wants.
struct SlotUse {
  const std::string& planner;
  PlannerRole role;
};

template <typename Act>
void for_each_slot(const ExperimentConfig& config, Act&& act) {
  for (const ConfiguredContender& contender : config.contenders) {
    const ContenderSpec& spec = contender.spec;
    if (spec.shell) act(contender, SlotUse{spec.shell->planner, PlannerRole::kShell});
    if (spec.fill) act(contender, SlotUse{spec.fill->planner, PlannerRole::kFill});
  }
}

/// Registers something under every name that nobody knows, if plugins have been refused.
void stand_in_for_refused(PlannerSet& planners, const ExperimentConfig& config) {
  std::string reason, origin;
  for (const PluginRecord& plugin : planners.plugins) {
    if (plugin.loaded || !plugin.by_name || is_command(plugin.file)) continue;
    if (!std::filesystem::exists(plugin.file)) refuse(plugin);
    reason += "; plugin " + plugin.file + " was refused: " + plugin.refused_because;
    if (origin.empty()) origin = plugin.file;
  }
  if (reason.empty()) return;
  for_each_slot(config, [&](const ConfiguredContender&, const SlotUse& slot) {
    if (!planners.registry.entries().contains(slot.planner))
      planners.registry.add_entry(
          stand_in(slot.planner, slot.role, origin, "it is not there" + reason));
  });
}

/// Registers a command under its own name, or not if it does not say what it is.
/// Throws Error{kBadInput} if it names no program.
const PluginRecord& add_command(PlannerSet& planners, const std::string& name,
                                const std::filesystem::path& folder) {
  planners.plugins.push_back(load_command(planners.registry, name, folder));
  return planners.plugins.back();
}

/// What a command cannot be asked for is told by the cells that need it.
void add_commands_or_stand_ins(PlannerSet& planners, const ExperimentConfig& config) {
  const std::filesystem::path folder = std::filesystem::absolute(config.file).parent_path();
  for_each_slot(config, [&](const ConfiguredContender& contender, const SlotUse& slot) {
    if (!is_command(slot.planner) || planners.registry.entries().contains(slot.planner)) return;
    try {
      const PluginRecord& command = add_command(planners, slot.planner, folder);
      if (!command.loaded)
        planners.registry.add_entry(stand_in(slot.planner, slot.role, command.file,
                                             "it was refused: " + command.refused_because));
    } catch (const Error& error) {
      const std::string slot_name = slot.role == PlannerRole::kShell ? "shell" : "fill";
      throw Error(ErrorKind::kBadInput, contender.key_places.at(slot_name + ".planner") +
                                            ": key `" + slot_name + ".command`: " + error.what());
    }
  });
}

}  // namespace

PlannerSet load_planners(std::span<const std::string> plugin_files) {
  PlannerSet planners;
  register_builtin_planners(planners.registry);
  std::set<std::filesystem::path> seen;  // a file that config and command line both name is one
  std::error_code error;
  for (const std::string& file : plugin_files)
    if (seen.insert(std::filesystem::weakly_canonical(file, error)).second)
      add_plugin(planners, file, true);
  for (const std::filesystem::path& folder : plugin_folders()) {
    planners.folders.push_back({folder.string(), std::filesystem::is_directory(folder, error)});
    for (const std::filesystem::path& file : plugin_files_in(folder))
      if (seen.insert(std::filesystem::weakly_canonical(file, error)).second)
        add_plugin(planners, file, false);
  }
  return planners;
}

void add_commands(PlannerSet& planners, std::span<const std::string> names,
                  const std::filesystem::path& folder) {
  for (const std::string& name : names) {
    if (!is_command(name) || planners.registry.entries().contains(name)) continue;
    if (const PluginRecord& command = add_command(planners, name, folder); !command.loaded)
      refuse(command);
  }
}

void require_all_loaded(const PlannerSet& planners) {
  for (const PluginRecord& plugin : planners.plugins)
    if (!plugin.loaded && plugin.by_name) refuse(plugin);
}

PlannerSet load_planners_for(const ExperimentConfig& config,
                             std::span<const std::string> plugin_files) {
  PlannerSet planners = load_planners(plugin_files);
  add_commands_or_stand_ins(planners, config);
  stand_in_for_refused(planners, config);
  return planners;
}

}  // namespace routebench
