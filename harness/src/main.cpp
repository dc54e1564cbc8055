/// The program `routebench`.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <iterator>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kept_memory.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/lazy_library.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/version.hpp"
#include "routebench/planning/params.hpp"

namespace {

constexpr int kExitBadInput = 2;
constexpr int kExitInternal = 3;
constexpr const char* kNoOutput = "standard output: cannot be written";

int complain(const std::string& message, int exit_code) {
  std::cerr << "routebench: " << routebench::one_line(message) << '\n';
  return exit_code;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::optional<std::string> near = routebench::nearest_name(word, known);
  return near ? "; did you mean '" + *near + "'?" : "";
}

/// The command of a call, or the program itself.
const CLI::App& called(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

/// What to say about a KEY=VALUE that follows another one: options that take such take one each.
std::string write_the_option_again(const std::string& word, const CLI::App& command) {
  if (word.starts_with('-') || word.find('=') == std::string::npos) return "";
  std::string hint;
  for (const CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    if (option->count() > 0 && type.find('=') != std::string::npos)
      hint += (hint.empty() ? "; write " : " or ") + option->get_name() + " before every " + type;
  }
  return hint;
}

std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = called(app);
  const std::vector<std::string> extras = command.remaining();
  std::string message = error.what();
  if (!extras.empty()) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    const std::string& word = extras.front();
    message = "'" + word + "' was not expected" + did_you_mean(word, known) +
              write_the_option_again(word, command);
  }
  return message + " (see routebench " + (&command == &app ? "" : command.get_name() + " ") +
         "--help)";
}

constexpr routebench::Command kCommands[] = {
    {"plan", routebench::add_plan_command, true},
    {"score", routebench::add_score_command},
    {"slice", routebench::add_slice_command, true},
    {"planners", routebench::add_planners_command},
    {"check-planner", routebench::add_check_planner_command},
    {"new-planner", routebench::add_new_planner_command}};

std::span<const routebench::Command> experiment_commands() {
  using Commands = decltype(routebench_experiment_commands);
  return reinterpret_cast<Commands*>(routebench::function_in_library(
      ROUTEBENCH_EXPERIMENTS_LIBRARY, "routebench_experiment_commands",
      "the library of commands on experiments"))();
}

/// Adds the command of that name; all of them if there is none. To make the options of all takes
/// half a millisecond or more, and those on experiments have to be loaded first.
void add_commands(CLI::App& app, int& exit_code, std::string_view name) {
  const auto is_called = [&](const routebench::Command& command) { return command.name == name; };
  const auto* const own = std::ranges::find_if(kCommands, is_called);
  if (own != std::end(kCommands)) {
    if (own->keeps_memory)
      routebench::keep_freed_memory();  // its options are the first to want some
    return own->add(app, exit_code);
  }
  const std::span<const routebench::Command> loaded = experiment_commands();
  const auto one = std::ranges::find_if(loaded, is_called);
  if (one != loaded.end()) return one->add(app, exit_code);
  for (const auto& commands : {std::span<const routebench::Command>(kCommands), loaded})
    for (const routebench::Command& command : commands) command.add(app, exit_code);
}

/// Throws Error for a first word that is neither a command nor an option.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  const std::string word = argv[1];
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  throw routebench::Error(routebench::ErrorKind::kBadUsage, "there is no command '" + word + "'" +
                                                                did_you_mean(word, known) +
                                                                " (see routebench --help)");
}

/// Tells of whatever calls exit() while a command is at work, such as a planner: nothing is done
/// then, and an exit code of 0 would say that all is.
class ExitWatch {
 public:
  ExitWatch() {
    program_ = getpid();
    std::atexit(complain_and_exit);
    std::at_quick_exit(complain_and_exit);
  }
  ~ExitWatch() { program_ = 0; }
  ExitWatch(const ExitWatch&) = delete;
  ExitWatch& operator=(const ExitWatch&) = delete;

 private:
  static void complain_and_exit() {
    if (getpid() != program_) return;  // all is over, or it is a cell's own process
    _exit(complain("a planner has ended the program before its work was done", kExitInternal));
  }
  static inline pid_t program_ = 0;
};

/// All but what main itself sees to.
int run(int argc, char** argv) {
  CLI::App app{"Plan routes for 3D printing and judge them", "routebench"};
  app.set_version_flag("--version", std::string(routebench::kVersion));
  app.require_subcommand(1);
  app.get_formatter()->column_width(32);
  const std::string exit_codes =
      "Exit codes: 0 done, 1 done but not everything is valid, 2 bad usage or input, 3 internal "
      "error.";
  app.footer(exit_codes);  // commands inherit it
  int exit_code = 0;
  try {
    add_commands(app, exit_code, argc > 1 ? argv[1] : "");
    app.footer(exit_codes + "\nEach command has its own help: routebench plan --help.");
    check_command(app, argc, argv);
    app.parse(argc, argv);
    if (!std::cout.flush()) return complain(kNoOutput, kExitBadInput);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error);
      return std::cout.flush() ? 0 : complain(kNoOutput, kExitBadInput);
    }
    return complain(explain(app, error), kExitBadInput);
  } catch (const routebench::Error& error) {
    return complain(error.what(), error.kind() == routebench::ErrorKind::kInternal ? kExitInternal
                                                                                   : kExitBadInput);
  } catch (const std::bad_alloc&) {
    return complain("out of memory", kExitInternal);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what(), kExitInternal);
  } catch (...) {
    return complain("internal error: something was thrown that is no std::exception",
                    kExitInternal);
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  // A file that may not grow any further is an error like a full disk, not the end of the program.
  // (A handler, not SIG_IGN: what is started from here does not inherit it.)
  std::signal(SIGXFSZ, [](int) {});
  const ExitWatch watch;
  return run(argc, argv);
}
