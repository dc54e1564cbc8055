#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/config.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/provenance.hpp"
#include "routebench/harness/results.hpp"
#include "routebench/harness/runner.hpp"

namespace routebench {
namespace {

constexpr int kExitNotAllValid = 1;
constexpr int kExitInterrupted = 130;

struct Arguments {
  std::string config;
  std::string out;
  int jobs = -1;
  bool fresh = false;
  bool dry_run = false;
  bool repair = false;
  std::vector<std::string> plugins;
  std::vector<std::string> only;
};

/// Sorts "contender=NAME" and "model=SPEC" to where they belong.
void read_only(const std::vector<std::string>& only, RunnerOptions& options) {
  for (const std::string& choice : only) {
    const std::size_t equals = choice.find('=');
    const std::string kind = choice.substr(0, equals);
    if (equals == std::string::npos || (kind != "contender" && kind != "model"))
      throw Error(ErrorKind::kBadUsage,
                  "--only " + choice + ": must be contender=NAME or model=SPEC");
    (kind == "model" ? options.only_models : options.only_contenders)
        .push_back(choice.substr(equals + 1));
  }
}

RunnerOptions options_of(const Arguments& arguments, const ExperimentConfig& config) {
  RunnerOptions options;
  options.out = arguments.out.empty() ? std::filesystem::path("results") / config.name
                                      : std::filesystem::path(arguments.out);
  if (arguments.jobs >= 0) options.jobs = arguments.jobs;
  options.fresh = arguments.fresh;
  options.dry_run = arguments.dry_run;
  options.repair = arguments.repair;
  options.command_line = command_line();
  read_only(arguments.only, options);
  return options;
}

PlannerSet planners_of(const ExperimentConfig& config, const Arguments& arguments) {
  std::vector<std::string> files = config.plugins;
  files.insert(files.end(), arguments.plugins.begin(), arguments.plugins.end());
  PlannerSet planners = load_planners(files);
  std::vector<ContenderSpec> contenders;
  std::vector<std::string> names;
  for (const ConfiguredContender& contender : config.contenders) {
    contenders.push_back(contender.spec);
    for (const std::optional<SlotSpec>& slot : {contender.spec.shell, contender.spec.fill})
      if (slot) names.push_back(slot->planner);
  }
  add_commands(planners, names, std::filesystem::absolute(config.file).parent_path());
  stand_in_for_refused(planners, contenders);
  return planners;
}

int run(const Arguments& arguments) {
  const ExperimentConfig config = load_config(arguments.config);
  const PlannerSet planners = planners_of(config, arguments);
  print_refused(planners);
  const RunLog log{&std::cerr, isatty(STDERR_FILENO) == 1};
  const RunSummary summary = run_experiment(config, planners, options_of(arguments, config), log);
  if (arguments.dry_run) return 0;
  if (summary.interrupted) {
    std::cerr << "routebench: interrupted; " << summary.executed + summary.found
              << " cells are done and kept, " << summary.left
              << " are left; the same command goes on\n";
    return kExitInterrupted;
  }
  const std::vector<StoredCell> cells = current_cells(summary.file);
  write_to_stdout([&](std::ostream& out) {
    write_ranking(out, cells);
    out << "\nresults: " << summary.file.string() << '\n';
  });
  return all_valid(cells) ? 0 : kExitNotAllValid;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("run", "execute an experiment and rank its contenders");
  command.add_option("CONFIG", arguments->config, "the experiment, a TOML file")->required();
  command.add_option("--out", arguments->out, "folder of the results [results/NAME]")
      ->type_name("DIR");
  command
      .add_option("--jobs,-j", arguments->jobs,
                  "cells at a time; 0: one a core [as the config says]")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  command.add_flag("--fresh", arguments->fresh,
                   "start anew; replace old results when a new cell is done");
  command.add_flag("--dry-run", arguments->dry_run,
                   "check, say what would be executed, write nothing");
  command.add_flag("--repair", arguments->repair, "slice broken models, mark the layers concerned");
  add_plugin_option(command, arguments->plugins);
  add_repeated(command, "--only", arguments->only, "WHAT",
               "execute only contender=NAME or model=SPEC");
  command.footer(
      "Cells that the results hold already are not executed again, so the same command goes on\n"
      "after an interruption. Ctrl-C keeps what is done. Timing samples are taken one at a time,\n"
      "whatever --jobs says.\n"
      "Exit codes: 0 all cells valid, 1 some are not, 2 bad usage, config or model, 3 internal\n"
      "error, 130 interrupted.");
  command.callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace routebench
