#include "routebench/harness/runner.hpp"

#include <algorithm>
#include <ostream>
#include <thread>

#include "json_parts.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/parallel.hpp"
#include "run_cell.hpp"
#include "run_child.hpp"
#include "run_forecast.hpp"
#include "run_interrupt.hpp"
#include "run_plan.hpp"
#include "run_progress.hpp"
#include "run_redo.hpp"
#include "run_state.hpp"
#include "scratch_folder.hpp"

namespace routebench {
namespace {

int jobs_of(const ExperimentConfig& config, const RunnerOptions& options) {
  const int jobs = options.jobs.value_or(config.run.jobs);
  return jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// The execution of a plan.
class Execution {
 public:
  Execution(const ExperimentConfig& config, const PlannerSet& planners, const RunPlan& plan,
            const RunnerOptions& options, const RunLog& log)
      : config_(config),
        planners_(planners),
        plan_(plan),
        options_(options),
        log_(log),
        limits_{config.run.timeout_s, config.run.memory_mb},
        jobs_(jobs_of(config, options)),
        results_(options.out, config.name,
                 options.fresh ? ResultsWriter::Start::kFresh : ResultsWriter::Start::kResume) {}

  RunSummary run();

 private:
  [[nodiscard]] bool is_done() const;
  void tell_what_was_found() const;
  void tell_what_is_redone() const;
  void begin();
  void execute_cells();
  void take_times();
  void store(CellState& state, const ChildEnd& end, const std::string& started_utc,
             RunProgress& progress);
  StepNews store_time(CellState& state, int repetition, const ChildEnd& end);
  [[nodiscard]] CellWork work_of(const PlannedCell& cell) const;

  const ExperimentConfig& config_;
  const PlannerSet& planners_;
  const RunPlan& plan_;
  const RunnerOptions& options_;
  const RunLog& log_;
  ChildLimits limits_;
  int jobs_;
  ScratchFolder scratch_{std::filesystem::temp_directory_path()};  ///< of slicers that are killed
  InterruptWatch interrupt_;
  ResultsWriter results_;
  std::vector<CellState> states_;
  KnownCells known_;
  std::map<const PlannedCell*, Predecessor> predecessors_;
  std::optional<Forecast> forecast_;
  std::map<const ReadyModel*, std::int64_t> model_ids_;
  std::map<const ReadyContender*, std::int64_t> contender_ids_;
  std::map<const ReadySetting*, std::int64_t> setting_ids_;
  RunSummary summary_;
};

/// True if the database already is what this run would make of it.
bool Execution::is_done() const {
  const auto current = std::count_if(known_.begin(), known_.end(),
                                     [](const auto& entry) { return entry.second.current; });
  if (static_cast<std::size_t>(current) != summary_.found) return false;
  return std::all_of(states_.begin(), states_.end(), [&](const CellState& state) {
    if (state.cell_id == 0) return !state.cell->chosen;
    return known_.at(state.cell->key).current &&
           missing_repetitions(state, config_.run.repetitions).empty();
  });
}

void Execution::tell_what_was_found() const {
  if (summary_.found == 0) return;
  tell(log_, std::to_string(summary_.found) + " of " + std::to_string(plan_.cells.size()) +
                 " cells are in the database already");
  const std::string build_id = collect_provenance().program_build_id;
  const auto others = std::count_if(states_.begin(), states_.end(), [&](const CellState& state) {
    return state.cell_id != 0 && known_.at(state.cell->key).program_build_id != build_id;
  });
  if (others > 0)
    tell(log_, std::to_string(others) +
                   " of them were executed by another build of routebench; --fresh executes all "
                   "anew");
}

void Execution::tell_what_is_redone() const {
  for (const CellState& state : states_)
    if (const auto found = predecessors_.find(state.cell); found != predecessors_.end())
      tell_redo(log_, state.cell->label, found->second.changed);
}

/// Stores all that cells refer to, and the run itself.
void Execution::begin() {
  RunRecord record;
  record.experiment = config_.name;
  record.seed = config_.seeds.front();
  record.config_text = config_.text;
  record.config_resolved_json = resolved_json(config_, planners_.registry);
  record.config_file = config_.file;
  record.working_folder = std::filesystem::current_path();
  record.repair = options_.repair;
  if (options_.shard) record.shard = to_string(*options_.shard);
  record.command_line = options_.command_line;
  record.provenance = collect_provenance();
  Json plugins = Json::array();
  for (const PluginRecord& plugin : planners_.plugins) plugins.push_back(json_of(plugin));
  record.plugins_json = text_of(plugins, true);

  results_.together([&] {
    for (const ReadyModel& model : plan_.models) {
      const std::vector<Layer>& layers = model.prepared.sliced.layers;
      model_ids_[&model] = results_.model_id(model.record);
      for (const std::size_t i : config_.run.keep_layers.of(layers.size()))
        results_.add_layer_shape(model_ids_[&model], layers[i]);
    }
    for (const ReadyContender& contender : plan_.contenders)
      contender_ids_[&contender] = results_.contender_id(contender.record);
    for (const ReadySetting& setting : plan_.settings)
      setting_ids_[&setting] = results_.setting_id(setting.record);
    results_.begin_run(record);
    for (const CellState& state : states_)
      if (state.cell_id != 0) results_.reuse_cell(state.cell_id);
  });
}

CellWork Execution::work_of(const PlannedCell& cell) const {
  return {&cell.contender->worker,
          &cell.model->prepared,
          &cell.setting->judge,
          cell.seed,
          config_.run.keep_layers.of(cell.model->record.layers),
          options_.repair,
          scratch_.path(),
          config_.run.memory_mb};
}

void Execution::store(CellState& state, const ChildEnd& end, const std::string& started_utc,
                      RunProgress& progress) {
  const PlannedCell& cell = *state.cell;
  CellResult result = cell_result_of(end, limits_);
  CellRecord record;
  record.cell_key = cell.key;
  record.model_id = model_ids_.at(cell.model);
  record.contender_id = contender_ids_.at(cell.contender);
  record.setting_id = setting_ids_.at(cell.setting);
  record.seed = cell.seed;
  record.plugin_hashes = cell.contender->plugin_hashes;
  record.outcome = result.outcome;
  record.reason = result.reason;
  record.layers = cell.model->record.layers;
  record.route_hash = result.route_hash;
  record.started_utc = started_utc;
  record.cell_wall_s = end.wall_s;
  record.totals = std::move(result.totals);
  record.layer_scores = std::move(result.layers);
  record.routes = std::move(result.routes);
  state.outcome = result.outcome;
  state.route_hash = std::move(result.route_hash);
  // With several cells at a time they disturb each other: such times are no samples.
  if (jobs_ == 1 && state.has_route() && !is_foreign(cell)) {
    record.timing = std::move(result.timing);
    state.repetitions.push_back(0);
  }
  state.cell_id = results_.add_cell(record);
  ++summary_.executed;

  progress.step(forecast_->cell_s(cell), {cell.label, result.outcome, result.reason});
}

void Execution::execute_cells() {
  std::vector<std::size_t> to_do;
  double weight = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (!states_[i].is_to_execute()) continue;
    to_do.push_back(i);
    weight += forecast_->cell_s(*states_[i].cell);
  }
  if (to_do.empty()) return;
  tell(log_, "executing " + std::to_string(to_do.size()) + " cells, " + std::to_string(jobs_) +
                 " at a time");
  RunProgress progress(log_, "cell", to_do.size(), weight);
  std::vector<std::string> started_utc(states_.size());
  ChildPool pool(limits_);
  std::size_t next = 0;
  while (next < to_do.size() || pool.running() > 0) {
    if (interrupt_.interrupted()) return;
    while (next < to_do.size() && pool.running() < static_cast<std::size_t>(jobs_)) {
      const std::size_t i = to_do[next++];
      started_utc[i] = utc_now();
      pool.start(i, [work = work_of(*states_[i].cell)](ChildProgress& where) {
        return execute_cell(work, where);
      });
    }
    for (const ChildPool::Finished& finished : pool.wait())
      store(states_[finished.id], finished.end, started_utc[finished.id], progress);
  }
}

/// Returns what there is to tell: nothing, unless the cell did not do again what it did before.
StepNews Execution::store_time(CellState& state, int repetition, const ChildEnd& end) {
  CellResult result = cell_result_of(end, limits_);
  const std::string which = "repetition " + std::to_string(repetition);
  if (result.outcome == Outcome::kValid && result.route_hash != state.route_hash) {
    result.outcome = Outcome::kFailed;
    result.reason = "not deterministic: " + which + " made another route";
  } else if (result.outcome != Outcome::kValid) {
    result.reason = which + ": " + result.reason;
  }
  if (result.outcome != Outcome::kValid) {
    results_.change_outcome(state.cell_id, result.outcome, result.reason);
    state.outcome = result.outcome;
    return {state.cell->label, result.outcome, result.reason};
  }
  result.timing.repetition = repetition;
  results_.add_timing(state.cell_id, result.timing);
  return {};
}

void Execution::take_times() {
  const std::vector<Repetition> order =
      timing_order(states_, config_.run.repetitions, config_.seeds.front());
  if (order.empty() || interrupt_.interrupted()) return;
  double weight = 0;
  for (const Repetition& sample : order) weight += forecast_->sample_s(*states_[sample.cell].cell);
  tell(log_, "taking " + std::to_string(order.size()) + " timing samples, one at a time");
  RunProgress progress(log_, "timing sample", order.size(), weight);
  ChildPool pool(limits_);
  for (const Repetition& sample : order) {
    CellState& state = states_[sample.cell];
    StepNews news;
    if (state.has_route()) {
      pool.start(0, [work = work_of(*state.cell)](ChildProgress& where) {
        return time_cell(work, where);
      });
      while (pool.running() > 0) {
        if (interrupt_.interrupted()) return;
        for (const ChildPool::Finished& finished : pool.wait())
          news = store_time(state, sample.number, finished.end);
      }
    }
    progress.step(forecast_->sample_s(*state.cell), news);
  }
}

RunSummary Execution::run() {
  // Only now: whatever is wrong with config, models or results has been said in a line of its own.
  for (const std::string& note : plan_.notes) tell(log_, note);
  summary_.file = results_.file();
  known_ = results_.known_cells();
  states_ = states_of(plan_, known_, config_.run);
  predecessors_ = predecessors_of(states_, known_, config_.run);
  forecast_.emplace(states_, known_, predecessors_);
  summary_.found = static_cast<std::size_t>(std::count_if(
      states_.begin(), states_.end(), [](const CellState& state) { return state.cell_id != 0; }));
  tell_what_was_found();
  tell_what_is_redone();
  if (is_done()) return summary_;
  begin();
  execute_cells();
  take_times();
  summary_.interrupted = interrupt_.interrupted();
  summary_.left = static_cast<std::size_t>(
      std::count_if(states_.begin(), states_.end(),
                    [](const CellState& state) { return state.is_to_execute(); }));
  if (summary_.interrupted) return summary_;
  results_.finish_run();
  return summary_;
}

}  // namespace

std::string to_string(const Shard& shard) {
  return std::to_string(shard.number) + "/" + std::to_string(shard.count);
}

RunSummary run_experiment(const ExperimentConfig& config, const PlannerSet& planners,
                          const RunnerOptions& options, const RunLog& log) {
  const RunPlan plan =
      make_plan(config, planners, options, parallel_loop(jobs_of(config, options)), log);
  return Execution(config, planners, plan, options, log).run();
}

Foresight foresee_experiment(const ExperimentConfig& config, const PlannerSet& planners,
                             const RunnerOptions& options, const RunLog& log) {
  Foresight foresight;
  foresight.jobs = jobs_of(config, options);
  const RunPlan plan = make_plan(config, planners, options, parallel_loop(foresight.jobs), log);
  const KnownCells known = options.fresh ? KnownCells{} : known_cells(options.out, config.name);
  for (const std::string& note : plan.notes) tell(log, note);
  std::vector<CellState> states = states_of(plan, known, config.run);
  const auto predecessors = predecessors_of(states, known, config.run);
  const Forecast forecast(states, known, predecessors);
  foresight.known_cells = forecast.known_cells();
  for (CellState& state : states) {
    if (state.cell_id != 0) ++foresight.found;
    if (state.is_to_execute()) {
      const auto before = predecessors.find(state.cell);
      foresight.cells.push_back({state.cell->label,
                                 before == predecessors.end() ? "" : before->second.changed,
                                 forecast.cell_s(*state.cell)});
      foresight.cells_s += foresight.cells.back().seconds / foresight.jobs;
      // It is going to be valid, for all that is known.
      state.outcome = Outcome::kValid;
      if (foresight.jobs == 1) state.repetitions.push_back(0);
    }
    const std::size_t samples = missing_repetitions(state, config.run.repetitions).size();
    foresight.samples += samples;
    foresight.samples_s += static_cast<double>(samples) * forecast.sample_s(*state.cell);
  }
  return foresight;
}

void write_foresight(std::ostream& out, const Foresight& foresight) {
  for (const ForeseenCell& cell : foresight.cells)
    out << (cell.why.empty() ? "would execute " : "would redo ") << cell.label
        << (cell.why.empty() ? "" : ": " + cell.why) << '\n';
  out << foresight.cells.size() << " cells to execute, " << foresight.found << " done, "
      << foresight.samples << " timing samples to take\n";
  if (foresight.cells.empty() && foresight.samples == 0) return;
  out << "about " << duration_text(foresight.cells_s + foresight.samples_s) << ": "
      << duration_text(foresight.cells_s) << " for cells, " << foresight.jobs << " at a time, and "
      << duration_text(foresight.samples_s) << " for timing samples, one at a time\n";
  if (foresight.known_cells > 0)
    out << "estimated from the times of " << foresight.known_cells << " cells in the database\n";
  else
    out << "estimated from the models' sizes alone (layers, contours, lengths to be laid), so it "
           "may be out by a factor of five\n";
}

}  // namespace routebench
