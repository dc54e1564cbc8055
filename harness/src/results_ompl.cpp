/// Results as OMPL's benchmarks store theirs. Source: the tables that OMPL's script
/// ompl_benchmark_statistics.py makes, and what Planner Arena asks of them.

#include <sqlite3.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "results_schema.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/results.hpp"
#include "sqlite.hpp"

namespace routebench {
namespace {

constexpr const char* kFileName = "benchmark.db";
constexpr const char* kStatus = "status";

/// A progress table must have best_cost for Planner Arena to open the file; nothing here has any.
constexpr const char* kTables = R"sql(
CREATE TABLE plannerConfigs(id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL,
  settings TEXT);
CREATE TABLE enums(name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY(name, value));
CREATE TABLE progress(runid INTEGER, time REAL, best_cost REAL, PRIMARY KEY(runid, time),
  FOREIGN KEY(runid) REFERENCES runs(id) ON DELETE CASCADE);
)sql";

/// Keys of task and printer that differ between the settings: the parameters of a problem. Planner
/// Arena takes every column of experiments after the twelfth for one.
struct Parameters {
  std::vector<std::string> names;
  std::map<std::int64_t, nlohmann::json> values;  ///< by setting
};

Parameters parameters_of(Database& source) {
  Parameters parameters;
  std::map<std::string, std::set<std::string>> seen;
  Statement settings(source,
                     "SELECT setting_id, task_json, printer_json FROM setting WHERE setting_id IN"
                     " (SELECT setting_id FROM current_cell)");
  while (settings.next()) {
    nlohmann::json& values = parameters.values[settings.integer(0)];
    values = nlohmann::json::object();
    for (const int column : {1, 2}) {
      const nlohmann::json keys = nlohmann::json::parse(settings.text(column));
      for (const auto& [key, value] : keys.items()) {
        values[key] = value;
        seen[key].insert(value.dump());
      }
    }
  }
  for (const auto& [key, values] : seen)
    if (values.size() > 1) parameters.names.push_back(key);
  return parameters;
}

void bind_json(Statement& statement, const nlohmann::json& value) {
  if (value.is_number())
    statement.bind(value.get<double>());
  else
    statement.bind(std::string_view(value.is_string() ? value.get<std::string>() : value.dump()));
}

class OmplExport {
 public:
  explicit OmplExport(Database& source)
      : source_(source),
        target_(":memory:", OpenMode::kCreate),
        parameters_(parameters_of(source)) {}

