#pragma once
/// The results database: one SQLite file an experiment, written cell by cell.
///
/// Tables and columns are described in results/README.md. A cell is found again by its key, so that
/// an experiment that was stopped goes on where it was; nothing that was written is changed, except
/// that timing samples are added to a cell and that a repetition can take a cell's outcome away.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "routebench/harness/contender.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/metrics.hpp"
#include "routebench/harness/provenance.hpp"

namespace routebench {

class Database;

inline constexpr int kResultsSchemaVersion = 2;

/// One execution of an experiment.
struct RunRecord {
  std::string experiment;
  std::uint64_t seed = 1;
  std::string config_text;
  std::string config_resolved_json;
  std::filesystem::path config_file;     ///< as given; its folder is where relative paths begin
  std::filesystem::path working_folder;  ///< where relative paths of the command line begin
  bool repair = false;                   ///< broken models were sliced, too
  std::string shard;                     ///< "2/3" if this was the second of three; else empty
  std::string command_line;
  Provenance provenance;
  std::string plugins_json;
};

struct ModelRecord {
  std::string spec;
  std::string mesh_hash;  ///< empty if the model is a file of layers
  std::string layers_hash;
  std::size_t triangles = 0;
  std::size_t layers = 0;
  std::string report_json;
  std::string warnings_json;
};

struct ContenderRecord {
  std::string name;
  std::string base_name;
  std::string variant_json;
  std::string variant_hash;
};

struct SettingRecord {
  std::string label;
  std::string task_json;
  std::string printer_json;
  std::string setting_hash;
};

/// The route of a layer, for pictures.
struct RouteRecord {
  std::size_t layer_index = 0;
  std::string strokes_json;
};

/// One timed execution of a cell's planning, in a process of its own.
struct TimingSample {
  int repetition = 0;
  PlanTime cell;                    ///< sum over the layers
  std::vector<PlanTime> layers;     ///< lowest first
  std::int64_t minor_faults = 0;    ///< page faults while planning that needed no disk
  std::int64_t major_faults = 0;    ///< page faults while planning that waited for the disk
  std::int64_t peak_rss_bytes = 0;  ///< largest resident memory up to the end of planning
};

/// What came of a cell.
struct CellRecord {
  std::string cell_key;
  std::int64_t model_id = 0;
  std::int64_t contender_id = 0;
  std::int64_t setting_id = 0;
  std::uint64_t seed = 1;
  std::string plugin_hashes;  ///< of the files that its planners come from, if not compiled in
  Outcome outcome = Outcome::kValid;
  std::string reason;
  std::size_t layers = 0;
  std::optional<std::string> route_hash;
  std::string started_utc;
  double cell_wall_s = 0;
  Scores totals;  ///< empty or one a metric; plan times are taken from timing samples alone
  std::vector<LayerScore> layer_scores;
  std::vector<RouteRecord> routes;
  std::optional<TimingSample> timing;  ///< if the execution can be trusted for time
};

/// What is known of a cell that was executed before.
struct KnownCell {
  std::int64_t cell_id = 0;
  std::shared_ptr<const ModelRecord> model;  ///< without reports and warnings
  std::shared_ptr<const ContenderRecord> contender;
  std::shared_ptr<const SettingRecord> setting;
  std::uint64_t seed = 1;
  std::string plugin_hashes;
  Outcome outcome = Outcome::kValid;
  std::optional<std::string> route_hash;
  std::vector<int> repetitions;  ///< numbers of its timing samples, ascending
  bool current = false;          ///< belongs to the last run's config
  double cell_wall_s = 0;
  std::optional<double> plan_wall_s;  ///< median of its timing samples
  double timeout_s = 0;               ///< the limits under which it was executed
  int memory_mb = 0;
  std::string program_build_id;  ///< of the program that executed it
};

/// By cell key.
using KnownCells = std::map<std::string, KnownCell>;

/// The name of an outcome back to the outcome. Throws Error{kBadInput} for another name.
[[nodiscard]] Outcome outcome_named(const std::string& name);

/// The only writer of an experiment's results, for as long as it lives.
class ResultsWriter {
 public:
  enum class Start {
    kResume,  ///< go on with what is there
    kFresh,   ///< start anew; the old file is replaced when the new one holds its first cell
  };

  /// Takes  a folder, which is made if need be; the file in it is results.sqlite.
  /// Throws Error{kBadInput} if another run is writing there, if the file belongs to another
  ///        experiment or was written by another version (kFresh accepts another version), or if it
  ///        cannot be written.
  ResultsWriter(const std::filesystem::path& folder, const std::string& experiment, Start start);
  ~ResultsWriter();
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const noexcept;

  [[nodiscard]] KnownCells known_cells();

