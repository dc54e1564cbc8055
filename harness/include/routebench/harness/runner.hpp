#pragma once
/// Executes an experiment: every contender on every model under every setting.

#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "routebench/harness/config.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/results.hpp"

namespace routebench {

struct RunnerOptions {
  std::filesystem::path out;                 ///< folder of the results
  std::optional<int> jobs;                   ///< overrides the config's
  bool fresh = false;                        ///< start a new database; see ResultsWriter::Start
  bool dry_run = false;                      ///< say what would be executed, write nothing
  bool repair = false;                       ///< slice broken models; see SliceModelOptions
  std::vector<std::string> only_contenders;  ///< names, with or without the point of the sweep;
                                             ///< empty: all
  std::vector<std::string> only_models;      ///< specs as written; empty: all
  std::string command_line;                  ///< for the record
};

/// What a call came to.
struct RunSummary {
  std::size_t executed = 0;  ///< cells
  std::size_t found = 0;     ///< cells that an earlier run has done
  std::size_t left = 0;      ///< cells that an interrupted or dry run leaves undone
  bool interrupted = false;
  std::filesystem::path file;  ///< the database
};

/// Where and how a run reports.
struct RunLog {
  std::ostream* out;      ///< lines for people
  bool terminal = false;  ///< lines may be rewritten: show progress and time to go
};

/// Executes what is not done yet.
///
/// Every contender, model and setting is checked before the first cell begins. Each cell runs in a
/// process of its own, forked when all models are sliced; its routes are judged there, and it is
/// written when it is done. Scores do not depend on `jobs`. Timing samples are taken one at a time
/// after that, in rounds of random order drawn from the config's seed; with one job the first
/// execution counts as the first sample. A cell whose repetitions differ has failed.
///
/// SIGINT, SIGTERM and SIGHUP stop the cells in flight and keep what is done.
///
/// Throws Error{kBadInput} before anything is executed: unknown planners and parameters, models
///        that cannot be read or sliced, results of another experiment, a second run at the same
///        time; Error{kBadUsage} for a name in `only_*` that the config does not have.
RunSummary run_experiment(const ExperimentConfig& config, const PlannerSet& planners,
                          const RunnerOptions& options, const RunLog& log);

/// Counts by outcome, then for each setting the contenders in order of their travel, then what was
/// left out and why.
///
/// Ranking: the geometric mean, over the models (and seeds) on which all ranked contenders are
/// valid, of travel relative to the best contender there; 1 mm is added to both, so that no travel
/// at all is no infinite advantage. A contender without a valid cell is not ranked.
void write_ranking(std::ostream& out, const std::vector<StoredCell>& cells);

/// True if all cells are valid but those whose slicer is not installed.
[[nodiscard]] bool all_valid(const std::vector<StoredCell>& cells);

}  // namespace routebench
