/// Joining databases: every row of the parts goes into the new file, with ids of its own.

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "results_schema.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/results.hpp"
#include "sqlite.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNamed = 5;

struct Part {
  fs::path file;
  LastRun last;
};

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw Error(ErrorKind::kBadInput, file.string() + ": " + why);
}

/// What a config asks for, without what changes no score and without where plugins lie.
nlohmann::json asked_for(const Part& part) {
  nlohmann::json config =
      nlohmann::json::parse(part.last.record.config_resolved_json, nullptr, false);
  if (config.is_object())
    for (const char* key : {"run", "plugins"}) config.erase(key);
  return config;
}

void require_same_experiment(const std::vector<Part>& parts) {
  std::set<fs::path> files;
  for (const Part& part : parts) {
    if (!files.insert(fs::weakly_canonical(part.file)).second) refuse(part.file, "is named twice");
    const std::string& experiment = part.last.record.experiment;
    const std::string& first = parts.front().last.record.experiment;
    if (experiment != first)
      refuse(part.file, "holds the results of the experiment " + experiment + ", but " +
                            parts.front().file.string() + " those of " + first +
                            "; only parts of one can be merged");
    if (asked_for(part) != asked_for(parts.front()))
      refuse(part.file, "its last run had another config than that of " +
                            parts.front().file.string() +
                            "; run both with the same, which executes only what has changed");
  }
}

/// The columns of a table but for one, with commas between them and after them.
std::string columns_but(Database& database, const std::string& table, const std::string& left_out) {
  Statement info(database, "SELECT name FROM pragma_table_info(?)");
  info.bind(std::string_view(table));
  std::string columns;
  while (info.next())
    if (info.text(0) != left_out) columns += info.text(0) + ", ";
  return columns;
}

std::string without_last_comma(std::string list) {
  list.resize(list.size() - 2);
  return list;
}

/// Brings one part into the new database.
class Absorption {
 public:
  /// Opens the part beside the new database, for as long as this lives.
  Absorption(Database& database, const fs::path& part) : database_(database), part_(part) {
    Statement(database_, "ATTACH ? AS part").bind(std::string_view(part.string())).run();
  }
  ~Absorption() {
    try {
      for (const char* map : {"run_map", "model_map", "contender_map", "setting_map", "cell_map"})
        database_.run(std::string("DROP TABLE IF EXISTS temp.") + map);
      database_.run("DETACH part");
    } catch (const Error&) {
      // The transaction was undone; the database closes soon.
    }
  }
  Absorption(const Absorption&) = delete;
  Absorption& operator=(const Absorption&) = delete;

  void run() {
    add_rows("run", "run_key");
    add_rows("model", "spec, mesh_hash, layers_hash");
    add_rows("contender", "name, variant_hash");
    add_rows("setting", "setting_hash");
    database_.run(
        "UPDATE main.run SET finished_utc = coalesce(finished_utc, (SELECT finished_utc FROM"
        " part.run WHERE part.run.run_key = main.run.run_key))");
    require_no_conflict();
    set_aside_cells_at_limits();
    add_cells();
    add_what_belongs_to_cells();
    database_.run(
        "INSERT OR IGNORE INTO temp.current_of_parts SELECT new_id FROM part.current_cell"
        " JOIN temp.cell_map ON old_id = cell_id");
  }

 private:
  /// Adds the rows of a table that are not there yet, and notes which row has become which.
  void add_rows(const std::string& table, const std::string& key) {
    const std::string id = table + "_id";
    const std::string columns = without_last_comma(columns_but(database_, table, id));
    database_.run("INSERT OR IGNORE INTO main." + table + "(" + columns + ") SELECT " + columns +
                  " FROM part." + table + " ORDER BY " + id);
    database_.run("CREATE TEMP TABLE " + table + "_map AS SELECT old." + id + " AS old_id, new." +
                  id + " AS new_id FROM part." + table + " AS old JOIN main." + table +
                  " AS new USING(" + key + ")");
    database_.run("CREATE UNIQUE INDEX temp." + table + "_old ON " + table + "_map(old_id)");
  }

