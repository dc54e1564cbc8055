#include <array>
#include <charconv>
#include <ostream>

#include "results_schema.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/results.hpp"
#include "sqlite.hpp"

namespace routebench {
namespace {

/// One file of the export.
struct CsvFile {
  const char* name;
  std::string query;
};

/// What tells a cell from the others, as the first columns of every table about cells.
constexpr const char* kCellColumns =
    "run.experiment AS experiment, spec AS model, contender.name AS contender, setting.label AS "
    "setting, "
    "current_cell.seed AS seed, outcome";
constexpr const char* kCellTables =
    " FROM current_cell JOIN run USING(run_id) JOIN model USING(model_id)"
    " JOIN contender USING(contender_id) JOIN setting USING(setting_id)";
constexpr const char* kCellOrder =
    " ORDER BY setting_id, model_id, current_cell.seed, contender_id";

/// A query about cells: `columns` after those that name the cell, from `tables` joined to it.
std::string about_cells(const std::string& columns, const std::string& tables,
                        const std::string& order = "") {
  return std::string("SELECT ") + kCellColumns + ", " + columns + kCellTables + tables +
         kCellOrder + order;
}

std::string metric_columns() {
  std::string columns;
  for (const MetricInfo& metric : metric_table()) columns += ", " + std::string(metric.name);
  return columns;
}

std::vector<CsvFile> csv_files() {
  return {
      {"cells.csv",
       about_cells(
           "reason, current_cell.layers AS layers, route_hash, metric.name AS metric, value,"
           " unit, better",
           " CROSS JOIN metric LEFT JOIN cell_score ON"
           " cell_score.cell_id = current_cell.cell_id AND cell_score.metric = metric.name",
           ", position")},
      {"layers.csv", about_cells("layer_index, z_mm, repaired" + metric_columns(),
                                 " JOIN layer_score USING(cell_id)", ", layer_index")},
      {"timings.csv",
       about_cells("repetition, plan_wall_ns, plan_cpu_ns, minor_faults, major_faults,"
                   " peak_rss_bytes, taken.started_utc AS run_started_utc,"
                   " taken.cpu AS cpu",
                   " JOIN timing_sample USING(cell_id)"
                   " JOIN run AS taken ON taken.run_id = timing_sample.run_id",
                   ", repetition")},
      {"models.csv", "SELECT * FROM model ORDER BY model_id"},
      {"contenders.csv", "SELECT * FROM contender ORDER BY contender_id"},
      {"settings.csv", "SELECT * FROM setting ORDER BY setting_id"},
      {"runs.csv", "SELECT * FROM run ORDER BY run_id"},
      {"metrics.csv", "SELECT * FROM metric ORDER BY position"},
  };
}

/// Quotes a field that holds a separator, a quote or a line break (RFC 4180).
std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string result = "\"";
  for (const char c : field) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

/// A value with every digit that tells it from its neighbours; nothing for NULL.
std::string field_of(const Statement& row, int column) {
  if (row.is_null(column)) return {};
  if (!row.is_real(column)) return quoted(row.text(column));
  std::array<char, 32> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), row.real(column)).ptr;
  return {digits.data(), end};
}

void write_csv(std::ostream& out, Database& database, const std::string& query) {
  Statement rows(database, query);
  for (int i = 0; i < rows.columns(); ++i)
    out << (i == 0 ? "" : ",") << quoted(rows.column_name(i));
  out << "\r\n";
  while (rows.next()) {
    for (int i = 0; i < rows.columns(); ++i) out << (i == 0 ? "" : ",") << field_of(rows, i);
    out << "\r\n";
  }
}

}  // namespace

std::vector<std::filesystem::path> export_csv(const std::filesystem::path& file,
                                              const std::filesystem::path& folder) {
  Database database(file, OpenMode::kReadOnly);
  require_our_schema(database);
  // One snapshot for all files, even while a run goes on writing.
  const Transaction snapshot(database, Transaction::Kind::kRead);
  OutputSet outputs;
  outputs.add_folder(folder);
  std::vector<std::filesystem::path> written;
  for (const CsvFile& csv : csv_files()) {
    written.push_back(folder / csv.name);
    outputs.add(written.back(), [&](std::ostream& out) { write_csv(out, database, csv.query); });
  }
  outputs.commit();
  return written;
}

}  // namespace routebench
