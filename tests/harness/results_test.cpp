#include "routebench/harness/results.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "routebench/geometry/error.hpp"
#include "scratch_dir.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::ScratchDir;
using Start = ResultsWriter::Start;

RunRecord run_record(double timeout_s = 120) {
  RunRecord run;
  run.experiment = "t";
  run.config_resolved_json =
      "{\"run\": {\"timeout_s\": " + std::to_string(timeout_s) + ", \"memory_mb\": 100}}";
  run.provenance = collect_provenance();
  run.plugins_json = "[]";
  return run;
}

/// Rows that cells refer to.
struct Ids {
  std::int64_t model, contender, setting;
};

Ids add_names(ResultsWriter& writer, const std::string& contender = "c") {
  return {writer.model_id({"m,1", "mesh", "layers", 12, 2, "{}", "[]"}),
          writer.contender_id({contender, contender, "{}", "v"}),
          writer.setting_id({"", "{}", "{}", "s"})};
}

Scores scores_with(std::string_view metric, double value) {
  Scores scores(metric_table().size());
  scores.at(metric_index(metric)) = value;
  return scores;
}

CellRecord cell_record(const Ids& ids, const std::string& key, Outcome outcome = Outcome::kValid) {
  CellRecord cell;
  cell.cell_key = key;
  cell.model_id = ids.model;
  cell.contender_id = ids.contender;
  cell.setting_id = ids.setting;
  cell.outcome = outcome;
  cell.layers = 2;
  cell.route_hash = "hash of " + key;
  cell.started_utc = "2000-01-01T00:00:00Z";
  cell.totals = scores_with("travel_mm", 0);
  for (int i = 0; i < 2; ++i) {
    LayerScore layer;
    layer.layer_index = i;
    layer.z_mm = 0.1 + i;
    layer.scores = scores_with("travel_mm", i);
    cell.layer_scores.push_back(layer);
  }
  return cell;
}

TimingSample sample(int repetition, std::int64_t ns) {
  return {repetition, {ns, ns + 1}, {{ns - 10, ns - 9}, {10, 10}}, 12, 3, 4096};
}

/// The first column of a query's first row; "NULL" for NULL.
std::string query(const fs::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
  std::string result = "no row";
  if (sqlite3_step(statement) == SQLITE_ROW) {
    const void* bytes = sqlite3_column_blob(statement, 0);
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement, 0));
    result = sqlite3_column_type(statement, 0) == SQLITE_NULL
                 ? "NULL"
                 : std::string(static_cast<const char*>(bytes), size);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return result;
}

void execute(const fs::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
  sqlite3_close(database);
}

std::string refusal(const fs::path& folder, const std::string& experiment, Start start) {
  try {
    ResultsWriter(folder, experiment, start);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    return error.what();
  }
  return "none";
}

/// A database with one run and one cell "k".
fs::path database_with_a_cell(const fs::path& folder) {
  ResultsWriter writer(folder, "t", Start::kResume);
  writer.begin_run(run_record());
  writer.add_cell(cell_record(add_names(writer), "k"));
  writer.finish_run();
  return writer.file();
}

TEST(Results, ZeroIsAValueAndAbsenceIsNull) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path() / "a" / "b");
  EXPECT_EQ(file, dir.path() / "a" / "b" / "results.sqlite");
  const std::vector<StoredCell> cells = current_cells(file);
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells[0].model, "m,1");
  EXPECT_EQ(cells[0].contender, "c");
  EXPECT_EQ(cells[0].totals.at(metric_index("travel_mm")), 0.0);
  EXPECT_EQ(cells[0].totals.at(metric_index("covered")), std::nullopt);
  EXPECT_EQ(query(file, "SELECT travel_mm FROM layer_score WHERE layer_index = 0"), "0.0");
  EXPECT_EQ(query(file, "SELECT covered FROM layer_score WHERE layer_index = 0"), "NULL");
}

TEST(Results, TheMetricTableIsThere) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path());
  EXPECT_EQ(query(file, "SELECT count(*) FROM metric"), std::to_string(metric_table().size()));
  EXPECT_EQ(query(file, "SELECT better || total || unit FROM metric WHERE name = 'travel_mm'"),
            "lowersummm");
  EXPECT_EQ(query(file, "SELECT better || total FROM metric WHERE name = 'covered'"), "higherarea");
}

