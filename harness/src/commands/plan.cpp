#include <CLI/CLI.hpp>
#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arguments.hpp"
#include "json_documents.hpp"
#include "kept_memory.hpp"
#include "layer_selection.hpp"
#include "plan_timing.hpp"
#include "planner_process.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/gcode_score.hpp"
#include "routebench/harness/gcode_writer.hpp"
#include "routebench/harness/parallel.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/route_svg.hpp"

namespace routebench {
namespace {

struct PlanArguments {
  std::string model;
  std::string shell;
  std::string fill;
  std::string from_gcode;
  GcodePlace place;
  std::string order = "island";
  std::vector<std::string> set;
  std::vector<std::string> task;
  std::vector<std::string> printer;
  std::vector<std::string> plugins;
  std::string layers;
  std::string gcode;
  std::string svg;
  std::string json;
  std::uint64_t seed = 1;
  int jobs = 0;
  bool repair = false;
  bool no_judge = false;
  bool phases = false;
};

ContenderSpec contender_of(const PlanArguments& arguments, const Registry& registry) {
  if (arguments.shell.empty() && arguments.fill.empty())
    throw Error(ErrorKind::kBadUsage,
                "no planner: give --shell NAME, --fill NAME or both (see routebench planners), or "
                "--from-gcode FILE");
  ContenderSpec spec;
  spec.order = layer_order(arguments.order);
  spec.name = arguments.shell;
  if (!arguments.fill.empty()) spec.name += (spec.name.empty() ? "" : " + ") + arguments.fill;
  if (!arguments.shell.empty()) spec.shell = SlotSpec{arguments.shell, {}};
  if (!arguments.fill.empty()) spec.fill = SlotSpec{arguments.fill, {}};
  apply_slot_settings(spec, arguments.set, registry);
  return spec;
}

/// Whence the strokes come: planners make them, or a file has them.
using StrokeSource = std::variant<Contender, GcodePrint>;

StrokeSource source_of(const PlanArguments& arguments, const Registry& registry,
                       const Judge& judge) {
  if (arguments.from_gcode.empty()) {
    refuse_offsets_without("--from-gcode FILE", arguments.place);
    return Contender(contender_of(arguments, registry), registry);
  }
  for (const auto& [option, given] :
       {std::pair{"--shell", !arguments.shell.empty()},
        std::pair{"--fill", !arguments.fill.empty()}, std::pair{"--set", !arguments.set.empty()}})
    if (given)
      throw Error(ErrorKind::kBadUsage, std::string(option) +
                                            ": the strokes come --from-gcode, so there is no "
                                            "planner; give either");
  return read_gcode_file(arguments.from_gcode, {.layer_height_mm = judge.task().layer_height_mm,
                                                .filament_mm = judge.printer().filament_mm,
                                                .z_offset_mm = z_offset_of(arguments.place)});
}

/// One call of `routebench plan`, from its arguments to its outputs.
class Plan {
 public:
  explicit Plan(const PlanArguments& arguments)
      : arguments_(arguments),
        judge_(task_of(arguments.task), printer_of(arguments.printer)),
        planners_(load_planners(arguments.plugins)),
        parallel_for_(parallel_loop(arguments.jobs)),
        offset_(offset_of(arguments.place.offset)) {
    require_all_loaded(planners_);
    print_refused(planners_);
    add_commands(planners_, std::vector{arguments.shell, arguments.fill});
    source_.emplace(source_of(arguments, planners_.registry, judge_));
  }

  /// Returns the exit code.
  int run() {
    const std::int64_t begin_ns = process_cpu_ns();
    model_ = prepare_model(arguments_.model, judge_.task(), {.repair = arguments_.repair},
                           parallel_for_);
    print_warnings(arguments_.model, model_.sliced.warnings);
    chosen_ = select_layers(arguments_.layers, model_.sliced.layers);
    const std::int64_t prepared_ns = process_cpu_ns();
    cpu_.prepare_ns = prepared_ns - begin_ns;
    const bool planned = plan();
    const std::int64_t planned_ns = process_cpu_ns();
    cpu_.plan_ns = planned_ns - prepared_ns;
    if (planned && !arguments_.no_judge) {
      judge();
      cpu_.judge_ns = process_cpu_ns() - planned_ns;
    }
    OutputSet outputs;
    if (planned && !arguments_.gcode.empty()) add_gcode(outputs);
    if (planned && !arguments_.svg.empty()) add_pictures(outputs);
    if (!arguments_.json.empty() && arguments_.json != "-")
      write_json(outputs, arguments_.json, document());
    outputs.commit();
    if (arguments_.json == "-") {
      write_json(outputs, "-", document());
    } else {
      print_table(std::cout);
    }
    keep_until_exit(std::move(model_));
    keep_until_exit(std::move(planned_));
    keep_until_exit(std::move(parallel_for_));
    return !cell_ || cell_->verdict.outcome == Outcome::kValid ? 0 : kExitNotValid;
  }

