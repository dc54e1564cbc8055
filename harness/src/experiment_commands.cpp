/// The library of commands on experiments and results.

#include "routebench/harness/commands.hpp"

std::span<const routebench::Command> routebench_experiment_commands() {
  using namespace routebench;
  static constexpr Command kCommands[] = {
      {"run", add_run_command},      {"plot", add_plot_command},
      {"gate", add_gate_command},    {"report", add_report_command},
      {"view", add_view_command},    {"export", add_export_command},
      {"merge", add_merge_command},  {"reproduce", add_reproduce_command},
      {"doctor", add_doctor_command}};
  return kCommands;
}
