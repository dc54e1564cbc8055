#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "python_program.hpp"
#include "routebench/harness/commands.hpp"

namespace routebench {
namespace {

constexpr const char* kPackage = "routebench_report";

struct PageOptions {
  std::string input;
  std::string out;
  std::string baseline;
  bool no_open = false;
};

std::vector<std::string> arguments_of(const char* command, const PageOptions& options) {
  std::vector<std::string> arguments{command};
  // One word each, so that a value may begin with a dash.
  if (!options.out.empty()) arguments.push_back("--out=" + options.out);
  if (!options.baseline.empty()) arguments.push_back("--baseline=" + options.baseline);
  if (options.no_open) arguments.emplace_back("--no-open");
  arguments.insert(arguments.end(), {"--", options.input});
  return arguments;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "report", "Write one HTML file with all of an experiment, and a viewer of its routes");
  const auto options = std::make_shared<PageOptions>();
  add_results_argument(*command, options->input);
  command->add_option("--out", options->out, "File to write [RESULTS/report.html]")
      ->type_name("FILE");
  command
      ->add_option("--baseline", options->baseline,
                   "Contender that the summary compares the others with [the one valid on most "
                   "models]")
      ->type_name("NAME");
  command->callback([options, &exit_code] {
    exit_code = run_python_package(kPackage, arguments_of("report", *options));
  });
}

void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "view", "Look at the moves of a G-code file, or of an experiment's routes, in a browser");
  const auto options = std::make_shared<PageOptions>();
  command
      ->add_option("INPUT", options->input,
                   "File of G-code, folder of a run, or the results.sqlite in it")
      ->type_name("")
      ->required();
  command
      ->add_option("--out", options->out,
                   "File to write [FILE.view.html beside the G-code, or RESULTS/view.html]")
      ->type_name("FILE");
  command->add_flag("--no-open", options->no_open, "Only write the file and print its name");
  command->callback([options, &exit_code] {
    exit_code = run_python_package(kPackage, arguments_of("view", *options));
  });
}

}  // namespace routebench
