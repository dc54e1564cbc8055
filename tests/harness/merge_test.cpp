/// Shards and what joins them.

#include <algorithm>

#include "runner_fixture.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::culprit_contender;
using test::hatch_contender;
using test::rows_of;

class Merge : public test::RunnerTest {
 protected:
  [[nodiscard]] ExperimentConfig experiment(const std::string& run = "repetitions = 2") {
    return config(hatch_contender("a", ", version = [1, 2]") + culprit_contender("skip") +
                      culprit_contender("throw"),
                  run, "seed = [1, 2]\n");
  }

  /// Executes a config, or a shard of it, into a folder of its own, which is returned.
  fs::path run_into(const std::string& folder, const ExperimentConfig& config,
                    std::optional<Shard> shard = std::nullopt) {
    options_.out = dir_.path() / folder;
    options_.shard = shard;
    execute(config);
    options_.shard.reset();
    return options_.out;
  }

  MergeSummary merge(const std::string& folder, const std::vector<fs::path>& parts,
                     bool replace = false) {
    options_.out = dir_.path() / folder;
    return merge_results(options_.out, parts, replace, "merge");
  }

  std::string refusal(const std::vector<fs::path>& parts) {
    try {
      merge("refused", parts);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_TRUE(!fs::exists(dir_.path() / "refused") || fs::is_empty(dir_.path() / "refused"));
      return error.what();
    }
    return "none";
  }

  void change(const fs::path& folder, const std::string& sql) {
    rows_of(folder / "results.sqlite", sql);
  }
};

TEST_F(Merge, ShardsTogetherAreTheWholeInAnyOrder) {
  const ExperimentConfig all = experiment();
  run_into("whole", all);
  const std::vector<std::string> whole = content();
  for (const std::size_t count : {1u, 3u, 5u}) {
    std::vector<fs::path> parts;
    std::size_t cells = 0;
    for (std::size_t number = 1; number <= count; ++number) {
      parts.push_back(run_into("part" + std::to_string(number) + "of" + std::to_string(count), all,
                               Shard{number, count}));
      cells += this->cells().size();
    }
    EXPECT_EQ(cells, all.cell_count()) << "shards overlap or leave something out";
    std::reverse(parts.begin(), parts.end());
    const MergeSummary summary = merge("merged" + std::to_string(count), parts);
    EXPECT_EQ(summary.cells, all.cell_count());
    EXPECT_EQ(summary.remarks, std::vector<std::string>{});
    EXPECT_EQ(content(), whole) << count << " shards";
    const RunSummary again = [&] {
      execute(all);
      return run_experiment(all, planners_, options_, {&log_});
    }();
    EXPECT_EQ(again.executed, 0u) << "the merged database is not taken for a whole one";
  }
}

TEST_F(Merge, ShardsAreTheSameWhereAnOptionalModelCannotBeHad) {
  run_into("third",
           config(hatch_contender("a"), "repetitions = 1",
                  "optional_models = [\"rare.wkt\", \"large.wkt\"]\n", "\"small.wkt\""),
           Shard{3, 3});
  ASSERT_EQ(cells().size(), 1u);
  EXPECT_EQ(cells().front().model, "large.wkt") << "the third of three, here and everywhere";
}

TEST_F(Merge, NothingOfThePartsIsLost) {
  const fs::path first = run_into("first", experiment("repetitions = 3"), Shard{1, 2});
  const fs::path second = run_into("second", experiment("repetitions = 3"), Shard{2, 2});
  merge("merged", {first, second});
  for (const char* table : {"cell", "cell_score", "layer_score", "timing_sample", "route"}) {
    const std::string count = std::string("SELECT count(*) FROM ") + table;
    const auto number = [&](const fs::path& folder) {
      return std::stol(rows_of(folder / "results.sqlite", count).front());
    };
    EXPECT_EQ(number(options_.out), number(first) + number(second)) << table;
  }
  // Both runs with their keys, and the merge; every sample still says which run took it.
  const std::string samples =
      "SELECT cell_key, repetition, run_key, plan_wall_ns, minor_faults, timing_sample"
      ".peak_rss_bytes FROM timing_sample JOIN cell USING(cell_id) JOIN run ON run.run_id ="
      " timing_sample.run_id";
  std::vector<std::string> of_parts = rows_of(first / "results.sqlite", samples);
  const std::vector<std::string> more = rows_of(second / "results.sqlite", samples);
  of_parts.insert(of_parts.end(), more.begin(), more.end());
  std::vector<std::string> merged = rows_of(file(), samples);
  std::sort(of_parts.begin(), of_parts.end());
  std::sort(merged.begin(), merged.end());
  EXPECT_EQ(merged, of_parts);
  EXPECT_EQ(rows_of(file(), "SELECT count(*), count(finished_utc) FROM run"),
            std::vector<std::string>{"3|3"});
}

