#include <random>
#include <sstream>
#include <system_error>

#include "results_read.hpp"
#include "results_schema.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/layer_io.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/results.hpp"
#include "run_lock.hpp"
#include "sqlite.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

/// The file that SQLite keeps beside a database while it writes.
fs::path journal_of(const fs::path& file) { return file.string() + "-journal"; }

void remove_database(const fs::path& file) {
  fs::remove(journal_of(file));
  fs::remove(file);
}

/// A database that is not in its place yet; it is removed unless it gets there.
struct Unpublished {
  fs::path file;  ///< empty if there is none

  Unpublished() = default;
  Unpublished(const Unpublished&) = delete;
  Unpublished& operator=(const Unpublished&) = delete;
  ~Unpublished() {
    if (file.empty()) return;
    std::error_code ignored;
    fs::remove(journal_of(file), ignored);
    fs::remove(file, ignored);
  }
};

/// Makes a folder and those above it. Returns those that were not there, which go again if they are
/// still empty in the end and were not committed.
std::unique_ptr<OutputSet> made_folders(const fs::path& folder) {
  auto made = std::make_unique<OutputSet>();
  made->add_folder(folder);
  return made;
}

void configure(Database& database) {
  // A commit is on disk before the next cell begins.
  database.run("PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL");
}

/// Tells a run from all others, on whatever machine.
std::string random_key() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string key;
  for (int i = 0; i < 32; ++i) key += kDigits[random() % kDigits.size()];
  return key;
}

std::string wkt_of(const Layer& layer) {
  std::stringstream text;
  write_wkt(text, {layer});
  std::string line;
  while (std::getline(text, line) && line.starts_with('#')) {
  }
  return line;
}

}  // namespace

struct ResultsWriter::Impl {
  Impl(const fs::path& folder_in, const std::string& experiment, Start start)
      : folder(folder_in),
        made(made_folders(folder)),
        lock(folder),
        file(folder / kResultsFileName) {
    if (fs::exists(file)) {
      Database old(file, OpenMode::kExisting);
      require_experiment(old, experiment);
      if (start == Start::kResume) require_our_schema(old);
    }
    const bool resume = start == Start::kResume && fs::exists(file);
    // A new database is made beside its place and moved there when it holds something, so that a
    // run that is stopped early leaves neither an empty file nor the loss of an old one.
    const fs::path beside = file.string() + ".new";
    remove_database(beside);  // of a run that was killed
    if (!resume) unpublished.file = beside;
    database = std::make_unique<Database>(resume ? file : beside, OpenMode::kCreate);
    configure(*database);
    if (!resume) create_schema(*database, experiment);
  }

  /// Moves a new database to its place. SQLite finds the journal of an interrupted write by the
  /// file's name, so the file is closed while it moves, and the old file's journal goes first.
  void publish() {
    if (unpublished.file.empty()) return;
    database.reset();
    if (fs::exists(file)) {
      Database(file, OpenMode::kReadOnly);  // undoes an interrupted write
      fs::remove(journal_of(file));
    }
    fs::rename(unpublished.file, file);
    unpublished.file.clear();
    made->commit();
    database = std::make_unique<Database>(file, OpenMode::kExisting);
    configure(*database);
  }

  Statement sql(std::string_view text) { return Statement(*database, text); }

  void add_scores(std::int64_t cell_id, const Scores& totals);
  void add_layers(std::int64_t cell_id, const std::vector<LayerScore>& layers);
  void add_sample(std::int64_t cell_id, const TimingSample& sample);
  void drop_cell_at_limit(const std::string& cell_key);

  // In this order: what is made last goes first.
  fs::path folder;
  std::unique_ptr<OutputSet> made;
  RunLock lock;
  fs::path file;
  Unpublished unpublished;
  std::unique_ptr<Database> database;
  std::int64_t run_id = 0;
};

void ResultsWriter::Impl::add_scores(std::int64_t cell_id, const Scores& totals) {
  Statement insert = sql("INSERT INTO cell_score VALUES(?, ?, ?)");
  for (std::size_t i = 0; i < totals.size(); ++i) {
    const std::string_view name = metric_table()[i].name;
    if (totals[i] && !is_time_metric(name)) insert.bind(cell_id).bind(name).bind(*totals[i]).run();
  }
}

