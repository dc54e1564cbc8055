#include "results_read.hpp"

#include <system_error>

#include "results_schema.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench {

namespace fs = std::filesystem;

Outcome outcome_named(const std::string& name) {
  for (const Outcome outcome : outcomes())
    if (to_string(outcome) == name) return outcome;
  throw Error(ErrorKind::kBadInput, "a results database has the unknown outcome '" + name + "'");
}

fs::path results_file(const fs::path& folder_or_file) {
  std::error_code error;
  const fs::file_status status = fs::status(folder_or_file, error);
  if (!fs::exists(status))
    throw Error(ErrorKind::kBadInput, folder_or_file.string() +
                                          ": no such file or folder; give a folder that routebench "
                                          "run has made, or the database in it");
  if (!fs::is_directory(status)) return folder_or_file;
  const fs::path file = folder_or_file / kResultsFileName;
  if (!fs::exists(file, error))
    throw Error(ErrorKind::kBadInput, folder_or_file.string() + ": holds no " + kResultsFileName +
                                          "; give a folder that routebench run has made");
  return file;
}

namespace {

/// The rows of a table that cells refer to, each as one record that they share.
template <typename Record, typename Read>
std::map<std::int64_t, std::shared_ptr<const Record>> shared_rows(Database& database,
                                                                  std::string_view columns,
                                                                  const Read& read) {
  std::map<std::int64_t, std::shared_ptr<const Record>> rows;
  Statement select(database, columns);
  while (select.next()) rows[select.integer(0)] = std::make_shared<const Record>(read(select));
  return rows;
}

}  // namespace

KnownCells read_known_cells(Database& database) {
  KnownCells cells;
  const auto models = shared_rows<ModelRecord>(
      database, "SELECT model_id, spec, mesh_hash, layers_hash, triangles, layers FROM model",
      [](const Statement& row) {
        return ModelRecord{row.text(1),
                           row.text(2),
                           row.text(3),
                           static_cast<std::size_t>(row.integer(4)),
                           static_cast<std::size_t>(row.integer(5)),
                           "",
                           ""};
      });
  const auto contenders = shared_rows<ContenderRecord>(
      database, "SELECT contender_id, name, base_name, variant_json, variant_hash FROM contender",
      [](const Statement& row) {
        return ContenderRecord{row.text(1), row.text(2), row.text(3), row.text(4)};
      });
  const auto settings = shared_rows<SettingRecord>(
      database, "SELECT setting_id, label, task_json, printer_json, setting_hash FROM setting",
      [](const Statement& row) {
        return SettingRecord{row.text(1), row.text(2), row.text(3), row.text(4)};
      });
  // A run's JSON is read once, not once a cell.
  Statement select(
      database,
      "WITH origin AS MATERIALIZED (SELECT run_id,"
      " json_extract(config_resolved_json, '$.run.timeout_s') AS timeout_s,"
      " json_extract(config_resolved_json, '$.run.memory_mb') AS memory_mb,"
      " program_build_id AS build_id FROM run)"
      " SELECT cell_key, cell.cell_id, outcome, route_hash, cell_wall_s, timeout_s,"
      " memory_mb, build_id, cell.cell_id IN (SELECT cell_id FROM current_cell), model_id,"
      " contender_id, setting_id, seed, plugin_hashes, value / 1e9"
      " FROM cell JOIN origin USING(run_id) LEFT JOIN cell_score"
      " ON cell_score.cell_id = cell.cell_id AND metric = 'plan_wall_ns'");
  Statement samples(database,
                    "SELECT repetition FROM timing_sample WHERE cell_id = ? ORDER BY repetition");
  while (select.next()) {
    KnownCell& cell = cells[select.text(0)];
    cell.cell_id = select.integer(1);
    cell.outcome = outcome_named(select.text(2));
    if (!select.is_null(3)) cell.route_hash = select.text(3);
    cell.cell_wall_s = select.real(4);
    cell.timeout_s = select.real(5);
    cell.memory_mb = static_cast<int>(select.integer(6));
    cell.program_build_id = select.text(7);
    cell.current = select.integer(8) != 0;
    cell.model = models.at(select.integer(9));
    cell.contender = contenders.at(select.integer(10));
    cell.setting = settings.at(select.integer(11));
    cell.seed = static_cast<std::uint64_t>(select.integer(12));
    cell.plugin_hashes = select.text(13);
    if (!select.is_null(14)) cell.plan_wall_s = select.real(14);
    samples.bind(cell.cell_id);
    while (samples.next()) cell.repetitions.push_back(static_cast<int>(samples.integer(0)));
    samples.reset();
  }
  return cells;
}

