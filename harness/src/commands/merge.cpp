#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "routebench/harness/commands.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/provenance.hpp"
#include "routebench/harness/results.hpp"
#include "routebench/harness/runner.hpp"

namespace routebench {
namespace {

struct Arguments {
  std::string out;
  std::vector<std::string> parts;
  bool fresh = false;
};

void merge(const Arguments& arguments) {
  const MergeSummary summary =
      merge_results(arguments.out, {arguments.parts.begin(), arguments.parts.end()},
                    arguments.fresh, command_line());
  for (const std::string& remark : summary.remarks)
    std::cerr << "routebench: warning: " << remark << '\n';
  const std::vector<StoredCell> cells = current_cells(summary.file);
  write_to_stdout([&](std::ostream& out) {
    write_ranking(out, cells);
    out << "\nresults: " << summary.file.string() << '\n';
  });
}

}  // namespace

void add_merge_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *app.add_subcommand("merge", "Join databases of one experiment, such as its shards");
  command.add_option("OUT", arguments->out, "Folder of the new database")
      ->type_name("")
      ->required();
  command.add_option("IN", arguments->parts, "Folders of results, or the databases in them")
      ->type_name("")
      ->required();
  command.add_flag("--fresh", arguments->fresh, "Replace a database that OUT holds");
  command.footer(
      "Everything that the parts hold is in the new database: runs, cells, scores, routes, timing\n"
      "samples. A cell that several parts hold is stored once, with the samples of all of them. "
      "If\n"
      "its outcome, route or scores differ between parts, nothing is merged, and it is named.\n"
      "Exit codes: 0 merged, 2 bad usage or input, 3 internal error.");
  command.callback([arguments, &exit_code] {
    merge(*arguments);
    exit_code = 0;
  });
}

}  // namespace routebench