TEST(Results, ProvenanceIsThere) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path());
  for (const char* column : {"routebench_version", "compiler", "compiler_flags", "cpu", "os"})
    EXPECT_GT(query(file, std::string("SELECT ") + column + " FROM run").size(), 2u) << column;
  EXPECT_GT(std::stoll(query(file, "SELECT memory_bytes FROM run")), 1 << 20);
  EXPECT_GE(std::stoi(query(file, "SELECT cores FROM run")), 1);
  for (const char* library :
       {"SQLite", "CLI11", "toml++", "nlohmann-json", "CGAL", "Boost", "Clipper"}) {
    const std::string version = query(
        file, "SELECT json_extract(libraries_json, '$.\"" + std::string(library) + "\"') FROM run");
    EXPECT_TRUE(!version.empty() && std::isdigit(version[0])) << library << ": " << version;
  }
  EXPECT_NE(query(file, "SELECT finished_utc FROM run"), "NULL");
}

TEST(Results, CellsAreFoundAgainWithWhatWasTaken) {
  const ScratchDir dir;
  {
    ResultsWriter writer(dir.path(), "t", Start::kResume);
    writer.begin_run(run_record(7));
    CellRecord cell = cell_record(add_names(writer), "k", Outcome::kOffTask);
    cell.timing = sample(0, 100);
    const std::int64_t id = writer.add_cell(cell);
    writer.add_timing(id, sample(2, 300));
  }
  ResultsWriter writer(dir.path(), "t", Start::kResume);
  const KnownCells known = writer.known_cells();
  ASSERT_EQ(known.size(), 1u);
  const KnownCell& cell = known.at("k");
  EXPECT_EQ(cell.outcome, Outcome::kOffTask);
  EXPECT_EQ(cell.route_hash, "hash of k");
  EXPECT_EQ(cell.repetitions, (std::vector<int>{0, 2}));
  EXPECT_EQ(cell.timeout_s, 7);
  EXPECT_EQ(cell.memory_mb, 100);
  EXPECT_TRUE(cell.current);
}

TEST(Results, PlanTimesAreMediansOfTheSamplesAndLayersThoseOfTheFirst) {
  const ScratchDir dir;
  ResultsWriter writer(dir.path(), "t", Start::kResume);
  writer.begin_run(run_record());
  CellRecord cell = cell_record(add_names(writer), "k");
  cell.totals = scores_with("plan_wall_ns", 5);  // not a sample
  const std::int64_t id = writer.add_cell(cell);
  const auto median = [&] {
    return current_cells(writer.file()).at(0).totals.at(metric_index("plan_wall_ns"));
  };
  EXPECT_EQ(median(), std::nullopt);
  writer.add_timing(id, sample(1, 400));
  EXPECT_EQ(median(), 400.0);
  EXPECT_EQ(query(writer.file(), "SELECT plan_wall_ns FROM layer_score"), "NULL");
  writer.add_timing(id, sample(0, 100));
  EXPECT_EQ(median(), 250.0);
  EXPECT_EQ(query(writer.file(), "SELECT plan_wall_ns FROM layer_score ORDER BY layer_index"),
            "90.0");
  writer.add_timing(id, sample(2, 110));
  EXPECT_EQ(median(), 110.0);
  EXPECT_EQ(query(writer.file(), "SELECT count(*) FROM timing_sample"), "3");
}

TEST(Results, OnlyTheLastRunsCellsAreCurrent) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path());
  {
    ResultsWriter writer(dir.path(), "t", Start::kResume);
    const Ids ids = add_names(writer, "d");
    writer.together([&] { writer.begin_run(run_record()); });
    writer.add_cell(cell_record(ids, "k2"));
  }
  ASSERT_EQ(current_cells(file).size(), 1u);
  EXPECT_EQ(current_cells(file)[0].contender, "d");
  {
    ResultsWriter writer(dir.path(), "t", Start::kResume);
    writer.begin_run(run_record());
    for (const auto& [key, cell] : writer.known_cells()) writer.reuse_cell(cell.cell_id);
  }
  EXPECT_EQ(current_cells(file).size(), 2u);
}

TEST(Results, WhatIsWrittenTogetherIsUndoneTogether) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path());
  ResultsWriter writer(dir.path(), "t", Start::kResume);
  const auto fail_after_writing = [&] {
    writer.together([&] {
      writer.begin_run(run_record());
      throw std::runtime_error("changed my mind");
    });
  };
  EXPECT_THROW(fail_after_writing(), std::runtime_error);
  EXPECT_EQ(current_cells(file).size(), 1u);
}

TEST(Results, ACellThatRanIntoALimitIsReplacedAndNoOther) {
  const ScratchDir dir;
  ResultsWriter writer(dir.path(), "t", Start::kResume);
  writer.begin_run(run_record());
  const Ids ids = add_names(writer);
  writer.add_cell(cell_record(ids, "k", Outcome::kTimedOut));
  writer.add_cell(cell_record(ids, "k", Outcome::kValid));
  EXPECT_EQ(query(writer.file(), "SELECT count(*) || outcome FROM cell"), "1valid");
  EXPECT_THROW(writer.add_cell(cell_record(ids, "k")), Error);
}

