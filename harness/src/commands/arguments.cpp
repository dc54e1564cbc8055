#include "arguments.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>
#include <system_error>
#include <utility>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"

namespace routebench {
namespace {

constexpr double kFurthestMm = 1e6;  // that G-code is moved

KeyValue setting_of(const std::string& option, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == text.npos || equals == 0)
    throw Error(ErrorKind::kBadUsage, option + ": '" + text + "' is no setting; write key=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// Appends "Keys of --task and their defaults: ..." to a command's footer, in lines that fit.
void add_keys_to_footer(CLI::App& command, const std::string& option,
                        const std::vector<KeyValue>& table) {
  constexpr std::size_t kWidth = 96;
  std::string text = "Keys of " + option + " with their defaults:";
  std::string line = " ";
  for (const KeyValue& entry : table) {
    const std::string word = " " + entry.key + "=" + entry.value;
    if (line.size() + word.size() > kWidth) text += "\n" + std::exchange(line, " ");
    line += word;
  }
  const std::string before = command.get_footer();
  command.footer(before + (before.empty() ? "" : "\n") + text + "\n" + line);
}

template <typename Number>
std::optional<Number> number_in(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// A text as the parameter's type has it, or the text itself: then the planner's binder says what
/// is wrong with it.
ParamValue value_of(const std::string& text, const std::vector<ParamSchema>& params,
                    const std::string& name) {
  const auto param = std::find_if(params.begin(), params.end(),
                                  [&](const ParamSchema& one) { return one.name == name; });
  if (param == params.end()) return text;
  switch (param->type) {
    case ParamType::kBool:
      if (text == "true" || text == "false") return text == "true";
      break;
    case ParamType::kInt:
      if (const auto whole = number_in<std::int64_t>(text)) return *whole;
      break;
    case ParamType::kReal:
      if (const auto real = number_in<double>(text)) return *real;
      break;
    case ParamType::kChoice:
      break;
  }
  return text;
}

}  // namespace

CLI::Option* add_repeated(CLI::App& command, const std::string& name,
                          std::vector<std::string>& values, const std::string& type,
                          const std::string& help) {
  return command.add_option(name, values, help)->type_name(type)->allow_extra_args(false);
}

void add_model_argument(CLI::App& command, std::string& model) {
  command
      .add_option("MODEL", model,
                  "A mesh (STL, OBJ, OFF, PLY, 3MF), shape:NAME?key=value, cgal:PATH, or a .wkt "
                  "file of layers")
      ->type_name("")
      ->required();
}

void add_task_option(CLI::App& command, std::vector<std::string>& settings) {
  add_repeated(command, "--task", settings, "KEY=VALUE", "What has to be deposited (keys below)");
  add_keys_to_footer(command, "--task", task_values(Task{}));
}

void add_printer_option(CLI::App& command, std::vector<std::string>& settings) {
  add_repeated(command, "--printer", settings, "KEY=VALUE", "How the printer moves (keys below)");
  add_keys_to_footer(command, "--printer", printer_values(Printer{}));
}

void add_plugin_option(CLI::App& command, std::vector<std::string>& files) {
  add_repeated(command, "--plugin", files, "FILE",
               "Load planners from a shared library (.so) or a Python file (.py)");
}

void add_jobs_option(CLI::App& command, int& jobs, const std::string& remark) {
  command.add_option("--jobs,-j", jobs, "Threads to work with; 0: one a core" + remark)
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""))
      ->capture_default_str();
}

void add_cell_jobs_option(CLI::App& command, std::optional<int>& jobs) {
  command.add_option("--jobs,-j", jobs, "Cells at a time; 0: one a core [as the config says]")
      ->check(CLI::Range(0, 1024).description(""))
      ->type_name("N");
}

void add_results_argument(CLI::App& command, std::string& results) {
  command.add_option("RESULTS", results, "A folder of results, or the database in it")
      ->type_name("")
      ->required();
}

std::string exit_codes(const std::string& zero, const std::string& one) {
  return "Exit codes: 0 " + zero + ", 1 " + one +
         ", 2 bad usage or input, 3 internal error, 130 interrupted.";
}

int tell_interrupted(const RunSummary& summary) {
  std::cerr << "routebench: interrupted; " << summary.executed + summary.found
            << " cells are done and kept, " << summary.left
            << " are left; the same command goes on\n";
  return kExitInterrupted;
}

void add_offset_options(CLI::App& command, GcodePlace& place) {
  command
      .add_option("--offset", place.offset,
                  "What to add to the G-code's places, in mm; else bounding boxes are aligned")
      ->type_name("X,Y");
  command
      .add_option("--z-offset", place.z_offset_mm,
                  "What to add to its heights, in mm: -0.9 for what stands on a raft of 0.9 mm")
      ->type_name("Z");
}

void refuse_offsets_without(const std::string& needed, const GcodePlace& place) {
  for (const auto& [option, given] : {std::pair{"--offset", !place.offset.empty()},
                                      std::pair{"--z-offset", place.z_offset_mm.has_value()}})
    if (given)
      throw Error(ErrorKind::kBadUsage, std::string(option) + " means nothing without " + needed);
}

void add_repair_flag(CLI::App& command, bool& repair) {
  command.add_flag("--repair", repair,
                   "Mend what would be refused, and mark the layers where that was needed");
}

void add_progress_option(CLI::App& command, std::string& form) {
  form = "auto";
  command
      .add_option(
          "--progress", form,
          "auto, bar (one line with the time to go), lines (one a cell), json (one object a "
          "line) or none; auto is bar on a terminal, else json")
      ->check(CLI::IsMember({"auto", "bar", "lines", "json", "none"}))
      ->type_name("FORM")
      ->capture_default_str();
}

RunLog log_of(const std::string& form) {
  const auto which = [&] {
    if (form == "none") return ProgressForm::kNone;
    if (form == "lines") return ProgressForm::kLines;
    if (form == "bar" || (form == "auto" && isatty(STDERR_FILENO) == 1)) return ProgressForm::kBar;
    return ProgressForm::kJson;
  };
  return {&std::cerr, which()};
}

Task task_of(const std::vector<std::string>& settings) {
  Task task;
  for (const std::string& text : settings) {
    const KeyValue setting = setting_of("--task", text);
    set_task_value(task, setting.key, setting.value);
  }
  check_task(task);
  return task;
}

Printer printer_of(const std::vector<std::string>& settings) {
  Printer printer;
  for (const std::string& text : settings) {
    const KeyValue setting = setting_of("--printer", text);
    set_printer_value(printer, setting.key, setting.value);
  }
  return printer;
}

void apply_slot_settings(ContenderSpec& spec, const std::vector<std::string>& settings,
                         const Registry& registry) {
  for (const std::string& text : settings) {
    const KeyValue setting = setting_of("--set", text);
    const std::size_t dot = setting.key.find('.');
    const std::string slot_name = setting.key.substr(0, dot);
    if (dot == setting.key.npos || (slot_name != "shell" && slot_name != "fill"))
      throw Error(
          ErrorKind::kBadUsage,
          "--set: '" + text + "' names no slot; write shell.key=value or " + "fill.key=value");
    std::optional<SlotSpec>& slot = slot_name == "shell" ? spec.shell : spec.fill;
    if (!slot)
      throw Error(ErrorKind::kBadUsage,
                  "--set: '" + text + "' sets a slot that is empty; give --" + slot_name + " too");
    const std::string name = setting.key.substr(dot + 1);
    slot->params[name] = value_of(setting.value, registry.at(slot->planner).params, name);
  }
}

void write_json(OutputSet& outputs, const std::filesystem::path& file, const Json& document) {
  const auto write = [&](std::ostream& out) { out << text_of(document) << '\n'; };
  if (file == "-") {
    write_to_stdout(write);
  } else {
    outputs.add(file, write);
  }
}

std::filesystem::path layer_picture(const std::filesystem::path& folder, int layer_index) {
  std::string number = std::to_string(layer_index);
  constexpr std::size_t kDigits = 4;
  if (number.size() < kDigits) number.insert(0, kDigits - number.size(), '0');
  return folder / ("layer_" + number + ".svg");
}

void print_warnings(const std::string& model, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    std::cerr << "routebench: warning: " << one_line(model + ": " + warning) << '\n';
}

void print_refused(const PlannerSet& planners) {
  for (const PluginRecord& plugin : planners.plugins)
    if (!plugin.loaded)
      std::cerr << "routebench: warning: plugin " << plugin.file
                << ": refused: " << plugin.refused_because << '\n';
}

void print_rows(std::ostream& out, const std::vector<Row>& rows) {
  std::size_t label_width = 0, value_width = 0;
  for (const Row& row : rows) {
    label_width = std::max(label_width, row.label.size());
    value_width = std::max(value_width, row.value.size());
  }
  for (const Row& row : rows) {
    std::string line = row.label + std::string(label_width - row.label.size() + 2, ' ') +
                       std::string(value_width - row.value.size(), ' ') + row.value;
    if (!row.unit.empty()) line += " " + row.unit;
    out << line << '\n';
  }
}

std::vector<Row> rows_of(const Scores& scores) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < scores.size(); ++i)
    if (scores[i])
      rows.push_back({std::string(metric_table()[i].label), readable(*scores[i]),
                      std::string(metric_table()[i].unit)});
  return rows;
}

std::string readable(double value) {
  const double size = std::abs(value);
  const bool whole = value == std::trunc(value) && size < 1e15;
  const char* format = whole ? "%.0f" : size >= 1000 ? "%.1f" : size >= 0.01 ? "%.4g" : "%.3g";
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

double z_offset_of(const GcodePlace& place) {
  const double z_mm = place.z_offset_mm.value_or(0);
  if (!(std::abs(z_mm) <= kFurthestMm))
    throw Error(ErrorKind::kBadUsage,
                "--z-offset: " + readable(z_mm) + " is no height; write mm, such as -0.9");
  return z_mm;
}

std::optional<Point2> offset_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::array<double, 2> numbers{};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [stop, failure] = std::from_chars(at, end, numbers[i]);
    const bool last = i + 1 == numbers.size();
    if (failure != std::errc{} || !(std::abs(numbers[i]) <= kFurthestMm) ||
        (last ? stop != end : stop == end || *stop != ','))
      throw Error(ErrorKind::kBadUsage,
                  "--offset: '" + text + "' is no place; write x,y in mm, such as 10,-2.5");
    at = stop + 1;
  }
  return snap(Point2{numbers[0], numbers[1]});
}

}  // namespace routebench
