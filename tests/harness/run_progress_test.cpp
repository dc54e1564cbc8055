#include "run_progress.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

namespace routebench {
namespace {

TEST(Duration, IsRoundedUpToWhatPeopleSay) {
  EXPECT_EQ(duration_text(0), "0 s");
  EXPECT_EQ(duration_text(0.2), "1 s");
  EXPECT_EQ(duration_text(119), "119 s");
  EXPECT_EQ(duration_text(121), "3 min");
  EXPECT_EQ(duration_text(7199), "2 h 0 min");
  EXPECT_EQ(duration_text(7260), "2 h 1 min");
}

TEST(Progress, ABarShowsTimeToGoAndOnlyWhatIsNotValidStays) {
  std::ostringstream out;
  {
    RunProgress progress({&out, ProgressForm::kBar}, "cell", 3, 30);
    progress.step(10, {"quiet", Outcome::kValid, ""});
    progress.step(10, {"loud", Outcome::kCrashed, "SIGSEGV"});
    progress.step(10, {"last", Outcome::kValid, ""});
  }
  const std::string text = out.str();
  EXPECT_TRUE(text.starts_with("cell 0 of 3\r\x1b[K")) << text;
  EXPECT_NE(text.find("cell 1 of 3, about "), std::string::npos) << text;
  EXPECT_NE(text.find("\r\x1b[Kloud: crashed (SIGSEGV)\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("quiet"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\r\x1b[K")) << "the line is cleared at the end";
}

TEST(Progress, LinesAreOneAStepIfThereIsSomethingToSay) {
  std::ostringstream out;
  {
    RunProgress progress({&out, ProgressForm::kLines}, "cell", 3, 3);
    progress.step(1, {"first", Outcome::kValid, ""});
    progress.step(1, {});
    progress.step(1, {"third", Outcome::kOffTask, "why"});
  }
  EXPECT_EQ(out.str(), "[1/3] first: valid\n[3/3] third: off_task (why)\n");
}

TEST(Progress, JsonIsOneObjectALineAndSparesStepsWithoutNews) {
  std::ostringstream out;
  const RunLog log{&out, ProgressForm::kJson};
  tell(log, "two\nlines");
  tell_redo(log, "m · c", "seed 1 -> 2");
  {
    RunProgress progress(log, "cell", 2000, 2000);
    progress.step(1, {"m · c", Outcome::kFailed, "no mood"});
    for (int i = 0; i < 1999; ++i) progress.step(1, {});
  }
  std::istringstream lines(out.str());
  std::vector<nlohmann::json> events;
  for (std::string line; std::getline(lines, line);) events.push_back(nlohmann::json::parse(line));
  ASSERT_GE(events.size(), 4u);
  EXPECT_LT(events.size(), 1000u);
  EXPECT_EQ(events[0], (nlohmann::json{{"event", "note"}, {"text", "two\nlines"}}));
  EXPECT_EQ(events[1],
            (nlohmann::json{{"event", "redo"}, {"cell", "m · c"}, {"why", "seed 1 -> 2"}}));
  EXPECT_EQ(events[2].at("event"), "progress");
  EXPECT_EQ(events[2].at("what"), "cell");
  EXPECT_EQ(events[2].at("done"), 1);
  EXPECT_EQ(events[2].at("steps"), 2000);
  EXPECT_EQ(events[2].at("cell"), "m · c");
  EXPECT_EQ(events[2].at("outcome"), "failed");
  EXPECT_EQ(events[2].at("reason"), "no mood");
  EXPECT_TRUE(events[2].at("to_go_s").is_number());
  EXPECT_EQ(events.back().at("done"), 2000);
  EXPECT_EQ(events.back().at("to_go_s"), 0.0);
  EXPECT_FALSE(events.back().contains("cell"));
}

TEST(Progress, NothingIsNothing) {
  std::ostringstream out;
  const RunLog log{&out, ProgressForm::kNone};
  tell(log, "hello");
  tell_redo(log, "a", "b");
  RunProgress(log, "cell", 1, 1).step(1, {"a", Outcome::kCrashed, "b"});
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace routebench