TEST(Results, FreshKeepsTheOldFileUntilTheFirstNewCell) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path());
  {
    ResultsWriter writer(dir.path(), "t", Start::kFresh);
    writer.begin_run(run_record());
    EXPECT_TRUE(writer.known_cells().empty());
    EXPECT_EQ(current_cells(file).size(), 1u);
  }
  EXPECT_EQ(query(file, "SELECT cell_key FROM cell"), "k");
  {
    ResultsWriter writer(dir.path(), "t", Start::kFresh);
    writer.begin_run(run_record());
    writer.add_cell(cell_record(add_names(writer), "new"));
    writer.add_cell(cell_record(add_names(writer), "newer"));
  }
  EXPECT_EQ(query(file, "SELECT group_concat(cell_key) FROM cell"), "new,newer");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), fs::directory_iterator()), 1);
}

TEST(Results, OtherFilesAreRefusedWithoutHarm) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path());
  const std::string name = file.string() + ": ";
  for (const Start start : {Start::kResume, Start::kFresh})
    EXPECT_EQ(refusal(dir.path(), "other", start),
              name +
                  "holds the results of the experiment t, not of other; give another folder with "
                  "--out");

  execute(file, "UPDATE metric SET name = 'travel_km' WHERE name = 'max_travel_mm'");
  EXPECT_EQ(refusal(dir.path(), "t", Start::kResume),
            name +
                "was written by a program with other metrics; run with --fresh to start anew, or "
                "with --out for another folder");
  execute(file, "UPDATE meta SET value = '99' WHERE key = 'schema_version'");
  EXPECT_TRUE(refusal(dir.path(), "t", Start::kResume).starts_with(name + "has schema version 99"));
  EXPECT_THROW(static_cast<void>(current_cells(file)), Error);
  EXPECT_EQ(refusal(dir.path(), "t", Start::kFresh), "none");
  EXPECT_EQ(query(file, "SELECT cell_key FROM cell"), "k");
}

TEST(Results, WhatIsNoDatabaseIsRefusedWithoutHarm) {
  const ScratchDir dir;
  dir.write("results.sqlite", "to whom it may concern");
  for (const Start start : {Start::kResume, Start::kFresh})
    EXPECT_EQ(refusal(dir.path(), "t", start),
              (dir.path() / "results.sqlite").string() + ": file is not a database");
  EXPECT_EQ(test::text_of_file(dir.path() / "results.sqlite"), "to whom it may concern");

  execute(dir.path() / "foreign", "CREATE TABLE meta(key, value)");
  fs::rename(dir.path() / "foreign", dir.path() / "results.sqlite");
  EXPECT_NE(refusal(dir.path(), "t", Start::kResume).find("none of routebench's results"),
            std::string::npos);
}

TEST(Results, CellsOfNothingAreRefused) {
  for (const char* table : {"run", "model", "contender", "setting"}) {
    const ScratchDir dir;
    const fs::path file = database_with_a_cell(dir.path());
    execute(file, std::string("PRAGMA foreign_keys = OFF; DELETE FROM ") + table);
    const std::string why = file.string() +
                            ": is damaged: a cell names a run, model, contender or "
                            "setting that is not there";
    EXPECT_EQ(refusal(dir.path(), "t", Start::kResume), why) << table;
    try {
      static_cast<void>(current_cells(file));
      FAIL() << table;
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), why) << table;
    }
  }
}

TEST(Results, AFolderThatCannotBeMadeIsNamed) {
  const ScratchDir dir;
  dir.write("file", "");
  EXPECT_TRUE(refusal(dir.path() / "file" / "out", "t", Start::kResume)
                  .starts_with((dir.path() / "file" / "out").string() + ": "));
}

