#include "results_schema.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "routebench/geometry/error.hpp"
#include "routebench/harness/metrics.hpp"
#include "routebench/harness/results.hpp"

namespace routebench {
namespace {

constexpr const char* kTables = R"sql(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE metric(position INTEGER PRIMARY KEY, name TEXT UNIQUE NOT NULL, label TEXT NOT NULL,
  unit TEXT NOT NULL, better TEXT NOT NULL, total TEXT NOT NULL, meaning TEXT NOT NULL);
CREATE TABLE run(run_id INTEGER PRIMARY KEY, run_key TEXT NOT NULL UNIQUE, experiment TEXT NOT NULL,
  started_utc TEXT NOT NULL, finished_utc TEXT, seed INTEGER NOT NULL, config_text TEXT NOT NULL,
  config_resolved_json TEXT NOT NULL, config_file TEXT NOT NULL, working_folder TEXT NOT NULL,
  repair INTEGER NOT NULL, shard TEXT NOT NULL, command_line TEXT NOT NULL, routebench_version TEXT NOT NULL,
  git_commit TEXT, git_dirty INTEGER, compiler TEXT NOT NULL, compiler_flags TEXT NOT NULL,
  program_build_id TEXT NOT NULL, libraries_json TEXT NOT NULL, cpu TEXT NOT NULL, cores INTEGER NOT NULL,
  memory_bytes INTEGER NOT NULL, os TEXT NOT NULL, plugins_json TEXT NOT NULL);
CREATE TABLE model(model_id INTEGER PRIMARY KEY, spec TEXT NOT NULL, mesh_hash TEXT NOT NULL,
  layers_hash TEXT NOT NULL, triangles INTEGER NOT NULL, layers INTEGER NOT NULL,
  report_json TEXT NOT NULL, warnings_json TEXT NOT NULL, UNIQUE(spec, mesh_hash, layers_hash));
CREATE TABLE contender(contender_id INTEGER PRIMARY KEY, name TEXT NOT NULL,
  base_name TEXT NOT NULL, variant_json TEXT NOT NULL, variant_hash TEXT NOT NULL,
  UNIQUE(name, variant_hash));
CREATE TABLE setting(setting_id INTEGER PRIMARY KEY, label TEXT NOT NULL, task_json TEXT NOT NULL,
  printer_json TEXT NOT NULL, setting_hash TEXT NOT NULL UNIQUE);
CREATE TABLE cell(cell_id INTEGER PRIMARY KEY, cell_key TEXT NOT NULL UNIQUE,
  run_id INTEGER NOT NULL REFERENCES run, model_id INTEGER NOT NULL REFERENCES model,
  contender_id INTEGER NOT NULL REFERENCES contender,
  setting_id INTEGER NOT NULL REFERENCES setting, seed INTEGER NOT NULL,
  plugin_hashes TEXT NOT NULL, outcome TEXT NOT NULL, reason TEXT NOT NULL, layers INTEGER NOT NULL, route_hash TEXT, started_utc TEXT NOT NULL,
  cell_wall_s REAL NOT NULL);
CREATE TABLE run_cell(run_id INTEGER NOT NULL REFERENCES run,
  cell_id INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,
  PRIMARY KEY(run_id, cell_id)) WITHOUT ROWID;
CREATE VIEW current_cell AS SELECT * FROM cell WHERE cell_id IN
  (SELECT cell_id FROM run_cell WHERE run_id = (SELECT max(run_id) FROM run));
CREATE TABLE cell_score(cell_id INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,
  metric TEXT NOT NULL REFERENCES metric(name), value REAL,
  PRIMARY KEY(cell_id, metric)) WITHOUT ROWID;
CREATE TABLE timing_sample(cell_id INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,
  repetition INTEGER NOT NULL, run_id INTEGER NOT NULL REFERENCES run, plan_wall_ns INTEGER NOT NULL,
  plan_cpu_ns INTEGER NOT NULL, minor_faults INTEGER NOT NULL, major_faults INTEGER NOT NULL,
  peak_rss_bytes INTEGER NOT NULL,
  PRIMARY KEY(cell_id, repetition)) WITHOUT ROWID;
CREATE TABLE layer_shape(model_id INTEGER NOT NULL REFERENCES model, layer_index INTEGER NOT NULL,
  z_mm REAL NOT NULL, wkt TEXT NOT NULL, PRIMARY KEY(model_id, layer_index)) WITHOUT ROWID;
CREATE TABLE route(cell_id INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,
  layer_index INTEGER NOT NULL, strokes_json TEXT NOT NULL,
  PRIMARY KEY(cell_id, layer_index)) WITHOUT ROWID;
)sql";

std::string_view name_of(Better better) {
  switch (better) {
    case Better::kLower:
      return "lower";
    case Better::kHigher:
      return "higher";
    case Better::kNeither:
      break;
  }
  return "neither";
}