void ResultsWriter::Impl::add_layers(std::int64_t cell_id, const std::vector<LayerScore>& layers) {
  std::string text = "INSERT INTO layer_score VALUES(?, ?, ?, ?";
  for (std::size_t i = 0; i < metric_table().size(); ++i) text += ", ?";
  Statement insert = sql(text + ")");
  for (const LayerScore& layer : layers) {
    insert.bind(cell_id)
        .bind(std::int64_t{layer.layer_index})
        .bind(layer.z_mm)
        .bind(std::int64_t{layer.repaired});
    for (std::size_t i = 0; i < metric_table().size(); ++i)
      is_time_metric(metric_table()[i].name) ? insert.bind_null() : insert.bind(layer.scores.at(i));
    insert.run();
  }
}

void ResultsWriter::Impl::add_sample(std::int64_t cell_id, const TimingSample& sample) {
  sql("INSERT INTO timing_sample VALUES(?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(cell_id)
      .bind(std::int64_t{sample.repetition})
      .bind(run_id)
      .bind(sample.cell.wall_ns)
      .bind(sample.cell.cpu_ns)
      .bind(sample.minor_faults)
      .bind(sample.major_faults)
      .bind(sample.peak_rss_bytes)
      .run();
  if (sample.repetition == 0) {
    Statement order = sql("SELECT layer_index FROM layer_score WHERE cell_id = ? ORDER BY 1");
    order.bind(cell_id);
    Statement update =
        sql("UPDATE layer_score SET plan_wall_ns = ?, plan_cpu_ns = ? WHERE cell_id = ? AND "
            "layer_index = ?");
    for (const PlanTime& time : sample.layers) {
      if (!order.next()) break;
      update.bind(static_cast<double>(time.wall_ns))
          .bind(static_cast<double>(time.cpu_ns))
          .bind(cell_id)
          .bind(order.integer(0))
          .run();
    }
  }
  update_plan_times(*database, cell_id);
}

void ResultsWriter::Impl::drop_cell_at_limit(const std::string& cell_key) {
  sql("DELETE FROM cell WHERE cell_key = ? AND outcome IN ('timed_out', 'out_of_memory')")
      .bind(std::string_view(cell_key))
      .run();
}

ResultsWriter::ResultsWriter(const fs::path& folder, const std::string& experiment, Start start)
    : impl_(std::make_unique<Impl>(folder, experiment, start)) {}

ResultsWriter::~ResultsWriter() = default;

const fs::path& ResultsWriter::file() const noexcept { return impl_->file; }

KnownCells ResultsWriter::known_cells() { return read_known_cells(*impl_->database); }

void ResultsWriter::together(const std::function<void()>& writes) {
  Transaction transaction(*impl_->database);
  writes();
  transaction.commit();
}

void ResultsWriter::begin_run(const RunRecord& run) {
  const Provenance& from = run.provenance;
  Statement insert = impl_->sql(
      "INSERT INTO run VALUES(NULL, ?, ?, ?, NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?,"
      " ?, ?, ?, ?)");
  insert.bind(std::string_view(random_key()))
      .bind(std::string_view(run.experiment))
      .bind(std::string_view(utc_now()))
      .bind(static_cast<std::int64_t>(run.seed))
      .bind(std::string_view(run.config_text))
      .bind(std::string_view(run.config_resolved_json))
      .bind(std::string_view(run.config_file.string()))
      .bind(std::string_view(run.working_folder.string()))
      .bind(std::int64_t{run.repair})
      .bind(std::string_view(run.shard))
      .bind(std::string_view(run.command_line))
      .bind(std::string_view(from.routebench_version))
      .bind(from.git_commit);
  from.git_dirty ? insert.bind(std::int64_t{*from.git_dirty}) : insert.bind_null();
  insert.bind(std::string_view(from.compiler))
      .bind(std::string_view(from.compiler_flags))
      .bind(std::string_view(from.program_build_id))
      .bind(std::string_view(from.libraries_json))
      .bind(std::string_view(from.cpu))
      .bind(std::int64_t{from.cores})
      .bind(from.memory_bytes)
      .bind(std::string_view(from.os))
      .bind(std::string_view(run.plugins_json))
      .run();
  impl_->run_id = impl_->database->last_row();
}

void ResultsWriter::finish_run() {
  impl_->sql("UPDATE run SET finished_utc = ? WHERE run_id = ?")
      .bind(std::string_view(utc_now()))
      .bind(impl_->run_id)
      .run();
  impl_->publish();
}

std::int64_t ResultsWriter::model_id(const ModelRecord& model) {
  impl_->sql("INSERT INTO model VALUES(NULL, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING")
      .bind(std::string_view(model.spec))
      .bind(std::string_view(model.mesh_hash))
      .bind(std::string_view(model.layers_hash))
      .bind(static_cast<std::int64_t>(model.triangles))
      .bind(static_cast<std::int64_t>(model.layers))
      .bind(std::string_view(model.report_json))
      .bind(std::string_view(model.warnings_json))
      .run();
  Statement find =
      impl_->sql("SELECT model_id FROM model WHERE spec = ? AND mesh_hash = ? AND layers_hash = ?");
  find.bind(std::string_view(model.spec))
      .bind(std::string_view(model.mesh_hash))
      .bind(std::string_view(model.layers_hash));
  static_cast<void>(find.next());
  return find.integer(0);
}

std::int64_t ResultsWriter::contender_id(const ContenderRecord& contender) {
  impl_->sql("INSERT INTO contender VALUES(NULL, ?, ?, ?, ?) ON CONFLICT DO NOTHING")
      .bind(std::string_view(contender.name))
      .bind(std::string_view(contender.base_name))
      .bind(std::string_view(contender.variant_json))
      .bind(std::string_view(contender.variant_hash))
      .run();
  Statement find =
      impl_->sql("SELECT contender_id FROM contender WHERE name = ? AND variant_hash = ?");
  find.bind(std::string_view(contender.name)).bind(std::string_view(contender.variant_hash));
  static_cast<void>(find.next());
  return find.integer(0);
}

std::int64_t ResultsWriter::setting_id(const SettingRecord& setting) {
  // The label tells what varies in the config, which may have changed since.
  impl_
      ->sql(
          "INSERT INTO setting VALUES(NULL, ?, ?, ?, ?)"
          " ON CONFLICT(setting_hash) DO UPDATE SET label = excluded.label")
      .bind(std::string_view(setting.label))
      .bind(std::string_view(setting.task_json))
      .bind(std::string_view(setting.printer_json))
      .bind(std::string_view(setting.setting_hash))
      .run();
  Statement find = impl_->sql("SELECT setting_id FROM setting WHERE setting_hash = ?");
  find.bind(std::string_view(setting.setting_hash));
  static_cast<void>(find.next());
  return find.integer(0);
}

void ResultsWriter::add_layer_shape(std::int64_t model_id, const Layer& layer) {
  impl_->sql("INSERT INTO layer_shape VALUES(?, ?, ?, ?) ON CONFLICT DO NOTHING")
      .bind(model_id)
      .bind(std::int64_t{layer.index})
      .bind(layer.z_mm)
      .bind(std::string_view(wkt_of(layer)))
      .run();
}

void ResultsWriter::reuse_cell(std::int64_t cell_id) {
  impl_->sql("INSERT INTO run_cell VALUES(?, ?) ON CONFLICT DO NOTHING")
      .bind(impl_->run_id)
      .bind(cell_id)
      .run();
}

std::int64_t ResultsWriter::add_cell(const CellRecord& cell) {
  Transaction transaction(*impl_->database);
  impl_->drop_cell_at_limit(cell.cell_key);
  impl_->sql("INSERT INTO cell VALUES(NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(std::string_view(cell.cell_key))
      .bind(impl_->run_id)
      .bind(cell.model_id)
      .bind(cell.contender_id)
      .bind(cell.setting_id)
      .bind(static_cast<std::int64_t>(cell.seed))
      .bind(std::string_view(cell.plugin_hashes))
      .bind(to_string(cell.outcome))
      .bind(std::string_view(cell.reason))
      .bind(static_cast<std::int64_t>(cell.layers))
      .bind(cell.route_hash)
      .bind(std::string_view(cell.started_utc))
      .bind(cell.cell_wall_s)
      .run();
  const std::int64_t cell_id = impl_->database->last_row();
  reuse_cell(cell_id);
  impl_->add_scores(cell_id, cell.totals);
  impl_->add_layers(cell_id, cell.layer_scores);
  for (const RouteRecord& route : cell.routes)
    impl_->sql("INSERT INTO route VALUES(?, ?, ?)")
        .bind(cell_id)
        .bind(static_cast<std::int64_t>(route.layer_index))
        .bind(std::string_view(route.strokes_json))
        .run();
  if (cell.timing) impl_->add_sample(cell_id, *cell.timing);
  transaction.commit();
  impl_->publish();
  return cell_id;
}

void ResultsWriter::add_timing(std::int64_t cell_id, const TimingSample& sample) {
  Transaction transaction(*impl_->database);
  impl_->add_sample(cell_id, sample);
  transaction.commit();
}

void ResultsWriter::change_outcome(std::int64_t cell_id, Outcome outcome,
                                   const std::string& reason) {
  impl_->sql("UPDATE cell SET outcome = ?, reason = ? WHERE cell_id = ?")
      .bind(to_string(outcome))
      .bind(std::string_view(reason))
      .bind(cell_id)
      .run();
}

Database& ResultsWriter::database() noexcept { return *impl_->database; }

}  // namespace routebench