KnownCells known_cells(const fs::path& folder, const std::string& experiment) {
  const fs::path file = folder / kResultsFileName;
  std::error_code error;
  if (!fs::exists(file, error)) return {};
  Database database(file, OpenMode::kReadOnly);
  require_experiment(database, experiment);
  require_our_schema(database);
  return read_known_cells(database);
}

LastRun last_run(const fs::path& file) {
  Database database(file, OpenMode::kReadOnly);
  require_our_schema(database);
  Statement run(database,
                "SELECT experiment, seed, config_text, config_resolved_json, config_file,"
                " working_folder, repair, shard, command_line, plugins_json, routebench_version,"
                " git_commit, git_dirty, program_build_id, compiler, compiler_flags,"
                " libraries_json, cpu, cores, memory_bytes, os, finished_utc FROM run"
                " ORDER BY run_id DESC LIMIT 1");
  if (!run.next()) throw Error(ErrorKind::kBadInput, file.string() + ": holds no run");
  LastRun last;
  RunRecord& record = last.record;
  record.experiment = run.text(0);
  record.seed = static_cast<std::uint64_t>(run.integer(1));
  record.config_text = run.text(2);
  record.config_resolved_json = run.text(3);
  record.config_file = run.text(4);
  record.working_folder = run.text(5);
  record.repair = run.integer(6) != 0;
  record.shard = run.text(7);
  record.command_line = run.text(8);
  record.plugins_json = run.text(9);
  Provenance& from = record.provenance;
  from.routebench_version = run.text(10);
  if (!run.is_null(11)) from.git_commit = run.text(11);
  if (!run.is_null(12)) from.git_dirty = run.integer(12) != 0;
  from.program_build_id = run.text(13);
  from.compiler = run.text(14);
  from.compiler_flags = run.text(15);
  from.libraries_json = run.text(16);
  from.cpu = run.text(17);
  from.cores = static_cast<int>(run.integer(18));
  from.memory_bytes = run.integer(19);
  from.os = run.text(20);
  last.finished = !run.is_null(21);
  return last;
}

std::vector<StoredCell> current_cells(const fs::path& file) {
  Database database(file, OpenMode::kReadOnly);
  require_our_schema(database);
  std::vector<StoredCell> cells;
  Statement select(
      database,
      "SELECT cell_id, spec, contender.name, label, seed, outcome, reason, current_cell.layers,"
      " layers_hash, plugin_hashes, route_hash"
      " FROM current_cell JOIN model USING(model_id) JOIN contender USING(contender_id)"
      " JOIN setting USING(setting_id)"
      " ORDER BY setting_id, model_id, seed, contender_id");
  Statement scores(
      database,
      "SELECT position, value FROM cell_score JOIN metric ON metric = name WHERE cell_id = ?");
  while (select.next()) {
    StoredCell cell{select.text(1),
                    select.text(2),
                    select.text(3),
                    static_cast<std::uint64_t>(select.integer(4)),
                    outcome_named(select.text(5)),
                    select.text(6),
                    static_cast<std::size_t>(select.integer(7)),
                    Scores(metric_table().size()),
                    select.text(8),
                    select.text(9),
                    std::nullopt};
    if (!select.is_null(10)) cell.route_hash = select.text(10);
    scores.bind(select.integer(0));
    while (scores.next())
      if (!scores.is_null(1))
        cell.totals.at(static_cast<std::size_t>(scores.integer(0))) = scores.real(1);
    scores.reset();
    cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace routebench