 private:
  /// False if a planner has failed.
  bool plan() {
    if (const auto* print = std::get_if<GcodePrint>(&*source_)) {
      placed_ =
          place_print(*print, model_, chosen_, offset_, judge_.task().line_width_mm, parallel_for_);
      planned_ = placed_->layers;
      for (const PlannedLayer& layer : planned_) routes_.push_back(&layer);
      print_warnings(arguments_.from_gcode, print->warnings);
      if (const auto warning = misplaced_in_z(model_.sliced.layers, print->layers))
        print_warnings(arguments_.from_gcode, {*warning});
      return true;
    }
    Outcome outcome = Outcome::kFailed;
    std::string reason;
    try {
      plan_with(std::get<Contender>(*source_));
    } catch (const PlannerDied& death) {
      outcome = Outcome::kCrashed;
      reason = one_line(death.what());
    } catch (const Error& error) {
      // A planner that breaks its contract is a result like any other.
      reason = one_line(error.what());
    }
    if (routes_.size() != chosen_.size()) {
      std::cerr << "routebench: " << arguments_.model << ": " << reason << '\n';
      cell_ = {.layers = {}, .totals = {}, .verdict = {outcome, reason}};
      return false;
    }
    return true;
  }

  /// Plans each layer; or equal ones once, where no times are asked for.
  void plan_with(const Contender& contender) {
    const bool once = arguments_.no_judge;
    std::vector<std::size_t> original(chosen_.size());
    std::iota(original.begin(), original.end(), std::size_t{0});
    if (once) original = first_of_equal_routes(contender, model_, chosen_);
    std::vector<std::size_t> different;
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      if (original[i] == i) different.push_back(chosen_[i]);
    planned_ = plan_layers(contender, model_, different, judge_.task(), arguments_.seed, {},
                           parallel_for_, once ? Repeats::kTakeOver : Repeats::kPlan);
    auto next = planned_.cbegin();
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      routes_.push_back(original[i] == i ? &*next++ : routes_[original[i]]);
  }

  void judge() {
    if (placed_) {
      cell_ = judge_print(judge_, model_, chosen_, *placed_, parallel_for_);
      return;
    }
    cell_ = judge_layers(judge_, model_, chosen_, planned_, parallel_for_);
    cell_->totals[metric_index("peak_rss_bytes")] = std::get<Contender>(*source_).peak_rss_bytes();
  }

  [[nodiscard]] Json source() const {
    const auto* contender = std::get_if<Contender>(&*source_);
    return contender != nullptr ? json_of(*contender) : Json{{"gcode", arguments_.from_gcode}};
  }

  [[nodiscard]] Json document() const {
    const bool planned = std::holds_alternative<Contender>(*source_);
    return plan_document({source(), model_.sliced, judge_,
                          planned ? std::optional(arguments_.seed) : std::nullopt, chosen_.size(),
                          cell_ ? &*cell_ : nullptr, arguments_.phases ? &cpu_ : nullptr});
  }

  void add_gcode(OutputSet& outputs) const {
    outputs.add(arguments_.gcode, [&](std::ostream& out) {
      const std::vector<std::string> comments = {"model = " + arguments_.model,
                                                 "contender = " + text_of(source(), true)};
      GcodeWriter writer(out, judge_.task(), judge_.printer(), comments);
      std::vector<RoutedLayer> layers;
      for (std::size_t i = 0; i < chosen_.size(); ++i)
        layers.push_back({&model_.sliced.layers[chosen_[i]], routes_[i]});
      writer.write_layers(layers, parallel_for_);
      writer.finish();
    });
  }

  void add_pictures(OutputSet& outputs) const {
    outputs.add_folder(arguments_.svg);
    std::optional<Point2> nozzle;
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      const Layer& layer = model_.sliced.layers[chosen_[i]];
      outputs.add(layer_picture(arguments_.svg, layer.index),
                  [&](std::ostream& out) { write_route_svg(out, layer, *routes_[i], nozzle); });
      if (const auto end = end_of(routes_[i]->route)) nozzle = end;
    }
  }

