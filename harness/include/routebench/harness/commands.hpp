#pragma once
/// The subcommands of the program. Each adds itself to the command line; its callback does the
/// work, writes data to stdout and sets the exit code (0 done, 1 done but some cells are not
/// valid). Bad usage or input is thrown as Error and becomes exit code 2.

#include <span>
#include <string_view>

namespace CLI {
class App;
}

namespace routebench {

/// A subcommand by its name.
struct Command {
  std::string_view name;
  void (*add)(CLI::App& app, int& exit_code);
  bool keeps_memory = false;  ///< what it frees: for those that do one job and end
};

void add_plan_command(CLI::App& app, int& exit_code);
void add_score_command(CLI::App& app, int& exit_code);
void add_slice_command(CLI::App& app, int& exit_code);
void add_planners_command(CLI::App& app, int& exit_code);
void add_check_planner_command(CLI::App& app, int& exit_code);
void add_new_planner_command(CLI::App& app, int& exit_code);

// On experiments and results, in a library that is loaded when one of them is called.
void add_run_command(CLI::App& app, int& exit_code);
void add_plot_command(CLI::App& app, int& exit_code);
void add_gate_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_merge_command(CLI::App& app, int& exit_code);
void add_reproduce_command(CLI::App& app, int& exit_code);
void add_doctor_command(CLI::App& app, int& exit_code);

}  // namespace routebench

/// What that library defines: those of its commands.
extern "C" std::span<const routebench::Command> routebench_experiment_commands();
