#include "routebench/harness/runner.hpp"

#include <algorithm>
#include <ostream>
#include <thread>

#include "json_parts.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/parallel.hpp"
#include "run_cell.hpp"
#include "run_child.hpp"
#include "run_interrupt.hpp"
#include "run_plan.hpp"
#include "run_progress.hpp"
#include "scratch_folder.hpp"

namespace routebench {
namespace {

int jobs_of(const ExperimentConfig& config, const RunnerOptions& options) {
  const int jobs = options.jobs.value_or(config.run.jobs);
  return jobs > 0 ? jobs : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// Foreign slicers do not tell the time that planning takes, so there are no samples of it.
bool is_foreign(const PlannedCell& cell) {
  return std::holds_alternative<Slicer>(cell.contender->worker);
}

/// A cell on its way.
struct CellState {
  const PlannedCell* cell = nullptr;
  std::int64_t cell_id = 0;  ///< 0: not in the database
  Outcome outcome = Outcome::kFailed;
  std::optional<std::string> route_hash;
  std::vector<int> repetitions;  ///< that have been taken

  [[nodiscard]] bool has_route() const {
    return outcome == Outcome::kValid || outcome == Outcome::kOffTask;
  }
};

/// A cell that ran into a limit which has been raised since gets another chance.
bool may_go_further(const KnownCell& known, const RunOptions& run) {
  return (known.outcome == Outcome::kTimedOut && run.timeout_s > known.timeout_s) ||
         (known.outcome == Outcome::kOutOfMemory && run.memory_mb > known.memory_mb);
}

/// Cells in the plan's order with what is known of them.
std::vector<CellState> states_of(const RunPlan& plan, const KnownCells& known,
                                 const RunOptions& run) {
  std::vector<CellState> states;
  for (const PlannedCell& cell : plan.cells) {
    CellState state{&cell, 0, Outcome::kFailed, {}, {}};
    const auto found = known.find(cell.key);
    if (found != known.end() && !(cell.chosen && may_go_further(found->second, run)))
      state = {&cell, found->second.cell_id, found->second.outcome, found->second.route_hash,
               found->second.repetitions};
    states.push_back(std::move(state));
  }
  return states;
}

bool is_to_execute(const CellState& state) { return state.cell->chosen && state.cell_id == 0; }

std::vector<int> missing_repetitions(const CellState& state, int wanted) {
  std::vector<int> missing;
  if (!state.cell->chosen || !state.has_route() || is_foreign(*state.cell)) return missing;
  for (int i = 0; i < wanted; ++i)
    if (!std::binary_search(state.repetitions.begin(), state.repetitions.end(), i))
      missing.push_back(i);
  return missing;
}

double weight_of(const PlannedCell& cell) {
  return 1 + static_cast<double>(cell.model->record.layers);
}

std::string line_about(const PlannedCell& cell, const CellResult& result) {
  const std::string line = cell.label + ": " + std::string(to_string(result.outcome));
  return result.reason.empty() ? line : line + " (" + result.reason + ")";
}

/// One timing sample to be taken.
struct Repetition {
  std::size_t cell = 0;
  int number = 0;
};

/// The order of samples: rounds, each with every cell in random order, so that a slow moment of the
/// machine hits all contenders alike.
std::vector<Repetition> timing_order(const std::vector<CellState>& states, int repetitions,
                                     std::uint64_t seed) {
  // splitmix64: the same order everywhere, which std::shuffle does not promise.
  const auto next = [&seed] {
    std::uint64_t z = (seed += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  };
  std::vector<std::vector<Repetition>> rounds(static_cast<std::size_t>(repetitions));
  for (std::size_t i = 0; i < states.size(); ++i)
    for (const int number : missing_repetitions(states[i], repetitions))
      rounds[static_cast<std::size_t>(number)].push_back({i, number});
  std::vector<Repetition> order;
  for (std::vector<Repetition>& round : rounds) {
    for (std::size_t left = round.size(); left > 1; --left)
      std::swap(round[left - 1], round[next() % left]);
    order.insert(order.end(), round.begin(), round.end());
  }
  return order;
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
  [[nodiscard]] bool is_done(const KnownCells& known) const;
  void tell_what_was_found(const KnownCells& known) const;
  void begin();
  void execute_cells();
  void take_times();
  void store(CellState& state, const ChildEnd& end, const std::string& started_utc,
             RunProgress& progress);
  std::string store_time(CellState& state, int repetition, const ChildEnd& end);
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
  std::map<const ReadyModel*, std::int64_t> model_ids_;
  std::map<const ReadyContender*, std::int64_t> contender_ids_;
  std::map<const ReadySetting*, std::int64_t> setting_ids_;
  RunSummary summary_;
};

/// True if the database already is what this run would make of it.
bool Execution::is_done(const KnownCells& known) const {
  const auto current = std::count_if(known.begin(), known.end(),
                                     [](const auto& entry) { return entry.second.current; });
  if (static_cast<std::size_t>(current) != summary_.found) return false;
  return std::all_of(states_.begin(), states_.end(), [&](const CellState& state) {
    if (state.cell_id == 0) return !state.cell->chosen;
    return known.at(state.cell->key).current &&
           missing_repetitions(state, config_.run.repetitions).empty();
  });
}

void Execution::tell_what_was_found(const KnownCells& known) const {
  if (summary_.found == 0) return;
  *log_.out << summary_.found << " of " << plan_.cells.size()
            << " cells are in the database already\n";
  const std::string build_id = collect_provenance().program_build_id;
  const auto others = std::count_if(states_.begin(), states_.end(), [&](const CellState& state) {
    return state.cell_id != 0 && known.at(state.cell->key).program_build_id != build_id;
  });
  if (others > 0)
    *log_.out << others
              << " of them were executed by another build of routebench; --fresh executes "
              << "all anew\n";
}

/// Stores all that cells refer to, and the run itself.
void Execution::begin() {
  RunRecord record;
  record.experiment = config_.name;
  record.seed = config_.seeds.front();
  record.config_text = config_.text;
  record.config_resolved_json = resolved_json(config_, planners_.registry);
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

  progress.step(weight_of(cell), line_about(cell, result), result.outcome != Outcome::kValid);
}

void Execution::execute_cells() {
  std::vector<std::size_t> to_do;
  double weight = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (!is_to_execute(states_[i])) continue;
    to_do.push_back(i);
    weight += weight_of(*states_[i].cell);
  }
  if (to_do.empty()) return;
  *log_.out << "executing " << to_do.size() << " cells, " << jobs_ << " at a time\n";
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
std::string Execution::store_time(CellState& state, int repetition, const ChildEnd& end) {
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
    return line_about(*state.cell, result);
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
  for (const Repetition& sample : order) weight += weight_of(*states_[sample.cell].cell);
  *log_.out << "taking " << order.size() << " timing samples, one at a time\n";
  RunProgress progress(log_, "timing sample", order.size(), weight);
  ChildPool pool(limits_);
  for (const Repetition& sample : order) {
    CellState& state = states_[sample.cell];
    std::string line;
    if (state.has_route()) {
      pool.start(0, [work = work_of(*state.cell)](ChildProgress& where) {
        return time_cell(work, where);
      });
      while (pool.running() > 0) {
        if (interrupt_.interrupted()) return;
        for (const ChildPool::Finished& finished : pool.wait())
          line = store_time(state, sample.number, finished.end);
      }
    }
    progress.step(weight_of(*state.cell), line, !line.empty());
  }
}

RunSummary Execution::run() {
  // Only now: whatever is wrong with config, models or results has been said in a line of its own.
  for (const std::string& note : plan_.notes) *log_.out << note << '\n';
  summary_.file = results_.file();
  const KnownCells known = results_.known_cells();
  states_ = states_of(plan_, known, config_.run);
  summary_.found = static_cast<std::size_t>(std::count_if(
      states_.begin(), states_.end(), [](const CellState& state) { return state.cell_id != 0; }));
  tell_what_was_found(known);
  if (is_done(known)) return summary_;
  begin();
  execute_cells();
  take_times();
  summary_.interrupted = interrupt_.interrupted();
  summary_.left =
      static_cast<std::size_t>(std::count_if(states_.begin(), states_.end(), is_to_execute));
  if (summary_.interrupted) return summary_;
  results_.finish_run();
  return summary_;
}

/// Says what a run would execute.
RunSummary dry_run(const ExperimentConfig& config, const RunPlan& plan,
                   const RunnerOptions& options, const RunLog& log) {
  const KnownCells known = options.fresh ? KnownCells{} : known_cells(options.out, config.name);
  for (const std::string& note : plan.notes) *log.out << note << '\n';
  RunSummary summary;
  double seconds = 0;
  std::size_t timed = 0;
  for (const CellState& state : states_of(plan, known, config.run)) {
    if (state.cell_id != 0) {
      ++summary.found;
      seconds += known.at(state.cell->key).cell_wall_s;
      ++timed;
    }
    if (!is_to_execute(state)) continue;
    ++summary.left;
    *log.out << "would execute " << state.cell->label << '\n';
  }
  *log.out << summary.left << " cells to execute, " << summary.found << " done";
  if (timed > 0 && summary.left > 0)
    *log.out << "; those took " << duration_text(seconds / static_cast<double>(timed))
             << " each, so about "
             << duration_text(seconds / static_cast<double>(timed) *
                              static_cast<double>(summary.left) / jobs_of(config, options))
             << " and the timing samples";
  *log.out << '\n';
  return summary;
}

}  // namespace

RunSummary run_experiment(const ExperimentConfig& config, const PlannerSet& planners,
                          const RunnerOptions& options, const RunLog& log) {
  const RunPlan plan =
      make_plan(config, planners, options, parallel_loop(jobs_of(config, options)), log);
  if (options.dry_run) return dry_run(config, plan, options, log);
  return Execution(config, planners, plan, options, log).run();
}

}  // namespace routebench
