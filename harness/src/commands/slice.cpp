#include <CLI/CLI.hpp>

#include "routebench/harness/commands.hpp"

namespace routebench {

void add_slice_command(CLI::App&, int&) {}

}  // namespace routebench
