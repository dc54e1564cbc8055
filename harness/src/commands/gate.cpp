#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "python_program.hpp"
#include "routebench/harness/commands.hpp"

namespace routebench {
namespace {

struct GateOptions {
  std::string before;
  std::string after;
  std::string metrics;
  std::string tolerance = "0.5%";
  std::string travel;
  std::vector<std::string> limits;
  std::string time = "50%";
  std::string times = "auto";
  bool require_all = false;
};

std::vector<std::string> arguments_of(const GateOptions& options) {
  std::vector<std::string> arguments;
  add_argument(arguments, "--metrics", options.metrics);
  add_argument(arguments, "--tolerance", options.tolerance);
  add_argument(arguments, "--travel", options.travel);
  for (const std::string& limit : options.limits) add_argument(arguments, "--limit", limit);
  add_argument(arguments, "--time", options.time);
  add_argument(arguments, "--times", options.times);
  if (options.require_all) arguments.emplace_back("--require-all");
  arguments.insert(arguments.end(), {"--", options.before, options.after});
  return arguments;
}

}  // namespace

void add_gate_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "gate", "Compare new results with old ones; exit code 1 if they are worse");
  const auto options = std::make_shared<GateOptions>();
  command->add_option("OLD", options->before, "Results to compare with: a folder or its database")
      ->type_name("")
      ->required();
  command->add_option("NEW", options->after, "Results of the same experiment")
      ->type_name("")
      ->required();
  command
      ->add_option("--metrics", options->metrics,
                   "Metrics to compare, with commas between them, or all [those of interest]")
      ->type_name("LIST");
  command
      ->add_option("--tolerance", options->tolerance,
                   "By how much a cell's quality may become worse, as a share such as 1% or 0.01")
      ->type_name("SHARE")
      ->capture_default_str();
  command->add_option("--travel", options->travel, "The same for travel alone")->type_name("SHARE");
  command->add_option("--limit", options->limits, "The same for any metric")
      ->type_name("METRIC=SHARE")
      ->expected(1)
      ->take_all();
  command
      ->add_option("--time", options->time,
                   "By how much times and memory may grow in the median over the models")
      ->type_name("SHARE")
      ->capture_default_str();
  command
      ->add_option("--times", options->times,
                   "Whether to compare times: auto (if the processors are alike), always or never")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->type_name("WHEN")
      ->capture_default_str();
  command->add_flag("--require-all", options->require_all,
                    "A cell of the old results that the new ones lack is a regression");
  command->callback([options, &exit_code] {
    exit_code = run_python_package("routebench_gate", arguments_of(*options));
  });
}

}  // namespace routebench
