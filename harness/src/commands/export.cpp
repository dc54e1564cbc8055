#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>

#include "arguments.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/results.hpp"

namespace routebench {
namespace {

struct Arguments {
  std::string results;
  std::string out;
  std::string format;
};

void run(const Arguments& arguments) {
  const std::filesystem::path file = results_file(arguments.results);
  const std::filesystem::path folder = arguments.out.empty() ? file.parent_path() / arguments.format
                                                             : std::filesystem::path(arguments.out);
  const std::vector<std::filesystem::path> written = arguments.format == "ompl"
                                                         ? std::vector{export_ompl(file, folder)}
                                                         : export_csv(file, folder);
  write_to_stdout([&](std::ostream& out) {
    for (const std::filesystem::path& path : written) out << path.string() << '\n';
  });
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *app.add_subcommand("export", "Write results as CSV files or for Planner Arena");
  add_results_argument(command, arguments->results);
  command.add_option("--out", arguments->out, "Where the files go [RESULTS/FORMAT]")
      ->type_name("DIR");
  arguments->format = "csv";
  command.add_option("--format", arguments->format, "csv or ompl")
      ->check(CLI::IsMember({"csv", "ompl"}))
      ->type_name("FORMAT")
      ->capture_default_str();
  command.footer(
      "Format csv:\n"
      "cells.csv       one row a cell and metric: experiment, model, contender, setting, seed,\n"
      "                outcome, reason, layers, route_hash, metric, value, unit, better\n"
      "layers.csv      one row a cell and layer, a column a metric\n"
      "timings.csv     one row a cell and repetition: plan_wall_ns, plan_cpu_ns, minor_faults,\n"
      "                major_faults, peak_rss_bytes, run_started_utc, cpu\n"
      "models.csv, contenders.csv, settings.csv, runs.csv, metrics.csv: what the names stand for\n"
      "UTF-8, a header line each, fields quoted where they must be (RFC 4180); an empty field is "
      "a\n"
      "value that does not apply.\n"
      "Format ompl: benchmark.db, an SQLite database with the tables of OMPL's benchmarks: a "
      "model\n"
      "under a setting is an experiment, a contender a planner, a timing sample a run, a metric a\n"
      "column of runs, the outcome the enum status. Metrics of cells that are not valid are null.\n"
      "Rows about cells are of the last run's config.");
  command.callback([arguments, &exit_code] {
    run(*arguments);
    exit_code = 0;
  });
}

}  // namespace routebench