  /// Runs `writes`, which calls other members, so that all of it is stored or nothing.
  void together(const std::function<void()>& writes);

  /// Adds the run to which all cells that are added from now on belong.
  void begin_run(const RunRecord& run);
  /// Notes the end of the run and puts a fresh file in its place.
  void finish_run();

  /// Finds or adds, and returns the id.
  [[nodiscard]] std::int64_t model_id(const ModelRecord& model);
  [[nodiscard]] std::int64_t contender_id(const ContenderRecord& contender);
  [[nodiscard]] std::int64_t setting_id(const SettingRecord& setting);

  /// Stores the shape of a layer unless it is there.
  void add_layer_shape(std::int64_t model_id, const Layer& layer);

  /// Says that a cell of an earlier run belongs to this run's experiment, too.
  void reuse_cell(std::int64_t cell_id);

  /// Adds a cell with all that belongs to it in one transaction, and returns its id. A cell with
  /// the same key that ran into a limit (timed_out, out_of_memory) is replaced.
  std::int64_t add_cell(const CellRecord& cell);

  /// Adds a timing sample and brings the cell's plan times, medians of its samples, up to date. The
  /// layers' times are those of repetition 0.
  void add_timing(std::int64_t cell_id, const TimingSample& sample);

  /// A repetition went wrong: the cell is no longer what it was.
  void change_outcome(std::int64_t cell_id, Outcome outcome, const std::string& reason);

  /// The open file, for what is done to whole tables.
  [[nodiscard]] Database& database() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a database knows of cells; nothing if there is none yet in that folder.
/// Throws Error{kBadInput} as ResultsWriter does.
[[nodiscard]] KnownCells known_cells(const std::filesystem::path& folder,
                                     const std::string& experiment);

/// One cell as tables show it.
struct StoredCell {
  std::string model;
  std::string contender;
  std::string setting;
  std::uint64_t seed = 1;
  Outcome outcome = Outcome::kValid;
  std::string reason;
  std::size_t layers = 0;
  Scores totals;  ///< one a metric
  std::string layers_hash;
  std::string plugin_hashes;
  std::optional<std::string> route_hash;
};

/// The file of results that a user means: the file itself or the folder that holds it.
/// Throws Error{kBadInput} if there is none.
[[nodiscard]] std::filesystem::path results_file(const std::filesystem::path& folder_or_file);

/// The cells of the last run's config: those that it executed and those that it found done, setting
/// by setting, model by model.
/// Throws Error{kBadInput} for a file that is no results database of this version.
[[nodiscard]] std::vector<StoredCell> current_cells(const std::filesystem::path& file);

/// What a database says of its last run.
struct LastRun {
  RunRecord record;
  bool finished = false;
};
/// Throws Error{kBadInput} for a file that is no results database of this version or has no run.
[[nodiscard]] LastRun last_run(const std::filesystem::path& file);

/// Writes the current cells as the SQLite schema of OMPL's benchmarks (tables experiments,
/// plannerConfigs, enums, runs, progress), which Planner Arena and scripts for it read. A row of
/// runs is a timing sample of a cell, or the cell itself if it has none. Returns the file.
/// Throws Error{kBadInput} if the file cannot be written.
std::filesystem::path export_ompl(const std::filesystem::path& file,
                                  const std::filesystem::path& folder);

/// What merge_results made.
struct MergeSummary {
  std::filesystem::path file;
  std::size_t cells = 0;             ///< of the parts' last runs
  std::vector<std::string> remarks;  ///< what people should know: runs that are not finished,
                                     ///< shards that are missing
};

/// Joins databases of one experiment, such as its shards, into a new one: all runs, cells, scores,
/// routes, layer shapes and timing samples of all of them. Its current cells are those of every
/// part's last run.
///
/// A cell that several parts hold is stored once, with the timing samples of all; one that ran into
/// a limit in one part and not in another is taken from the other.
///
/// Takes  the folder of the new database; folders of results or databases; whether an old database
///        in that folder may be replaced; the command line for the record.
/// Throws Error{kBadInput}, and leaves everything as it was: parts of different experiments,
///        configs or schemas, a database that stands in the way, and cells that have the same key
///        but differ in outcome, route or scores, which are named.
MergeSummary merge_results(const std::filesystem::path& out,
                           const std::vector<std::filesystem::path>& parts, bool replace,
                           const std::string& command_line);

/// Writes the database as CSV files (RFC 4180, UTF-8, a header line each), every file under a
/// temporary name first. Returns the files. See results/README.md for their columns.
/// Throws Error{kBadInput} if the folder cannot be written.
std::vector<std::filesystem::path> export_csv(const std::filesystem::path& file,
                                              const std::filesystem::path& folder);

}  // namespace routebench