  void print_table(std::ostream& out) const {
    out << "model      " << arguments_.model << ", " << chosen_.size() << " of "
        << model_.sliced.layers.size() << " layers";
    if (model_.sliced.report.repaired_layers > 0)
      out << " (" << model_.sliced.report.repaired_layers << " repaired)";
    if (const auto* contender = std::get_if<Contender>(&*source_))
      out << "\ncontender  " << contender->spec().name << ", order "
          << to_string(contender->spec().order);
    else
      out << "\nstrokes    of " << arguments_.from_gcode;
    out << "\noutcome    " << (cell_ ? to_string(cell_->verdict.outcome) : "planned, not judged");
    if (cell_ && !cell_->verdict.reason.empty()) out << ": " << cell_->verdict.reason;
    out << '\n';
    std::vector<Row> rows;
    if (cell_) rows = rows_of(cell_->totals);
    if (arguments_.phases) append_phases(rows);
    if (!rows.empty()) out << '\n';
    print_rows(out, rows);
  }

  void append_phases(std::vector<Row>& rows) const {
    const auto append = [&rows](const char* label, std::int64_t cpu_ns) {
      rows.push_back({label, std::to_string(cpu_ns), "ns"});
    };
    append("CPU of reading and slicing", cpu_.prepare_ns);
    append("CPU of planning", cpu_.plan_ns);
    if (cpu_.judge_ns) append("CPU of judging", *cpu_.judge_ns);
  }

  const PlanArguments& arguments_;
  Judge judge_;
  PlannerSet planners_;
  ParallelFor parallel_for_;
  std::optional<Point2> offset_;
  std::optional<StrokeSource> source_;
  PreparedModel model_;
  std::vector<std::size_t> chosen_;
  std::optional<PlacedPrint> placed_;  // if the strokes are those of a file
  std::vector<PlannedLayer> planned_;
  std::vector<const PlannedLayer*> routes_;  // of the chosen layers, among planned_
  std::optional<JudgedCell> cell_;           // nothing if it is not to be judged
  PlanPhases cpu_;
};

}  // namespace

void add_plan_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<PlanArguments>();
  CLI::App& command = *app.add_subcommand("plan", "Plan the routes of one model and judge them");
  add_model_argument(command, arguments->model);
  command.add_option("--shell", arguments->shell, "Planner of the walls")->type_name("NAME");
  command.add_option("--fill", arguments->fill, "Planner of the inside")->type_name("NAME");
  command
      .add_option("--from-gcode", arguments->from_gcode,
                  "Take the strokes of a file, of any slicer, in the place of planners")
      ->type_name("FILE");
  add_offset_options(command, arguments->place);
  add_repeated(command, "--set", arguments->set, "SLOT.KEY=VALUE",
               "A planner's parameter, such as fill.angle_deg=30 (see routebench planners NAME)");
  command
      .add_option("--order", arguments->order,
                  "island: finish one island before the next; stage: all walls before the inside")
      ->type_name("island|stage")
      ->capture_default_str();
  add_task_option(command, arguments->task);
  add_printer_option(command, arguments->printer);
  command
      .add_option("--layers", arguments->layers,
                  "Plan only these, by index from 0, such as 3,10..20; skins are found on all")
      ->type_name("LIST");
  command.add_option("--gcode", arguments->gcode, "Write the routes as G-code")->type_name("FILE");
  command.add_option("--svg", arguments->svg, "Draw the route of each layer into a folder")
      ->type_name("DIR");
  command
      .add_option("--json", arguments->json,
                  "Write every score of every layer; - is the standard output, alone")
      ->type_name("FILE|-");
  command.add_flag("--no-judge", arguments->no_judge,
                   "Only plan and write: no outcome and no scores, so the exit code tells nothing "
                   "of the routes' worth");
  command.add_flag("--phases", arguments->phases,
                   "Tell how much CPU reading and slicing, planning and judging took");
  add_plugin_option(command, arguments->plugins);
  add_jobs_option(command, arguments->jobs,
                  "; planning times by the clock on the wall are to be trusted with 1 only");
  command.add_option("--seed", arguments->seed, "For planners that draw lots")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()).description(""))
      ->type_name("N")
      ->capture_default_str();
  add_repair_flag(command, arguments->repair);
  command.callback([arguments, &exit_code] { exit_code = Plan(*arguments).run(); });
}

}  // namespace routebench
