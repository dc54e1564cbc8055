#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "python_program.hpp"
#include "routebench/harness/commands.hpp"

namespace routebench {
namespace {

struct PlotOptions {
  std::string results;
  std::string out;
  std::string formats = "png,svg";
  std::string metrics;
  std::string baseline;
};

std::vector<std::string> arguments_of(const PlotOptions& options) {
  std::vector<std::string> arguments;
  add_argument(arguments, "--out", options.out);
  add_argument(arguments, "--formats", options.formats);
  add_argument(arguments, "--metrics", options.metrics);
  add_argument(arguments, "--baseline", options.baseline);
  arguments.insert(arguments.end(), {"--", options.results});
  return arguments;
}

}  // namespace

void add_plot_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("plot", "Draw figures and tables of an experiment's results");
  const auto options = std::make_shared<PlotOptions>();
  add_results_argument(*command, options->results);
  command->add_option("--out", options->out, "Folder for the figures [RESULTS/plots]")
      ->type_name("DIR");
  command->add_option("--formats", options->formats, "png, svg and pdf, with commas between them")
      ->type_name("LIST")
      ->capture_default_str();
  command
      ->add_option("--metrics", options->metrics,
                   "Metrics that get bars and table columns, with commas between them, or all "
                   "[those of interest]")
      ->type_name("LIST");
  command
      ->add_option("--baseline", options->baseline,
                   "Contender that the summary compares the others with [the one valid on most "
                   "models]")
      ->type_name("NAME");
  command->callback([options, &exit_code] {
    exit_code = run_python_package("routebench_plots", arguments_of(*options));
  });
}

}  // namespace routebench