  /// Throws for cells that are the same by their key but not by what came of them.
  void require_no_conflict() {
    std::string measured;
    for (const MetricInfo& metric : metric_table())
      if (!is_deterministic(metric.name))
        measured += (measured.empty() ? "'" : ", '") + std::string(metric.name) + "'";
    const auto scores_of = [&](const std::string& schema, const std::string& alias) {
      return "(SELECT group_concat(metric || '=' || quote(value)) FROM (SELECT metric, value "
             "FROM " +
             schema + ".cell_score WHERE cell_id = " + alias + ".cell_id AND metric NOT IN (" +
             measured + ") ORDER BY metric))";
    };
    Statement select(
        database_,
        "SELECT spec, contender.name, label, old.seed, old.outcome, new.outcome,"
        " old.route_hash IS NOT new.route_hash"
        " FROM part.cell AS old JOIN main.cell AS new USING(cell_key)"
        " JOIN main.model ON main.model.model_id = new.model_id"
        " JOIN main.contender ON main.contender.contender_id = new.contender_id"
        " JOIN main.setting ON main.setting.setting_id = new.setting_id"
        " WHERE old.outcome NOT IN ('timed_out', 'out_of_memory')"
        " AND new.outcome NOT IN ('timed_out', 'out_of_memory')"
        " AND (old.outcome <> new.outcome OR old.route_hash IS NOT new.route_hash OR " +
            scores_of("part", "old") + " IS NOT " + scores_of("main", "new") + ")");
    std::string names;
    std::size_t count = 0;
    while (select.next()) {
      if (++count > kMostNamed) continue;
      names += (names.empty() ? "" : "; ") + select.text(0) + " · " + select.text(1);
      if (!select.text(2).empty()) names += " · " + select.text(2);
      names += " · seed " + select.text(3);
      if (select.text(4) != select.text(5))
        names += " (" + select.text(4) + " here, " + select.text(5) + " there)";
      else
        names += select.integer(6) != 0 ? " (another route)" : " (other scores)";
    }
    if (count == 0) return;
    if (count > kMostNamed) names += "; and " + std::to_string(count - kMostNamed) + " more";
    refuse(part_, "not merged: cells that a part before it holds, too, came out otherwise there: " +
                      names);
  }

  /// A cell that ran into a limit gives way to one that did not. What referred to it will refer to
  /// the other.
  void set_aside_cells_at_limits() {
    database_.run(
        "UPDATE main.cell SET cell_key = cell_key || ' at limit' WHERE outcome IN"
        " ('timed_out', 'out_of_memory') AND cell_key IN (SELECT cell_key FROM part.cell WHERE"
        " outcome NOT IN ('timed_out', 'out_of_memory'))");
  }

  void add_cells() {
    database_.run("CREATE TEMP TABLE cell_map(old_id INTEGER PRIMARY KEY, new_id, is_new)");
    const std::int64_t last = scalar("SELECT coalesce(max(cell_id), 0) FROM main.cell");
    std::string columns = columns_but(database_, "cell", "cell_id");
    columns = without_last_comma(columns);
    std::string values = columns;
    for (const char* table : {"run", "model", "contender", "setting"}) {
      const std::string id = std::string(table) + "_id";
      replace(values, id, std::string(table) + "_map.new_id");
    }
    std::string joins;
    for (const char* table : {"run", "model", "contender", "setting"})
      joins += " JOIN temp." + std::string(table) + "_map ON " + table + "_map.old_id = cell." +
               table + "_id";
    database_.run("INSERT INTO main.cell(" + columns + ") SELECT " + values + " FROM part.cell" +
                  joins +
                  " WHERE cell_key NOT IN (SELECT cell_key FROM main.cell) ORDER BY cell.cell_id");
    database_.run("INSERT INTO temp.cell_map SELECT old.cell_id, new.cell_id, new.cell_id > " +
                  std::to_string(last) +
                  " FROM part.cell AS old JOIN main.cell AS new USING(cell_key)");
    for (const char* refers : {"main.run_cell", "temp.current_of_parts"})
      database_.run(std::string("UPDATE OR IGNORE ") + refers +
                    " SET cell_id = (SELECT new.cell_id FROM main.cell AS old JOIN main.cell AS new"
                    " ON old.cell_key = new.cell_key || ' at limit' WHERE old.cell_id = " +
                    refers +
                    ".cell_id) WHERE cell_id IN (SELECT cell_id FROM main.cell WHERE cell_key LIKE"
                    " '% at limit')");
    database_.run(
        "DELETE FROM temp.current_of_parts WHERE cell_id IN (SELECT cell_id FROM main.cell"
        " WHERE cell_key LIKE '% at limit');"
        "DELETE FROM main.cell WHERE cell_key LIKE '% at limit'");
  }

