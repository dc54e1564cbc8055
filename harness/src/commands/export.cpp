#include <CLI/CLI.hpp>

#include "routebench/harness/commands.hpp"

namespace routebench {

void add_export_command(CLI::App&, int&) {}

}  // namespace routebench