TEST_F(Merge, CellsThatSeveralHoldAreStoredOnceWithAllSamples) {
  const fs::path first = run_into("first", experiment());
  const fs::path second = run_into("second", experiment());
  const std::vector<std::string> one = [&] {
    merge("merged", {first, second});
    return rows_of(file(), "SELECT count(*) FROM cell");
  }();
  EXPECT_EQ(one, std::vector<std::string>{std::to_string(experiment().cell_count())});
  const auto repetitions = [&] {
    return rows_of(file(),
                   "SELECT DISTINCT group_concat(repetition) FROM (SELECT * FROM timing_sample"
                   " ORDER BY cell_id, repetition) GROUP BY cell_id");
  };
  EXPECT_EQ(repetitions(), std::vector<std::string>{"0,1,2,3"});
  const fs::path both = options_.out;
  merge("again", {both, first, second});
  EXPECT_EQ(repetitions(), std::vector<std::string>{"0,1,2,3"})
      << "the same samples, counted twice";
  const std::string median =
      "SELECT count(*) FROM cell_score AS score WHERE metric = 'plan_wall_ns' AND value <>"
      " (SELECT avg(plan_wall_ns) FROM (SELECT plan_wall_ns FROM timing_sample WHERE cell_id ="
      " score.cell_id ORDER BY 1 LIMIT 2 OFFSET 1))";
  EXPECT_EQ(rows_of(file(), median), std::vector<std::string>{"0"});
}

TEST_F(Merge, ACellAtALimitGivesWayToOneThatIsDone) {
  const auto with_timeout = [&](const char* timeout) {
    return config(hatch_contender("a") + culprit_contender("nap"),
                  std::string("repetitions = 1\ntimeout_s = ") + timeout);
  };
  const fs::path slow = run_into("slow", with_timeout("0.1"));
  EXPECT_EQ(cell("nap", "small.wkt").outcome, Outcome::kTimedOut);
  const fs::path fast = run_into("fast", with_timeout("30"));
  const std::vector<std::string> done = content();
  merge("one", {slow, fast});
  EXPECT_EQ(rows_of(file(), "SELECT count(*) FROM cell"), std::vector<std::string>{"4"});
  EXPECT_EQ(cell("nap", "small.wkt").outcome, Outcome::kValid);
  EXPECT_EQ(cells().size(), 4u);
  EXPECT_EQ(rows_of(file(), "PRAGMA foreign_key_check"), std::vector<std::string>{});
  merge("other", {fast, slow});
  EXPECT_EQ(cell("nap", "small.wkt").outcome, Outcome::kValid);
  EXPECT_EQ(rows_of(file(), "SELECT count(*) FROM cell"), std::vector<std::string>{"4"});
}

TEST_F(Merge, WhatContradictsIsRefusedByName) {
  const fs::path first = run_into("first", experiment());
  const fs::path second = run_into("second", experiment());
  change(second, "UPDATE cell SET route_hash = 'other' WHERE cell_id = 1");
  const std::string said = refusal({first, second});
  EXPECT_NE(said.find("second"), std::string::npos) << said;
  EXPECT_NE(said.find("small.wkt · a [fill.version=1] · seed 1 (another route)"), std::string::npos)
      << said;
  change(second,
         "UPDATE cell SET route_hash = (SELECT route_hash FROM cell WHERE cell_id = 2)"
         " WHERE cell_id = 1");
  run_into("third", experiment());
  change(dir_.path() / "third",
         "UPDATE cell_score SET value = value + 1 WHERE metric = 'travel_mm' AND cell_id = 1");
  EXPECT_NE(refusal({first, dir_.path() / "third"}).find("(other scores)"), std::string::npos);
  run_into("fourth", experiment());
  change(dir_.path() / "fourth", "UPDATE cell SET outcome = 'crashed' WHERE cell_id = 1");
  EXPECT_NE(refusal({first, dir_.path() / "fourth"}).find("(crashed here, valid there)"),
            std::string::npos);
}

TEST_F(Merge, OnlyPartsOfOneExperimentAreMerged) {
  const fs::path first = run_into("first", experiment());
  EXPECT_NE(refusal({first, first}).find("is named twice"), std::string::npos);
  EXPECT_NE(refusal({first, run_into("second", config(hatch_contender("a")))})
                .find("its last run had another config than that of"),
            std::string::npos);
  const fs::path third = run_into("third", experiment());
  change(third, "UPDATE meta SET value = 'other' WHERE key = 'experiment'");
  change(third, "UPDATE run SET experiment = 'other'");
  EXPECT_NE(refusal({first, third}).find("only parts of one can be merged"), std::string::npos);
  EXPECT_NE(refusal({first, dir_.path() / "nowhere"}).find("no such file"), std::string::npos);

  merge("out", {first});
  const std::string before = test::text_of_file(file());
  EXPECT_THROW(merge("out", {first}), Error);
  EXPECT_EQ(test::text_of_file(file()), before);
  merge("out", {first}, true);
  EXPECT_EQ(cells().size(), experiment().cell_count());
}

TEST_F(Merge, AMissingShardAndAnUnfinishedRunAreSaid) {
  const fs::path first = run_into("first", experiment(), Shard{1, 3});
  const fs::path third = run_into("third", experiment(), Shard{3, 3});
  change(third, "UPDATE run SET finished_utc = NULL");
  const MergeSummary summary = merge("merged", {first, third});
  ASSERT_EQ(summary.remarks.size(), 2u);
  EXPECT_NE(summary.remarks[0].find("third"), std::string::npos);
  EXPECT_NE(summary.remarks[0].find("not finished"), std::string::npos);
  EXPECT_EQ(summary.remarks[1], "shard 2/3 is missing");
}

}  // namespace
}  // namespace routebench
