/// The program `routebench`.

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <string>

#include "routebench/geometry/error.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/version.hpp"

namespace {

constexpr int kExitBadInput = 2;
constexpr int kExitInternal = 3;

/// Messages are one line, whatever they quote.
std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"routebench: plans routes for 3D printing and judges them"};
  app.set_version_flag("--version", std::string(routebench::kVersion));
  app.require_subcommand(1);
  int exit_code = 0;
  routebench::add_run_command(app, exit_code);
  routebench::add_plan_command(app, exit_code);
  routebench::add_slice_command(app, exit_code);
  routebench::add_planners_command(app, exit_code);
  routebench::add_plot_command(app, exit_code);
  routebench::add_export_command(app, exit_code);
  routebench::add_doctor_command(app, exit_code);
  try {
    app.parse(argc, argv);
    std::cout.flush();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << "routebench: " << one_line(error.what()) << " (see routebench --help)\n";
    return kExitBadInput;
  } catch (const routebench::Error& error) {
    std::cerr << "routebench: " << one_line(error.what()) << '\n';
    return error.kind() == routebench::ErrorKind::kInternal ? kExitInternal : kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "routebench: internal error: " << one_line(error.what()) << '\n';
    return kExitInternal;
  }
  return exit_code;
}