  /// The bytes of the file.
  [[nodiscard]] std::string make() {
    make_tables();
    Transaction transaction(target_);
    fill_enums();
    fill_planners();
    fill_experiments();
    fill_runs();
    transaction.commit();
    sqlite3_int64 size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
        sqlite3_serialize(target_.handle(), "main", &size, 0), sqlite3_free);
    if (!bytes) throw Error(ErrorKind::kInternal, "no memory for an exported database");
    return {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)};
  }

 private:
  using ProblemId = std::pair<std::int64_t, std::int64_t>;  ///< model and setting

  void make_tables() {
    std::string experiments =
        "CREATE TABLE experiments(id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512),"
        " totaltime REAL, timelimit REAL, memorylimit REAL, runcount INTEGER, version VARCHAR(128),"
        " hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME, seed VARCHAR(24), setup TEXT";
    for (const std::string& name : parameters_.names) {
      const bool number = parameters_.values.begin()->second.at(name).is_number();
      experiments += ", " + name + (number ? " REAL" : " VARCHAR(128)");
    }
    std::string runs =
        "CREATE TABLE runs(id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER,"
        " plannerid INTEGER, time REAL, cpu_time REAL, memory REAL, minor_faults INTEGER,"
        " major_faults INTEGER, solved BOOLEAN, correct_solution BOOLEAN, status ENUM,"
        " seed INTEGER, repetition INTEGER";
    for (const MetricInfo& metric : metric_table())
      if (is_deterministic(metric.name)) runs += ", " + std::string(metric.name) + " REAL";
    runs +=
        ", FOREIGN KEY(experimentid) REFERENCES experiments(id) ON DELETE CASCADE,"
        " FOREIGN KEY(plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE)";
    target_.run(experiments + ")");
    target_.run(runs);
    target_.run(kTables);
  }

  void fill_enums() {
    Statement outcomes(source_,
                       "SELECT outcome FROM (SELECT 'valid' AS outcome UNION"
                       " SELECT outcome FROM current_cell) ORDER BY outcome <> 'valid', outcome");
    Statement insert(target_, "INSERT INTO enums VALUES(?, ?, ?)");
    for (std::int64_t value = 0; outcomes.next(); ++value) {
      outcome_values_[outcomes.text(0)] = value;
      insert.bind(std::string_view(kStatus))
          .bind(value)
          .bind(std::string_view(outcomes.text(0)))
          .run();
    }
  }

  void fill_planners() {
    Statement contenders(source_,
                         "SELECT contender_id, name, variant_json FROM contender WHERE contender_id"
                         " IN (SELECT contender_id FROM current_cell) ORDER BY contender_id");
    Statement insert(target_, "INSERT INTO plannerConfigs VALUES(?, ?, ?)");
    while (contenders.next())
      insert.bind(contenders.integer(0))
          .bind(std::string_view(contenders.text(1)))
          .bind(std::string_view(contenders.text(2)))
          .run();
  }

  void fill_experiments() {
    Statement problems(
        source_,
        "SELECT model_id, setting_id, spec, sum(cell_wall_s),"
        " max(json_extract(config_resolved_json, '$.run.timeout_s')),"
        " max(json_extract(config_resolved_json, '$.run.memory_mb')),"
        " count(DISTINCT current_cell.seed), routebench_version, cpu, "
        "min(current_cell.started_utc),"
        " min(current_cell.seed), task_json, printer_json, report_json"
        " FROM current_cell JOIN model USING(model_id) JOIN setting USING(setting_id)"
        " JOIN run USING(run_id) GROUP BY setting_id, model_id ORDER BY setting_id, model_id");
    std::string values = "INSERT INTO experiments VALUES(NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?";
    for (std::size_t i = 0; i < parameters_.names.size(); ++i) values += ", ?";
    Statement insert(target_, values + ")");
    while (problems.next()) {
      const std::string setup = "{\"task\": " + problems.text(11) +
                                ", \"printer\": " + problems.text(12) +
                                ", \"model\": " + problems.text(13) + "}";
      insert.bind(std::string_view(problems.text(2)))
          .bind(problems.real(3))
          .bind(problems.real(4))
          .bind(problems.real(5))
          .bind(problems.integer(6))
          .bind(std::string_view("routebench " + problems.text(7)))
          .bind(std::string_view(""))
          .bind(std::string_view(problems.text(8)))
          .bind(std::string_view(problems.text(9)))
          .bind(std::string_view(problems.text(10)))
          .bind(std::string_view(setup));
      for (const std::string& name : parameters_.names)
        bind_json(insert, parameters_.values.at(problems.integer(1)).at(name));
      insert.run();
      experiments_[{problems.integer(0), problems.integer(1)}] = target_.last_row();
    }
  }

  /// The columns of one cell that are the same in every repetition, in the order of the table.
  Scores scores_of(std::int64_t cell_id) {
    Scores scores(metric_table().size());
    Statement select(source_,
                     "SELECT position, value FROM cell_score JOIN metric ON metric = name"
                     " WHERE cell_id = ? AND value IS NOT NULL");
    select.bind(cell_id);
    while (select.next()) scores.at(static_cast<std::size_t>(select.integer(0))) = select.real(1);
    return scores;
  }

  void fill_runs() {
    std::string values = "INSERT INTO runs VALUES(NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?";
    for (const MetricInfo& metric : metric_table())
      if (is_deterministic(metric.name)) values += ", ?";
    Statement insert(target_, values + ")");
    Statement cells(source_,
                    "SELECT cell_id, model_id, setting_id, contender_id, seed, outcome, repetition,"
                    " plan_wall_ns / 1e9, plan_cpu_ns / 1e9, peak_rss_bytes / 1048576.0,"
                    " minor_faults, major_faults FROM current_cell LEFT JOIN timing_sample"
                    " USING(cell_id) ORDER BY setting_id, model_id, contender_id, seed, cell_id,"
                    " repetition");
    std::int64_t scored = 0;
    Scores scores;
    while (cells.next()) {
      if (cells.integer(0) != scored) {
        scored = cells.integer(0);
        scores = scores_of(scored);
      }
      // What did not do its task has no place in a mean: its status is all that is told.
      const bool valid = cells.text(5) == to_string(Outcome::kValid);
      const bool routed = valid || cells.text(5) == to_string(Outcome::kOffTask);
      const auto measured = [&](int column) {
        return valid && !cells.is_null(column) ? std::optional(cells.real(column)) : std::nullopt;
      };
      insert.bind(experiments_.at({cells.integer(1), cells.integer(2)}))
          .bind(cells.integer(3))
          .bind(measured(7))
          .bind(measured(8))
          .bind(measured(9));
      for (const int column : {10, 11})
        valid && !cells.is_null(column) ? insert.bind(cells.integer(column)) : insert.bind_null();
      insert.bind(std::int64_t{routed})
          .bind(std::int64_t{valid})
          .bind(outcome_values_.at(cells.text(5)))
          .bind(cells.integer(4));
      cells.is_null(6) ? insert.bind_null() : insert.bind(cells.integer(6));
      for (std::size_t i = 0; i < metric_table().size(); ++i)
        if (is_deterministic(metric_table()[i].name))
          insert.bind(valid ? scores.at(i) : std::nullopt);
      insert.run();
    }
  }

  Database& source_;
  Database target_;
  Parameters parameters_;
  std::map<std::string, std::int64_t> outcome_values_;
  std::map<ProblemId, std::int64_t> experiments_;
};

}  // namespace

std::filesystem::path export_ompl(const std::filesystem::path& file,
                                  const std::filesystem::path& folder) {
  Database database(file, OpenMode::kReadOnly);
  require_our_schema(database);
  const Transaction snapshot(database, Transaction::Kind::kRead);
  OutputSet outputs;
  outputs.add_folder(folder);
  const std::filesystem::path written = folder / kFileName;
  const std::string bytes = OmplExport(database).make();
  outputs.add(written, [&](std::ostream& out) {
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  });
  outputs.commit();
  return written;
}

}  // namespace routebench
