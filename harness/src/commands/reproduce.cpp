#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "arguments.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/provenance.hpp"
#include "routebench/harness/reproduction.hpp"

namespace routebench {
namespace {

struct Arguments {
  std::string results;
  std::string out;
  std::string base;
  std::optional<int> jobs;
  bool fresh = false;
  std::vector<std::string> plugins;
  std::string progress;
};

/// An interrupted reproduction goes on; one that is done is not taken for a new one.
void require_unfinished(const std::filesystem::path& out, bool fresh) {
  std::error_code error;
  const std::filesystem::path file = out / "results.sqlite";
  if (fresh || !std::filesystem::exists(file, error) || !last_run(file).finished) return;
  throw Error(ErrorKind::kBadUsage,
              file.string() +
                  ": is a finished reproduction; --fresh makes it anew, --out DIR puts "
                  "another one elsewhere");
}

int reproduce(const Arguments& arguments) {
  const std::filesystem::path original = results_file(arguments.results);
  std::optional<std::filesystem::path> base;
  if (!arguments.base.empty()) base = arguments.base;
  const Reproduction again = read_reproduction(original, base);
  const PlannerSet planners = load_planners_for(
      again.config, arguments.plugins.empty() ? again.plugins : arguments.plugins);
  print_refused(planners);

  RunnerOptions options;
  options.out = arguments.out.empty() ? original.parent_path() / "reproduction"
                                      : std::filesystem::path(arguments.out);
  options.jobs = arguments.jobs;
  options.fresh = arguments.fresh;
  options.repair = again.repair;
  options.only_cells = again.cells;
  options.command_line = command_line();
  require_unfinished(options.out, options.fresh);
  const RunSummary summary =
      run_experiment(again.config, planners, options, log_of(arguments.progress));
  if (summary.interrupted) return tell_interrupted(summary);
  std::error_code error;
  if (!std::filesystem::exists(summary.file, error))
    throw Error(ErrorKind::kBadInput,
                original.string() +
                    ": its config has none of the cells that it holds, so nothing "
                    "was executed again");
  const Comparison comparison = compare_results(original, summary.file);
  write_to_stdout([&](std::ostream& out) {
    write_comparison(out, comparison);
    out << "results: " << summary.file.string() << '\n';
  });
  return comparison.differences.empty() ? 0 : kExitNotValid;
}

}  // namespace

void add_reproduce_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand(
      "reproduce", "Execute an experiment again from its results and say what differs");
  add_results_argument(command, arguments->results);
  command.add_option("--out", arguments->out, "Folder of the new results [RESULTS/reproduction]")
      ->type_name("DIR");
  command
      .add_option("--base", arguments->base,
                  "Where the config's relative paths begin [where they did]")
      ->type_name("DIR");
  add_cell_jobs_option(command, arguments->jobs);
  command.add_flag("--fresh", arguments->fresh, "Replace an earlier reproduction");
  add_repeated(command, "--plugin", arguments->plugins, "FILE",
               "Plugins to load instead of the files that were loaded then");
  add_progress_option(command, arguments->progress);
  command.footer(std::string("The config is the one that the database holds, and so are the cells. "
                             "Outcomes, routes and\n"
                             "all metrics but times and memory must be equal to the bit; what "
                             "differs is named. What was\n"
                             "different about program and machine is told beside it.\n") +
                 exit_codes("reproduced", "something differs"));
  command.callback([arguments, &exit_code] { exit_code = reproduce(*arguments); });
}

}  // namespace routebench
