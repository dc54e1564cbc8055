#include <CLI/CLI.hpp>

#include "routebench/harness/commands.hpp"

namespace routebench {

void add_plan_command(CLI::App&, int&) {}

}  // namespace routebench
