#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "installed_files.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/commands.hpp"

namespace routebench {
namespace {

/// The distribution's Python: one that stands earlier in the search path may lack matplotlib.
constexpr const char* kPython = "/usr/bin/python3";

struct PlotOptions {
  std::string results;
  std::string out;
  std::string formats = "png,svg";
  std::string metrics;
  std::string baseline;
};

std::vector<std::string> python_arguments(const PlotOptions& options) {
  // Isolated from the user's own packages, leaving no compiled files behind.
  std::vector<std::string> arguments{
      kPython, "-I", "-B",
      data_folder("routebench_plots", ROUTEBENCH_PLOTS_SOURCE, "__main__.py") / "__main__.py"};
  const auto add = [&](const char* name, const std::string& value) {
    // One word each, so that a value may begin with a dash.
    if (!value.empty()) arguments.push_back(std::string(name) + "=" + value);
  };
  add("--out", options.out);
  add("--formats", options.formats);
  add("--metrics", options.metrics);
  add("--baseline", options.baseline);
  arguments.insert(arguments.end(), {"--", options.results});
  return arguments;
}

/// While it lives, Ctrl-C stops the child alone, which then cleans up behind itself.
class IgnoreInterrupt {
 public:
  IgnoreInterrupt() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGINT, &ignore, &previous_);
  }
  ~IgnoreInterrupt() { sigaction(SIGINT, &previous_, nullptr); }
  IgnoreInterrupt(const IgnoreInterrupt&) = delete;
  IgnoreInterrupt& operator=(const IgnoreInterrupt&) = delete;

  /// Whether the child is to be interrupted, too.
  [[nodiscard]] bool was_ignored() const { return previous_.sa_handler == SIG_IGN; }

 private:
  struct sigaction previous_ {};
};

/// Runs a program without a shell and waits for it. Returns its exit code.
/// Throws  Error{kBadInput} if it cannot be started, Error{kInternal} if a signal ended it.
int run_program(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  const IgnoreInterrupt guard;
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  const std::unique_ptr<posix_spawnattr_t, int (*)(posix_spawnattr_t*)> cleanup(
      &attributes, posix_spawnattr_destroy);
  if (!guard.was_ignored()) {
    sigset_t restored;
    sigemptyset(&restored);
    sigaddset(&restored, SIGINT);
    posix_spawnattr_setsigdefault(&attributes, &restored);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  }

  pid_t child = 0;
  const int failure = posix_spawn(&child, argv[0], nullptr, &attributes, argv.data(), environ);
  if (failure != 0)
    throw Error(ErrorKind::kBadInput, "plots need " + arguments[0] + " with matplotlib: " +
                                          std::generic_category().message(failure) +
                                          "; install the package python3-matplotlib");
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw Error(ErrorKind::kInternal,
                  "waiting for " + arguments[0] + ": " + std::generic_category().message(errno));
  if (WIFSIGNALED(status))
    throw Error(ErrorKind::kInternal,
                "drawing plots was ended by signal " + std::to_string(WTERMSIG(status)));
  return WEXITSTATUS(status);
}

}  // namespace

void add_plot_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("plot", "draw figures and tables of an experiment's results");
  const auto options = std::make_shared<PlotOptions>();
  command->add_option("results", options->results, "folder of a run, or the results.sqlite in it")
      ->required();
  command->add_option("--out", options->out, "folder for the figures [RESULTS/plots]");
  command->add_option("--formats", options->formats, "png, svg and pdf, with commas between them")
      ->capture_default_str();
  command->add_option("--metrics", options->metrics,
                      "metrics that get bars and table columns, with commas between them, or all "
                      "[those of interest]");
  command->add_option("--baseline", options->baseline,
                      "contender that the summary compares the others with [the one valid on most "
                      "models]");
  command->callback([options, &exit_code] { exit_code = run_program(python_arguments(*options)); });
}

}  // namespace routebench
