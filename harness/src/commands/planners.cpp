#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "json_documents.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench {
namespace {

struct PlannersArguments {
  std::string name;
  std::vector<std::string> plugins;
  bool json = false;
};

/// "from 0 to 5 mm", "true or false", "one of a, b".
std::string values_of(const ParamSchema& param) {
  const auto bound = [](const std::optional<double>& value) {
    return value ? to_string(ParamValue(*value)) : std::string("any");
  };
  switch (param.type) {
    case ParamType::kBool:
      return "true or false";
    case ParamType::kChoice: {
      std::string names;
      for (const std::string& choice : param.choices) names += (names.empty() ? "" : ", ") + choice;
      return "one of " + names;
    }
    case ParamType::kInt:
    case ParamType::kReal:
      break;
  }
  return std::string(param.type == ParamType::kInt ? "whole number" : "number") + " from " +
         bound(param.lowest) + " to " + bound(param.highest) +
         (param.unit.empty() ? "" : " " + param.unit);
}

void print_planner(std::ostream& out, const Registry::Entry& entry) {
  out << entry.info.name << " (" << to_string(entry.info.role) << ", " << entry.origin << ")\n"
      << entry.info.summary << '\n';
  if (!entry.info.source.empty()) out << "Source: " << entry.info.source << '\n';
  for (const ParamSchema& param : entry.params)
    out << "\n  " << param.name << " = " << to_string(param.default_value) << "\n      "
        << param.help << "; " << values_of(param) << '\n';
}

void print_all(std::ostream& out, const PlannerSet& planners) {
  std::size_t widest = 0;
  for (const auto& [name, entry] : planners.registry.entries())
    widest = std::max(widest, name.size());
  for (const auto& [name, entry] : planners.registry.entries())
    out << name << std::string(widest - name.size() + 2, ' ')
        << (entry.info.role == PlannerRole::kShell ? "shell  " : "fill   ") << entry.info.summary
        << " (" << entry.origin << ")\n";
  out << '\n';
  for (const PluginFolder& folder : planners.folders)
    out << "searched: " << folder.path << (folder.exists ? "" : " (is not there)") << '\n';
  for (const PluginRecord& plugin : planners.plugins) {
    std::string told = plugin.refused_because;
    for (const std::string& name : plugin.planners) told += (told.empty() ? "" : ", ") + name;
    out << (plugin.loaded ? "loaded: " : "refused: ") << plugin.file << ": " << told << '\n';
  }
}

void list(const PlannersArguments& arguments) {
  PlannerSet planners = load_planners(arguments.plugins);
  add_commands(planners, std::span(&arguments.name, 1));
  const bool all = arguments.name.empty();
  OutputSet none;
  if (arguments.json) {
    write_json(none, "-",
               all ? planners_document(planners) : json_of(planners.registry.at(arguments.name)));
  } else if (all) {
    print_all(std::cout, planners);
  } else {
    print_planner(std::cout, planners.registry.at(arguments.name));
  }
  std::cout.flush();  // the list comes before the complaint
  require_all_loaded(planners);
}

}  // namespace

void add_planners_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<PlannersArguments>();
  CLI::App& command =
      *app.add_subcommand("planners", "List the planners, or one with its parameters");
  command.add_option("NAME", arguments->name, "Show this one with its parameters")->type_name("");
  command.add_flag("--json", arguments->json, "Print JSON");
  add_plugin_option(command, arguments->plugins);
  command.callback([arguments, &exit_code] {
    list(*arguments);
    exit_code = 0;
  });
}

}  // namespace routebench
