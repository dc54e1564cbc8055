#include <CLI/CLI.hpp>

#include "routebench/harness/commands.hpp"

namespace routebench {

void add_run_command(CLI::App&, int&) {}

}  // namespace routebench
