/// Messages that may quote anything.

#include "routebench/geometry/error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace routebench {
namespace {

TEST(OneLine, LeavesWhatCanBeShownAlone) {
  for (const char* text :
       {"", "a.gcode:3: 'X' is not a number", "m\u00ff \u20ac \U0001F600", "\uffff"})
    EXPECT_EQ(one_line(text), text);
}

TEST(OneLine, HasNoLineEndsAndNothingThatTerminalsObey) {
  EXPECT_EQ(one_line("a\nb\r\nc\td"), "a b  c d");
  EXPECT_EQ(one_line("\x1b[2J\x7f\x01" + std::string(1, '\0')), "?[2J???");
}

TEST(OneLine, BytesThatAreNoUtf8AreMarked) {
  // Alone, cut off, too long, half of a pair, beyond the last character.
  EXPECT_EQ(one_line("a\xff"
                     "b\x80"
                     "c\xc3"),
            "a?b?c?");
  EXPECT_EQ(one_line("\xe2\x82"), "??");
  EXPECT_EQ(one_line("\xc0\xaf \xe0\x80\xaf \xf0\x80\x80\xaf"), "?? ??? ????");
  EXPECT_EQ(one_line("\xed\xa0\x80 \xf4\x90\x80\x80 \xf5"), "??? ???? ?");
}

TEST(OneLine, EndsSomewhereBetweenCharacters) {
  std::string euros;
  for (int i = 0; i < 5000; ++i) euros += "\u20ac";
  const std::string line = one_line(euros);
  EXPECT_LT(line.size(), 4100u);
  EXPECT_TRUE(line.ends_with("\u20ac..."));
}

}  // namespace
}  // namespace routebench
