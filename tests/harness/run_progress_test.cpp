#include "run_progress.hpp"

#include <gtest/gtest.h>

#include <sstream>

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

TEST(Progress, OnATerminalTimeToGoIsShownAndOnlyNotableLinesStay) {
  std::ostringstream out;
  {
    RunProgress progress({&out, true}, "cell", 3, 30);
    progress.step(10, "quiet", false);
    progress.step(10, "loud", true);
    progress.step(10, "last", false);
  }
  const std::string text = out.str();
  EXPECT_TRUE(text.starts_with("cell 0 of 3\r\x1b[K")) << text;
  EXPECT_NE(text.find("cell 1 of 3, about "), std::string::npos) << text;
  EXPECT_NE(text.find("\r\x1b[Kloud\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("quiet"), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("\r\x1b[K")) << "the line is cleared at the end";
}

TEST(Progress, ElsewhereThereIsALineAStepIfThereIsSomethingToSay) {
  std::ostringstream out;
  {
    RunProgress progress({&out, false}, "cell", 3, 3);
    progress.step(1, "first", false);
    progress.step(1, "", false);
    progress.step(1, "third", true);
  }
  EXPECT_EQ(out.str(), "[1/3] first\n[3/3] third\n");
}

}  // namespace
}  // namespace routebench