  void add_what_belongs_to_cells() {
    for (const std::string table : {"cell_score", "layer_score"}) copy(table, "WHERE is_new");
    copy("route", "");
    const std::string sample = without_last_comma(columns_but(database_, "timing_sample", ""));
    std::string values = sample;
    replace(values, "cell_id", "cell_map.new_id");
    replace(values, "run_id", "run_map.new_id");
    const std::string from =
        " FROM part.timing_sample JOIN temp.cell_map ON cell_map.old_id = cell_id"
        " JOIN temp.run_map ON run_map.old_id = timing_sample.run_id";
    database_.run("INSERT INTO main.timing_sample(" + sample + ") SELECT " + values + from +
                  " WHERE is_new");
    add_samples_of_shared_cells();
    database_.run(
        "INSERT OR IGNORE INTO main.layer_shape SELECT new_id, layer_index, z_mm, wkt"
        " FROM part.layer_shape JOIN temp.model_map ON old_id = model_id;"
        "INSERT OR IGNORE INTO main.run_cell SELECT run_map.new_id, cell_map.new_id"
        " FROM part.run_cell JOIN temp.run_map ON run_map.old_id = run_id"
        " JOIN temp.cell_map ON cell_map.old_id = cell_id");
  }

  void copy(const std::string& table, const std::string& where) {
    const std::string others = without_last_comma(columns_but(database_, table, "cell_id"));
    database_.run("INSERT OR IGNORE INTO main." + table + "(cell_id, " + others +
                  ") SELECT new_id, " + others + " FROM part." + table +
                  " JOIN temp.cell_map ON old_id = cell_id " + where);
  }

