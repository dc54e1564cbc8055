#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <map>
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

struct Arguments {
  std::string config;
  std::string out;
  std::optional<int> jobs;
  bool fresh = false;
  bool dry_run = false;
  bool repair = false;
  std::vector<std::string> plugins;
  std::vector<std::string> only;
  std::string shard;
  std::string progress;
};

/// Sorts "contender=NAME", "model=SPEC" and "setting=LABEL" to where they belong.
void read_only(const std::vector<std::string>& only, RunnerOptions& options) {
  const std::map<std::string, std::vector<std::string>*> kinds{
      {"contender", &options.only_contenders},
      {"model", &options.only_models},
      {"setting", &options.only_settings}};
  for (const std::string& choice : only) {
    const std::size_t equals = choice.find('=');
    const auto kind = kinds.find(choice.substr(0, equals));
    if (equals == std::string::npos || kind == kinds.end())
      throw Error(ErrorKind::kBadUsage,
                  "--only " + choice + ": must be contender=NAME, model=SPEC or setting=LABEL");
    kind->second->push_back(choice.substr(equals + 1));
  }
}

/// "2/3" as a shard.
Shard read_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard;
  const auto read = [&](std::string_view digits, std::size_t& number) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return error == std::errc{} && end == digits.data() + digits.size();
  };
  if (slash == std::string::npos || !read(std::string_view(text).substr(0, slash), shard.number) ||
      !read(std::string_view(text).substr(slash + 1), shard.count) || shard.number < 1 ||
      shard.number > shard.count)
    throw Error(ErrorKind::kBadUsage,
                "--shard " + text + ": must be I/N with I from 1 to N, such as 2/8");
  return shard;
}

/// The folder of results without --out. Shards have one each.
std::filesystem::path default_folder(const ExperimentConfig& config,
                                     const std::optional<Shard>& shard) {
  std::string name = config.name;
  if (shard)
    name += "-shard-" + std::to_string(shard->number) + "-of-" + std::to_string(shard->count);
  return std::filesystem::path("results") / name;
}

RunnerOptions options_of(const Arguments& arguments, const ExperimentConfig& config) {
  RunnerOptions options;
  if (!arguments.shard.empty()) options.shard = read_shard(arguments.shard);
  options.out = arguments.out.empty() ? default_folder(config, options.shard)
                                      : std::filesystem::path(arguments.out);
  options.jobs = arguments.jobs;
  options.fresh = arguments.fresh;
  options.repair = arguments.repair;
  options.command_line = command_line();
  read_only(arguments.only, options);
  return options;
}

int run(const Arguments& arguments) {
  const ExperimentConfig config = load_config(arguments.config);
  std::vector<std::string> plugins = config.plugins;
  plugins.insert(plugins.end(), arguments.plugins.begin(), arguments.plugins.end());
  const PlannerSet planners = load_planners_for(config, plugins);
  print_refused(planners);
  const RunnerOptions options = options_of(arguments, config);
  const RunLog log = log_of(arguments.progress);
  if (arguments.dry_run) {
    const Foresight foresight = foresee_experiment(config, planners, options, log);
    write_to_stdout([&](std::ostream& out) { write_foresight(out, foresight); });
    return 0;
  }
  const RunSummary summary = run_experiment(config, planners, options, log);
  if (summary.interrupted) return tell_interrupted(summary);
  const std::vector<StoredCell> cells = current_cells(summary.file);
  write_to_stdout([&](std::ostream& out) {
    write_ranking(out, cells);
    out << "\nresults: " << summary.file.string() << '\n';
  });
  return all_valid(cells) ? 0 : kExitNotValid;
}

}  // namespace

void add_run_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("run", "Execute an experiment and rank its contenders");
  command.add_option("CONFIG", arguments->config, "The experiment, a TOML file")
      ->type_name("")
      ->required();
  command
      .add_option("--out", arguments->out,
                  "Folder of the results [results/NAME; of a shard results/NAME-shard-I-of-N]")
      ->type_name("DIR");
  add_cell_jobs_option(command, arguments->jobs);
  command.add_flag("--fresh", arguments->fresh,
                   "Start anew; replace old results when a new cell is done");
  command.add_flag("--dry-run", arguments->dry_run,
                   "Check, say what would be executed, write nothing");
  command.add_flag("--repair", arguments->repair, "Slice broken models, mark the layers concerned");
  add_plugin_option(command, arguments->plugins);
  add_repeated(command, "--only", arguments->only, "WHAT",
               "Execute only contender=NAME, model=SPEC or setting=LABEL (or a part of a label: "
               "setting=density=1)");
  command
      .add_option("--shard", arguments->shard,
                  "Execute every N-th cell, from the I-th on, into a database of its own; "
                  "routebench merge joins them")
      ->type_name("I/N");
  add_progress_option(command, arguments->progress);
  command.footer(std::string("Cells that the results hold already are not executed again, so the "
                             "same command goes on\n"
                             "after an interruption. Ctrl-C keeps what is done. Timing samples are "
                             "taken one at a time,\n"
                             "whatever --jobs says.\n") +
                 exit_codes("all cells valid", "some are not"));
  command.callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace routebench