std::string_view name_of(Total total) {
  switch (total) {
    case Total::kSum:
      return "sum";
    case Total::kMax:
      return "max";
    case Total::kArea:
      return "area";
    case Total::kOutline:
      return "outline";
    case Total::kDemand:
      return "demand";
    case Total::kCell:
      break;
  }
  return "cell";
}

/// One column a metric, so that a curve over the layers is one plain query.
std::string layer_score_table() {
  std::string sql =
      "CREATE TABLE layer_score(cell_id INTEGER NOT NULL REFERENCES cell ON DELETE CASCADE,"
      " layer_index INTEGER NOT NULL, z_mm REAL NOT NULL, repaired INTEGER NOT NULL";
  for (const MetricInfo& metric : metric_table()) sql += ", " + std::string(metric.name) + " REAL";
  return sql + ", PRIMARY KEY(cell_id, layer_index)) WITHOUT ROWID";
}

void fill_metric_table(Database& database) {
  Statement insert(database, "INSERT INTO metric VALUES(?, ?, ?, ?, ?, ?, ?)");
  std::int64_t position = 0;
  for (const MetricInfo& metric : metric_table())
    insert.bind(position++)
        .bind(metric.name)
        .bind(metric.label)
        .bind(metric.unit)
        .bind(name_of(metric.better))
        .bind(name_of(metric.total))
        .bind(metric.meaning)
        .run();
}

std::string meta_value(Database& database, const char* key) {
  Statement tables(database, "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'meta'");
  if (!tables.next()) return {};
  Statement find(database, "SELECT value FROM meta WHERE key = ?");
  find.bind(std::string_view(key));
  return find.next() ? find.text(0) : std::string();
}

[[noreturn]] void refuse(const Database& database, const std::string& why) {
  throw Error(ErrorKind::kBadInput, database.file().string() + ": " + why);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

/// The metrics that come from timing samples.
constexpr std::array<std::string_view, 2> kTimeMetrics{"plan_wall_ns", "plan_cpu_ns"};

}  // namespace

void create_schema(Database& database, const std::string& experiment) {
  Transaction transaction(database);
  database.run(kTables);
  database.run(layer_score_table());
  fill_metric_table(database);
  Statement insert(database, "INSERT INTO meta VALUES(?, ?)");
  insert.bind(std::string_view("schema_version"))
      .bind(std::string_view(std::to_string(kResultsSchemaVersion)))
      .run();
  insert.bind(std::string_view("experiment")).bind(std::string_view(experiment)).run();
  transaction.commit();
}

std::string experiment_of(Database& database) { return meta_value(database, "experiment"); }

bool is_time_metric(std::string_view name) {
  return std::find(kTimeMetrics.begin(), kTimeMetrics.end(), name) != kTimeMetrics.end();
}

void update_plan_times(Database& database, std::int64_t cell_id) {
  for (const std::string_view metric : kTimeMetrics) {
    std::vector<double> samples;
    Statement select(database,
                     "SELECT " + std::string(metric) + " FROM timing_sample WHERE cell_id = ?");
    select.bind(cell_id);
    while (select.next()) samples.push_back(select.real(0));
    if (samples.empty()) continue;
    Statement(database, "INSERT OR REPLACE INTO cell_score VALUES(?, ?, ?)")
        .bind(cell_id)
        .bind(metric)
        .bind(median(std::move(samples)))
        .run();
  }
}

void require_experiment(Database& database, const std::string& experiment) {
  const std::string found = experiment_of(database);
  if (found.empty())
    refuse(database,
           "is a database, but none of routebench's results; give another folder with --out");
  if (found != experiment)
    refuse(database, "holds the results of the experiment " + found + ", not of " + experiment +
                         "; give another folder with --out");
}

void require_our_schema(Database& database) {
  const std::string version = meta_value(database, "schema_version");
  if (version.empty()) refuse(database, "is a database, but none of routebench's results");
  if (version != std::to_string(kResultsSchemaVersion))
    refuse(database, "has schema version " + version + ", but this program writes and reads " +
                         std::to_string(kResultsSchemaVersion) +
                         "; run with --fresh to start anew, or with --out for another folder");
  if (Statement(database, "PRAGMA foreign_key_check(cell)").next())
    refuse(database,
           "is damaged: a cell names a run, model, contender or setting that is not there");
  Statement names(database, "SELECT name FROM metric ORDER BY position");
  bool same = true;
  for (const MetricInfo& metric : metric_table())
    same = same && names.next() && names.text(0) == metric.name;
  if (!same || names.next())
    refuse(database,
           "was written by a program with other metrics; run with --fresh to start anew, or with "
           "--out for another folder");
}

}  // namespace routebench