  /// A sample that is there already came here by another way. Any other one is kept under its own
  /// number or, where that is taken, under the next one that is free.
  void add_samples_of_shared_cells() {
    const std::string numbers =
        "plan_wall_ns, plan_cpu_ns, minor_faults, major_faults, "
        "peak_rss_bytes";
    Statement select(database_, "SELECT cell_map.new_id, repetition, run_map.new_id, " + numbers +
                                    " FROM part.timing_sample"
                                    " JOIN temp.cell_map ON cell_map.old_id = cell_id"
                                    " JOIN temp.run_map ON run_map.old_id = timing_sample.run_id"
                                    " WHERE NOT is_new ORDER BY 1, 2");
    Statement same(database_,
                   "SELECT 1 FROM main.timing_sample WHERE cell_id = ? AND run_id = ? AND"
                   " plan_wall_ns = ? AND plan_cpu_ns = ? AND minor_faults = ? AND major_faults = ?"
                   " AND peak_rss_bytes = ?");
    Statement taken(database_,
                    "SELECT max(repetition), sum(repetition = ?) FROM main.timing_sample"
                    " WHERE cell_id = ?");
    Statement insert(database_, "INSERT INTO main.timing_sample(cell_id, run_id, " + numbers +
                                    ", repetition) VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
    std::set<std::int64_t> changed;
    while (select.next()) {
      const std::int64_t cell = select.integer(0);
      const auto bind = [&](Statement& statement) {
        for (const int column : {0, 2, 3, 4, 5, 6, 7}) statement.bind(select.integer(column));
      };
      bind(same);
      const bool is_there = same.next();
      same.reset();
      if (is_there) continue;
      taken.bind(select.integer(1)).bind(cell);
      static_cast<void>(taken.next());
      const bool is_free = taken.is_null(0) || taken.integer(1) == 0;
      const std::int64_t repetition = is_free ? select.integer(1) : taken.integer(0) + 1;
      taken.reset();
      bind(insert);
      insert.bind(repetition).run();
      changed.insert(cell);
    }
    for (const std::int64_t cell : changed) update_plan_times(database_, cell);
  }

  static void replace(std::string& columns, const std::string& column, const std::string& with) {
    // Columns are words between ", ".
    const std::string padded = ", " + columns + ", ";
    const std::size_t at = padded.find(", " + column + ", ");
    columns.replace(at, column.size(), with);
  }

  [[nodiscard]] std::int64_t scalar(const std::string& sql) {
    Statement select(database_, sql);
    static_cast<void>(select.next());
    return select.integer(0);
  }

  Database& database_;
  fs::path part_;
};

/// What people should know before they trust the whole.
std::vector<std::string> remarks_on(const std::vector<Part>& parts) {
  std::vector<std::string> remarks;
  std::map<std::size_t, std::set<std::size_t>> shards;  // numbers by count
  bool all_shards = true;
  for (const Part& part : parts) {
    if (!part.last.finished)
      remarks.push_back(part.file.string() +
                        ": its last run is not finished; the same command goes on with it");
    const std::string& shard = part.last.record.shard;
    const std::size_t slash = shard.find('/');
    if (slash == std::string::npos)
      all_shards = false;
    else
      shards[std::stoul(shard.substr(slash + 1))].insert(std::stoul(shard.substr(0, slash)));
  }
  if (!all_shards || shards.size() != 1) return remarks;
  const auto& [count, numbers] = *shards.begin();
  for (std::size_t number = 1; number <= count; ++number)
    if (!numbers.contains(number))
      remarks.push_back("shard " + std::to_string(number) + "/" + std::to_string(count) +
                        " is missing");
  return remarks;
}

}  // namespace

MergeSummary merge_results(const fs::path& out, const std::vector<fs::path>& parts, bool replace,
                           const std::string& command_line) {
  std::vector<Part> read;
  for (const fs::path& part : parts) {
    const fs::path file = results_file(part);
    read.push_back({file, last_run(file)});
  }
  require_same_experiment(read);
  std::error_code error;
  if (!replace && fs::exists(out / kResultsFileName, error))
    refuse(out / kResultsFileName,
           "is there already; give another folder, or --fresh to replace it");

  ResultsWriter writer(out, read.front().last.record.experiment,
                       replace ? ResultsWriter::Start::kFresh : ResultsWriter::Start::kResume);
  Database& database = writer.database();
  database.run("CREATE TEMP TABLE current_of_parts(cell_id INTEGER PRIMARY KEY)");
  for (const Part& part : read) {
    Absorption absorption(database, part.file);
    writer.together([&] { absorption.run(); });
  }
  MergeSummary summary;
  writer.together([&] {
    RunRecord record = read.front().last.record;
    record.shard.clear();
    record.command_line = command_line;
    record.provenance = collect_provenance();
    writer.begin_run(record);
    database.run(
        "INSERT INTO run_cell SELECT (SELECT max(run_id) FROM run), cell_id"
        " FROM temp.current_of_parts");
    Statement count(database, "SELECT count(*) FROM temp.current_of_parts");
    static_cast<void>(count.next());
    summary.cells = static_cast<std::size_t>(count.integer(0));
  });
  writer.finish_run();
  summary.file = writer.file();
  summary.remarks = remarks_on(read);
  return summary;
}

}  // namespace routebench
