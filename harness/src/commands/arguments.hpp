#pragma once
/// Options that several subcommands have, and what their texts mean.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "json_parts.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/metrics.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/run_log.hpp"
#include "routebench/harness/runner.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// Exit codes of what was done; what is thrown becomes another (see main.cpp).
inline constexpr int kExitNotValid = 1;  ///< something is not valid, or not as it was
inline constexpr int kExitInterrupted = 130;

/// All exit codes of a command that executes cells, for its help.
[[nodiscard]] std::string exit_codes(const std::string& zero, const std::string& one);

/// Says what an interrupted run leaves. Returns the exit code.
[[nodiscard]] int tell_interrupted(const RunSummary& summary);

/// Adds an option that may be given several times, one value each.
CLI::Option* add_repeated(CLI::App& command, const std::string& name,
                          std::vector<std::string>& values, const std::string& type,
                          const std::string& help);

/// The model that a command works on.
void add_model_argument(CLI::App& command, std::string& model);

/// The options by which tasks and printers are set. Their keys stand at the end of the help.
void add_task_option(CLI::App& command, std::vector<std::string>& settings);
void add_printer_option(CLI::App& command, std::vector<std::string>& settings);
void add_plugin_option(CLI::App& command, std::vector<std::string>& files);
void add_jobs_option(CLI::App& command, int& jobs, const std::string& remark = {});
/// How many cells are executed at a time.
void add_cell_jobs_option(CLI::App& command, std::optional<int>& jobs);
/// The folder or database that a command reads.
void add_results_argument(CLI::App& command, std::string& results);
void add_repair_flag(CLI::App& command, bool& repair);
/// How a file of G-code is moved onto the model.
struct GcodePlace {
  std::string offset;  ///< see offset_of
  std::optional<double> z_offset_mm;
};
void add_offset_options(CLI::App& command, GcodePlace& place);
/// Throws Error{kBadUsage} for such an option that was given without `needed`.
void refuse_offsets_without(const std::string& needed, const GcodePlace& place);

/// "12.5,-3" as a point on the grid; nothing of an empty text. Throws Error{kBadUsage} for another.
[[nodiscard]] std::optional<Point2> offset_of(const std::string& text);

/// 0 if none is given. Throws Error{kBadUsage} for what is no height.
[[nodiscard]] double z_offset_of(const GcodePlace& place);

/// How an experiment tells on the standard error how far it is.
void add_progress_option(CLI::App& command, std::string& form);
/// Takes what add_progress_option accepted: "auto" is a bar on a terminal and JSON elsewhere.
[[nodiscard]] RunLog log_of(const std::string& form);

/// The defaults with `key=value` settings applied in order.
/// Throws Error for what set_task_value and check_task refuse, and for a text without '='.
[[nodiscard]] Task task_of(const std::vector<std::string>& settings);
[[nodiscard]] Printer printer_of(const std::vector<std::string>& settings);

/// Puts `slot.key=value` settings into a contender's slots. A value is read as the planner declares
/// the parameter. Throws Error{kBadUsage} for what is no such setting or whose slot is empty;
/// Error{kBadInput} for unknown planners.
void apply_slot_settings(ContenderSpec& spec, const std::vector<std::string>& settings,
                         const Registry& registry);

/// Adds a JSON document to the outputs, or writes it to the standard output if the file is "-".
void write_json(OutputSet& outputs, const std::filesystem::path& file, const Json& document);

/// The file for one layer's picture in a folder: layer_0012.svg.
[[nodiscard]] std::filesystem::path layer_picture(const std::filesystem::path& folder,
                                                  int layer_index);

/// Prints warnings of a model to the standard error, one line each.
void print_warnings(const std::string& model, const std::vector<std::string>& warnings);

/// Prints a warning for every plugin that was refused.
void print_refused(const PlannerSet& planners);

/// Label, value and unit of one line of a table for people.
struct Row {
  std::string label;
  std::string value;
  std::string unit;
};
/// Rows with aligned columns: labels to the left, values to the right.
void print_rows(std::ostream& out, const std::vector<Row>& rows);

/// One row for each metric that there is.
[[nodiscard]] std::vector<Row> rows_of(const Scores& scores);

/// A number for people: whole ones in full, others with a sensible number of digits.
[[nodiscard]] std::string readable(double value);

}  // namespace routebench
