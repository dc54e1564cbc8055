#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "json_documents.hpp"
#include "layer_selection.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/gcode_score.hpp"
#include "routebench/harness/parallel.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench {
namespace {

struct ScoreArguments {
  std::string file;
  std::string model;
  GcodePlace place;
  std::vector<std::string> task;
  std::vector<std::string> printer;
  std::string layers;
  std::string json;
  int jobs = 0;
  bool repair = false;
};

/// One call of `routebench score`, from its arguments to its outputs.
class ScoreFile {
 public:
  explicit ScoreFile(const ScoreArguments& arguments)
      : arguments_(arguments),
        judge_(task_of(arguments.task), printer_of(arguments.printer)),
        parallel_for_(parallel_loop(arguments.jobs)) {
    if (!arguments.model.empty()) return;
    refuse_offsets_without("--model MODEL", arguments.place);
    for (const auto& [option, given] : {std::pair{"--layers", !arguments.layers.empty()},
                                        std::pair{"--repair", arguments.repair}})
      if (given)
        throw Error(ErrorKind::kBadUsage,
                    std::string(option) + " means nothing without --model MODEL");
  }

  /// Returns the exit code.
  int run() {
    const std::optional<Point2> offset = offset_of(arguments_.place.offset);
    print_ = read_gcode_file(arguments_.file, {.layer_height_mm = judge_.task().layer_height_mm,
                                               .filament_mm = judge_.printer().filament_mm,
                                               .z_offset_mm = z_offset_of(arguments_.place)});
    if (arguments_.model.empty()) {
      score_ = score_gcode(judge_, print_, parallel_for_);
    } else {
      model_ = prepare_model(arguments_.model, judge_.task(), {.repair = arguments_.repair},
                             parallel_for_);
      print_warnings(arguments_.model, model_->sliced.warnings);
      chosen_ = select_layers(arguments_.layers, model_->sliced.layers);
      score_ = score_gcode(judge_, *model_, chosen_, print_, offset, parallel_for_);
      if (const auto warning = misplaced_in_z(model_->sliced.layers, print_.layers))
        print_.warnings.push_back(*warning);
    }
    warn();
    print_warnings(arguments_.file, print_.warnings);
    OutputSet outputs;
    if (!arguments_.json.empty() && arguments_.json != "-")
      write_json(outputs, arguments_.json, document());
    outputs.commit();
    if (arguments_.json == "-") {
      write_json(outputs, "-", document());
    } else {
      print_table(std::cout);
    }
    return !model_ || score_.cell.verdict.outcome == Outcome::kValid ? 0 : kExitNotValid;
  }

 private:
  /// Says what makes the scores less than they seem.
  void warn() {
    const double height_mm = judge_.task().layer_height_mm;
    constexpr double kSameMm = 1e-3;
    std::size_t others = 0;
    double other_mm = 0;
    for (const GcodeLayer& layer : print_.layers) {
      if (std::abs(layer.height_mm - height_mm) <= kSameMm) continue;
      if (others++ == 0) other_mm = layer.height_mm;
    }
    if (others > 0)
      print_.warnings.push_back(
          std::to_string(others) + " of " + std::to_string(print_.layers.size()) +
          " layers are not as high as the task's layer_height_mm = " + readable(height_mm) +
          "; the first of them has " + readable(other_mm) + " mm");
    // Widths by marks are believed; E may tell another story.
    constexpr double kApart = 0.02;
    const std::optional<double> laid = score_.cell.totals[metric_index("filament_mm3")];
    const bool whole = !model_ || (score_.pairs.unpaired.empty() && arguments_.layers.empty());
    if (laid && whole && std::abs(*laid - print_.filament_mm3) > kApart * print_.filament_mm3)
      print_.warnings.push_back("its E makes " + readable(print_.filament_mm3) +
                                " mm3 of material, its widths at the task's layer height make " +
                                readable(*laid));
  }

  [[nodiscard]] Json document() const {
    return score_document(
        {arguments_.file, print_, model_ ? &model_->sliced : nullptr, chosen_, judge_, score_});
  }

  void print_table(std::ostream& out) const {
    out << "file       " << arguments_.file << ", " << print_.layers.size() << " layers\n";
    if (model_) {
      out << "model      " << arguments_.model << ", " << chosen_.size() << " of "
          << model_->sliced.layers.size() << " layers, " << score_.pairs.count(chosen_)
          << " of them in the file\noffset     " << readable(score_.offset_mm.x) << ", "
          << readable(score_.offset_mm.y) << " mm\noutcome    "
          << to_string(score_.cell.verdict.outcome);
      if (!score_.cell.verdict.reason.empty()) out << ": " << score_.cell.verdict.reason;
      out << '\n';
    }
    std::vector<Row> rows = rows_of(score_.cell.totals);
    rows.push_back({"Retractions of the file", std::to_string(print_.retractions), ""});
    rows.push_back({"Travel of the file", readable(print_.travel_mm), "mm"});
    rows.push_back({"Material by E", readable(print_.filament_mm3), "mm3"});
    rows.push_back({"Strokes left out", std::to_string(print_.excluded_strokes), ""});
    out << '\n';
    print_rows(out, rows);
  }

  const ScoreArguments& arguments_;
  Judge judge_;
  ParallelFor parallel_for_;
  GcodePrint print_;
  std::optional<PreparedModel> model_;
  std::vector<std::size_t> chosen_;
  GcodeScore score_;
};

}  // namespace

void add_score_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ScoreArguments>();
  CLI::App& command =
      *app.add_subcommand("score", "Judge a file of G-code, of any slicer, by the metrics of plan");
  command.add_option("FILE", arguments->file, "G-code of Marlin, Klipper, RepRap or UltiGCode")
      ->type_name("")
      ->required();
  command
      .add_option("--model", arguments->model,
                  "What the file should print, as for plan; without it only what needs no model is "
                  "measured")
      ->type_name("MODEL");
  add_offset_options(command, arguments->place);
  add_task_option(command, arguments->task);
  add_printer_option(command, arguments->printer);
  command
      .add_option("--layers", arguments->layers,
                  "Judge only these of the model, by index from 0, such as 3,10..20")
      ->type_name("LIST");
  command
      .add_option("--json", arguments->json,
                  "Write every score of every layer; - is the standard output, alone")
      ->type_name("FILE|-");
  add_jobs_option(command, arguments->jobs);
  add_repair_flag(command, arguments->repair);
  command.callback([arguments, &exit_code] { exit_code = ScoreFile(*arguments).run(); });
}

}  // namespace routebench
