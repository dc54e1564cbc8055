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

KnownCells read_known_cells(Database& database) {
  KnownCells cells;
  // A run's JSON is read once, not once a cell.
  Statement select(database,
                   "WITH origin AS MATERIALIZED (SELECT run_id,"
                   " json_extract(config_resolved_json, '$.run.timeout_s') AS timeout_s,"
                   " json_extract(config_resolved_json, '$.run.memory_mb') AS memory_mb,"
                   " program_build_id AS build_id FROM run)"
                   " SELECT cell_key, cell_id, outcome, route_hash, cell_wall_s, timeout_s,"
                   " memory_mb, build_id, cell_id IN (SELECT cell_id FROM current_cell)"
                   " FROM cell JOIN origin USING(run_id)");
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

std::vector<StoredCell> current_cells(const fs::path& file) {
  Database database(file, OpenMode::kReadOnly);
  require_our_schema(database);
  std::vector<StoredCell> cells;
  Statement select(
      database,
      "SELECT cell_id, spec, contender.name, label, seed, outcome, reason, current_cell.layers"
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
                    Scores(metric_table().size())};
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