/// Runs something in another process and returns its exit code.
template <typename Act>
int in_another_process(Act&& act) {
  const pid_t process = fork();
  if (process == 0) _exit(act());
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(Results, WhereThereIsNoRoomNothingIsLeft) {
  const ScratchDir dir;
  const fs::path folder = dir.path() / "new" / "out";
  const auto refused = [&] {
    signal(SIGXFSZ, SIG_IGN);
    for (const rlim_t bytes : {0u, 8192u, 16384u}) {
      const rlimit small{bytes, RLIM_INFINITY};
      setrlimit(RLIMIT_FSIZE, &small);
      if (!refusal(folder, "t", Start::kResume)
               .starts_with((folder / "results.sqlite.new").string() + ": "))
        return 1;
    }
    return 0;
  };
  EXPECT_EQ(in_another_process(refused), 0);
  EXPECT_TRUE(fs::is_empty(dir.path()));
}

TEST(Results, OneWriterAtATime) {
  const ScratchDir dir;
  {
    const ResultsWriter writer(dir.path(), "t", Start::kResume);
    const auto refused_with_our_number = [&] {
      const std::string said = refusal(dir.path(), "t", Start::kResume);
      const std::string expected =
          dir.path().string() + ": another run is writing its results here (process " +
          std::to_string(getppid()) + "); wait for it or give another folder with --out";
      return said == expected ? 0 : 1;
    };
    EXPECT_EQ(in_another_process(refused_with_our_number), 0);
  }
  EXPECT_EQ(refusal(dir.path(), "t", Start::kResume), "none");
  EXPECT_FALSE(fs::exists(dir.path() / ".lock"));
}

TEST(Results, KillingTheWriterLosesNothingThatWasAdded) {
  const ScratchDir dir;
  constexpr int kCells = 5;
  const auto add_and_die = [&](Start start, const std::string& prefix) {
    return in_another_process([&] {
      ResultsWriter writer(dir.path(), "t", start);
      writer.begin_run(run_record());
      const Ids ids = add_names(writer);
      for (int i = 0; i < kCells; ++i)
        writer.add_cell(cell_record(ids, prefix + std::to_string(i)));
      return kill(getpid(), SIGKILL);
    });
  };
  EXPECT_EQ(add_and_die(Start::kResume, "a"), -SIGKILL);
  EXPECT_EQ(ResultsWriter(dir.path(), "t", Start::kResume).known_cells().size(), kCells * 1u);
  EXPECT_EQ(add_and_die(Start::kResume, "b"), -SIGKILL);
  EXPECT_EQ(ResultsWriter(dir.path(), "t", Start::kResume).known_cells().size(), kCells * 2u);
  EXPECT_EQ(add_and_die(Start::kFresh, "c"), -SIGKILL);
  EXPECT_EQ(ResultsWriter(dir.path(), "t", Start::kResume).known_cells().size(), kCells * 1u);
}

/// Fields of a line without quotes.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line)
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find("\r\n", begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end == std::string::npos ? text.size() : end + 2;
  }
  return lines;
}

TEST(Export, WritesEveryCellAndMetricAndLeavesNothingElse) {
  const ScratchDir dir;
  fs::path file;
  {
    ResultsWriter writer(dir.path(), "t", Start::kResume);
    file = writer.file();
    writer.begin_run(run_record());
    CellRecord cell = cell_record(add_names(writer, "say \"hi\"\nthere"), "k", Outcome::kCrashed);
    cell.reason = "SIGSEGV, of course";
    cell.totals = scores_with("travel_mm", 0.1 + 0.2);
    cell.timing = sample(0, 100);
    writer.add_cell(cell);
  }
  const std::vector<fs::path> written = export_csv(file, dir.path() / "csv");
  EXPECT_EQ(written.size(), 8u);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path() / "csv"), fs::directory_iterator()), 8);

  const std::vector<std::string> cells =
      lines_of(test::text_of_file(dir.path() / "csv" / "cells.csv"));
  ASSERT_EQ(cells.size(), 1 + metric_table().size());
  EXPECT_EQ(cells[0],
            "experiment,model,contender,setting,seed,outcome,reason,layers,route_hash,metric,value,"
            "unit,better");
  const std::string start =
      "t,\"m,1\",\"say \"\"hi\"\"\nthere\",,1,crashed,\"SIGSEGV, of course\",2,hash of k,";
  EXPECT_EQ(cells[1 + metric_index("travel_mm")], start + "travel_mm,0.30000000000000004,mm,lower");
  EXPECT_EQ(cells[1 + metric_index("covered")], start + "covered,,,higher");

  const std::string layers = test::text_of_file(dir.path() / "csv" / "layers.csv");
  EXPECT_EQ(lines_of(layers).size(), 3u);
  EXPECT_EQ(fields_of(lines_of(layers)[0]).size(), 9 + metric_table().size());
  EXPECT_EQ(lines_of(test::text_of_file(dir.path() / "csv" / "metrics.csv")).size(),
            1 + metric_table().size());
}

TEST(Export, TakesTheFolderOrTheFile) {
  const ScratchDir dir;
  const fs::path file = database_with_a_cell(dir.path());
  EXPECT_EQ(results_file(file), file);
  EXPECT_EQ(results_file(dir.path()), file);
  EXPECT_THROW(static_cast<void>(results_file(dir.path() / "none")), Error);
  fs::create_directory(dir.path() / "empty");
  EXPECT_THROW(static_cast<void>(results_file(dir.path() / "empty")), Error);
}

}  // namespace
}  // namespace routebench
