#pragma once
/// Executes an experiment: every contender on every model under every setting.

#include <compare>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "routebench/harness/config.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/results.hpp"
#include "routebench/harness/run_log.hpp"

namespace routebench {

/// The part of an experiment that one of several runs executes: every `count`-th cell, beginning
/// with the one numbered `number`.
struct Shard {
  std::size_t number = 1;  ///< 1 to count
  std::size_t count = 1;
};
[[nodiscard]] std::string to_string(const Shard& shard);  ///< "2/3"

/// What people call a cell: its parts by their names in the config.
struct CellName {
  std::string model;      ///< as written
  std::string contender;  ///< with its point of the sweep
  std::string setting;    ///< the label
  std::uint64_t seed = 1;
  auto operator<=>(const CellName&) const = default;
};

struct RunnerOptions {
  std::filesystem::path out;                 ///< folder of the results
  std::optional<int> jobs;                   ///< overrides the config's
  bool fresh = false;                        ///< start a new database; see ResultsWriter::Start
  bool repair = false;                       ///< slice broken models; see SliceModelOptions
  std::vector<std::string> only_contenders;  ///< names, with or without the point of the sweep;
                                             ///< empty: all
  std::vector<std::string> only_models;      ///< specs as written; empty: all
  std::vector<std::string> only_settings;    ///< labels or parts of them ("density=1"); empty: all
  std::optional<std::set<CellName>> only_cells;  ///< no others
  std::optional<Shard> shard;                    ///< of all cells of the config
  std::string command_line;                      ///< for the record
};

/// What a call came to.
struct RunSummary {
  std::size_t executed = 0;  ///< cells
  std::size_t found = 0;     ///< cells that an earlier run has done
  std::size_t left = 0;      ///< cells that an interrupted run leaves undone
  bool interrupted = false;
  std::filesystem::path file;  ///< the database
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

/// A cell that run_experiment would execute.
struct ForeseenCell {
  std::string label;
  std::string why;  ///< what has changed since another cell stood in its place; empty if it is new
  double seconds = 0;
};

/// What run_experiment would do, and about how long that would take.
struct Foresight {
  std::vector<ForeseenCell> cells;
  std::size_t found = 0;        ///< cells that an earlier run has done
  std::size_t samples = 0;      ///< timing samples to be taken
  int jobs = 1;                 ///< cells at a time
  double cells_s = 0;           ///< for all cells, so many at a time
  double samples_s = 0;         ///< for the samples, one at a time
  std::size_t known_cells = 0;  ///< whose times this is drawn from; 0: from sizes alone
};

/// Checks all that run_experiment checks, and writes nothing.
[[nodiscard]] Foresight foresee_experiment(const ExperimentConfig& config,
                                           const PlannerSet& planners, const RunnerOptions& options,
                                           const RunLog& log);

/// A line a cell, then the sums.
void write_foresight(std::ostream& out, const Foresight& foresight);

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
