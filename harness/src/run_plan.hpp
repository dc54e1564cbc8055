#pragma once
/// What an experiment has to execute: models made ready, contenders made, cells with their keys.

#include <deque>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "routebench/harness/config.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/results.hpp"
#include "routebench/harness/runner.hpp"
#include "run_cell.hpp"

namespace routebench {

/// Stands after the fingerprint of a plugin that was refused.
inline constexpr const char* kRefusedMark = "-refused";

/// A model under the tasks that cut and fill it alike.
struct ReadyModel {
  ModelRecord record;
  PreparedModel prepared;
  double work = 0;  ///< how much there is to plan and to judge; see work_of
};

struct ReadyContender {
  ContenderRecord record;
  Worker worker;
  std::string plugin_hashes;  ///< of the plugins that its planners come from
};

struct ReadySetting {
  SettingRecord record;
  Judge judge;
};

/// One cell of the experiment.
struct PlannedCell {
  std::string key;
  const ReadyModel* model = nullptr;
  const ReadyContender* contender = nullptr;
  const ReadySetting* setting = nullptr;
  std::uint64_t seed = 1;
  bool chosen = true;  ///< not left out by the options

  /// "model · contender · setting · seed 2", as far as there is more than one.
  std::string label;
};

/// Everything that cells refer to; it stays where it is while they do.
struct RunPlan {
  std::deque<ReadyModel> models;
  std::deque<ReadyContender> contenders;
  std::deque<ReadySetting> settings;
  std::vector<PlannedCell> cells;  ///< setting by setting, model by model
  std::vector<std::string> notes;  ///< lines for people: what was sliced, with what warnings
};

/// Checks contenders, reads and slices models, and lists the cells.
/// Throws Error{kBadInput, kBadUsage} as run_experiment does.
[[nodiscard]] RunPlan make_plan(const ExperimentConfig& config, const PlannerSet& planners,
                                const RunnerOptions& options, const ParallelFor& parallel_for,
                                const RunLog& log);

}  // namespace routebench
