/// The commands merge and reproduce, and run with --shard.

#include <algorithm>
#include <set>

#include "database_content.hpp"
#include "program.hpp"
#include "routebench/harness/results.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using test::ProgramRun;

constexpr const char* kSquare =
    "MULTIPOLYGON Z (((0 0 0.1, 9 0 0.1, 9 9 0.1, 0 9 0.1, 0 0 0.1)))\n"
    "MULTIPOLYGON Z (((0 0 0.3, 9 0 0.3, 9 9 0.3, 0 9 0.3, 0 0 0.3)))\n";

class ReproduceCommand : public test::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    here_ = fs::current_path();
    fs::create_directories(folder_ / "study" / "models");
    write("study/models/square.wkt", kSquare);
    fs::copy_file(ROUTEBENCH_CULPRIT_PLUGIN, folder_ / "study" / "culprit.so");
    write(
        "study/t.toml",
        "name = \"t\"\nseed = [1, 2]\nmodels = [\"models/square.wkt\"]\n"
        "plugins = [\"culprit.so\"]\n[task]\nperimeters = 0\ndensity = 1\n[run]\nrepetitions = 2\n"
        "[[contender]]\nname = \"honest\"\nfill = { planner = \"hatch\", zigzag = [true, false] }\n"
        "[[contender]]\nname = \"skip\"\nfill = { planner = \"culprit\", crime = \"skip\" }\n");
    fs::current_path(folder_);
  }
  void TearDown() override {
    fs::current_path(here_);
    ProgramTest::TearDown();
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }

  fs::path here_;
};

TEST_F(ReproduceCommand, CellsThatTheConfigDoesNotHaveAreSaid) {
  ASSERT_EQ(call({"run", "study/t.toml"}).exit_code, 1);
  test::rows_of(folder_ / "results" / "t" / "results.sqlite", "UPDATE cell SET seed = 77");
  const ProgramRun again = call({"reproduce", "results/t", "--out", "again"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_NE(again.err.find("results/t/results.sqlite: its config has none of the cells"),
            std::string::npos)
      << again.err;
  EXPECT_FALSE(fs::exists("again"));
}

TEST_F(ReproduceCommand, FromAnyFolderTheSameResultsComeOutAgain) {
  ASSERT_EQ(call({"run", "study/t.toml"}).exit_code, 1);
  const fs::path original = folder_ / "results" / "t";
  fs::remove(folder_ / "study" / "t.toml");
  fs::create_directory(folder_ / "elsewhere");
  fs::current_path(folder_ / "elsewhere");
  const ProgramRun again = call({"reproduce", original.string()});
  EXPECT_EQ(again.exit_code, 0) << again.err << again.out;
  EXPECT_NE(again.out.find("reproduced: 6 cells executed again, 0 differ"), std::string::npos)
      << again.out;
  EXPECT_EQ(again.out.find("made with"), std::string::npos) << again.out;
  EXPECT_EQ(test::current_content(original / "reproduction" / "results.sqlite"),
            test::current_content(original / "results.sqlite"));

  // The same again is no new reproduction, and must not pass for one.
  const ProgramRun third = call({"reproduce", original.string()});
  EXPECT_EQ(third.exit_code, 2);
  EXPECT_NE(third.err.find("is a finished reproduction; --fresh makes it anew"), std::string::npos)
      << third.err;
  EXPECT_EQ(call({"reproduce", original.string(), "--fresh", "--jobs", "2"}).exit_code, 0);
}

TEST_F(ReproduceCommand, WhatDiffersIsNamed) {
  ASSERT_EQ(call({"run", "study/t.toml", "--out", "out"}).exit_code, 1);
  test::rows_of(folder_ / "out" / "results.sqlite",
                "UPDATE cell_score SET value = value * 2 WHERE metric = 'travel_mm' AND cell_id ="
                " (SELECT min(cell_id) FROM cell WHERE seed = 2)");
  test::rows_of(folder_ / "out" / "results.sqlite", "UPDATE run SET compiler = 'abacus 1'");
  const ProgramRun changed = call({"reproduce", "out", "--out", "again"});
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_NE(changed.out.find("differs: models/square.wkt · "), std::string::npos) << changed.out;
  EXPECT_NE(changed.out.find("seed 2: travel_mm "), std::string::npos) << changed.out;
  EXPECT_NE(changed.out.find("made with: compiler abacus 1 -> "), std::string::npos);
  EXPECT_NE(changed.out.find("not reproduced: 6 cells executed again, 1 differs"),
            std::string::npos);

  std::string smaller = kSquare;
  std::replace(smaller.begin(), smaller.end(), '9', '8');
  write("study/models/square.wkt", smaller);
  const ProgramRun other_model = call({"reproduce", "out", "--out", "other"});
  EXPECT_EQ(other_model.exit_code, 1) << other_model.err;
  EXPECT_NE(other_model.out.find("the model gives other layers"), std::string::npos)
      << other_model.out;
}

TEST_F(ReproduceCommand, OnlyWhatWasExecutedIsExecutedAgainAndElsewhereByItsNewFolder) {
  ASSERT_EQ(call({"run", "study/t.toml", "--only", "contender=honest"}).exit_code, 0);
  fs::rename(folder_ / "study", folder_ / "moved");
  const ProgramRun lost = call({"reproduce", "results/t"});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_NE(lost.err.find("culprit.so"), std::string::npos) << lost.err;
  const ProgramRun found = call({"reproduce", "results/t", "--base", "moved", "--plugin",
                                 "moved/culprit.so", "--progress", "lines"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_NE(found.out.find("reproduced: 4 cells"), std::string::npos) << found.out;
  EXPECT_NE(found.err.find("[4/4] "), std::string::npos) << found.err;
}

TEST_F(ReproduceCommand, ShardsHaveFoldersOfTheirOwnAndAreMerged) {
  ASSERT_EQ(call({"run", "study/t.toml", "--out", "whole"}).exit_code, 1);
  std::vector<std::string> arguments{"merge", "merged"};
  for (const std::string number : {"1", "2", "3"}) {
    EXPECT_LE(call({"run", "study/t.toml", "--shard", number + "/3"}).exit_code, 1);
    arguments.push_back("results/t-shard-" + number + "-of-3");
    EXPECT_TRUE(fs::exists(folder_ / arguments.back() / "results.sqlite"));
  }
  const ProgramRun merged = call(arguments);
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(merged.err, "");
  EXPECT_TRUE(merged.out.starts_with("6 cells: 4 valid, 2 off_task\n")) << merged.out;
  EXPECT_TRUE(merged.out.ends_with("\nresults: merged/results.sqlite\n")) << merged.out;
  EXPECT_EQ(test::current_content("merged/results.sqlite"),
            test::current_content("whole/results.sqlite"));
  EXPECT_EQ(call({"reproduce", "merged"}).exit_code, 0);

  EXPECT_EQ(call(arguments).exit_code, 2) << "a merge overwrites nothing";
  arguments.push_back("--fresh");
  EXPECT_EQ(call(arguments).exit_code, 0);
  arguments.back() = "results/t-shard-1-of-3";
  arguments[1] = "twice";
  EXPECT_NE(call(arguments).err.find("is named twice"), std::string::npos);
}

TEST_F(ReproduceCommand, AShardIsAPartOfTheWhole) {
  for (const char* wrong : {"0/3", "4/3", "3", "a/b", "1/0", "-1/2", "1/2/3"}) {
    const ProgramRun refused = call({"run", "study/t.toml", std::string("--shard=") + wrong});
    EXPECT_EQ(refused.exit_code, 2) << wrong;
    EXPECT_NE(refused.err.find(std::string("--shard ") + wrong + ": must be I/N"),
              std::string::npos)
        << refused.err;
  }
}

}  // namespace
}  // namespace routebench
