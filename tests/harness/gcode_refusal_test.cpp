/// G-code that cannot be read, and what is said of it.

#include <gtest/gtest.h>

#include <string>

#include "gcode_texts.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

using test::kStart;
using test::number;
using test::read_text;
using test::refusal;

TEST(GcodeReader, MalformedInputIsRefusedWithItsLine) {
  struct Case {
    const char* line;
    const char* reason;
  };
  for (const Case& bad : {
           Case{"G1 Xa", "X has no number"},
           Case{"G1 X#", "X'#' is not a number"},
           Case{"G1 X1.2.3", "is not a number"},
           Case{"G1 X1-2", "is not a number"},
           Case{"G1 X--1", "is not a number"},
           Case{"G1 Xnan", "N is given twice"},
           Case{"G1 Xinf", "X has no number"},
           Case{"G1 X", "X has no number"},
           Case{"G92 E", "E has no number"},
           Case{"G1 X1 X2", "X is given twice"},
           Case{"G1 X2000000", "X is more than 1 km away"},
           Case{"G1 X1 E2000000", "more than 1 km of filament"},
           Case{"G1 X1 G1 Y1", "a second command"},
           Case{"G1 X1 #3", "'#' is no word"},
           Case{"X10 Y10", "the line begins with no command but with 'X10 Y10'"},
           Case{"hello world", ""},  // a named command for Klipper
           Case{"\x01\x02", "the byte 0x01"},
           Case{"G", "'G' is not a command"},
           Case{"G-1", "is not a command"},
           Case{"Mx", "is not a command"},
           Case{"G5 X1 Y1 I1 J1 P1 Q1", "G5 is not known"},
           Case{"G53", "G53 is not known"},
           Case{"G92.1", "G92.1 is not known"},
           Case{"G18", "G18 is not known"},
           Case{"G1 X1 (never closed", "a comment in brackets does not end"},
           Case{"while iterations < 3", "cannot be followed"},
           Case{"if true", "begins with no command"},
           Case{"G2 X1 E1", "an arc needs its centre"},
           Case{"G2 X5 I2.5 R3 E1", "either I and J or R"},
           Case{"G2 X10 R4 E1", "does not reach"},
           Case{"G2 R4 E1", "ends where it begins"},
           Case{"G2 X5 I0 J0 E1", "the centre of the arc"},
           Case{"G2 X5 I4 E1", "not on its circle"},
           Case{"G2 I-7777777777777 E1", "more than 1 km"},
           Case{"G2 X5 R1000000000000000000000000000000 E1", "more than 1 km"},
           Case{"G2 X5 I2.5 P2 E1", "several turns"},
           Case{";WIDTH:wide", "the mark of a width is not a number"},
           Case{";HEIGHT:1e9", "the mark of a height is not a number"},
           Case{";HEIGHT:0", "not positive"},
           Case{"G1 X0.0001 E1000", "over 1 m wide"},
       }) {
    const std::string text = kStart + bad.line + "\nG1 X3 Y3 E1\n";
    if (*bad.reason == 0) {
      EXPECT_NO_THROW(read_text(text)) << bad.line;
      continue;
    }
    const std::string message = refusal(text);
    EXPECT_TRUE(message.starts_with("a.gcode:6: ")) << bad.line << ": " << message;
    EXPECT_NE(message.find(bad.reason), message.npos) << bad.line << ": " << message;
    EXPECT_EQ(message.find('\n'), message.npos) << message;
  }
}

TEST(GcodeReader, MaterialNeedsAPlace) {
  EXPECT_EQ(refusal("M83\nG1 X1 E1\n"),
            "a.gcode:2: material is laid before any move has said where X is: "
            "a travel, G28 or G92 has to come first");
  EXPECT_EQ(refusal("M83\nG0 X1 Y1\nG1 X2 E1\n"),
            "a.gcode:3: material is laid before any move has said where Z is: "
            "a travel, G28 or G92 has to come first");
  EXPECT_EQ(refusal("M83\nG91\nG0 X1 Y1 Z1\nG1 X2 E1\n"),
            "a.gcode:4: material is laid before any move has said where X is: "
            "a travel, G28 or G92 has to come first");
  EXPECT_EQ(refusal("G2 X1 Y1 I1\n"), "a.gcode:1: an arc begins at an unknown place");
}

TEST(GcodeReader, AFileWithoutMaterialIsRefused) {
  const std::string nothing =
      "a.gcode: lays no material: no move in X or Y has a word E that pushes filament";
  EXPECT_EQ(refusal(""), nothing);
  EXPECT_EQ(refusal(kStart + "G0 X5\nG1 X6 A1\n"), nothing);
  EXPECT_EQ(refusal(kStart + ";TYPE:Skirt\nG1 X5 E1\n"),
            "a.gcode: lays no material that is part of a model");
  EXPECT_NE(refusal("GCDE\x01").find("a.gcode:1: this is binary G-code"), std::string::npos);
  for (const char* text : {"\x1F\x8B\x08", "PK\x03\x04"})
    EXPECT_EQ(refusal(text), "a.gcode:1: this is a compressed file; unpack it");
  for (const std::string& text : {std::string("\xFF\xFEG\0", 4), std::string("\xFE\xFF\0G", 4),
                                  std::string("\0G\0", 3), std::string("G\0", 2)})
    EXPECT_EQ(refusal(text),
              "a.gcode:1: this is UTF-16 or no text at all; G-code is plain text, in ASCII or "
              "UTF-8");
  EXPECT_NE(refusal(kStart + std::string(3'000'000, ' ')).find("a.gcode:6: the line is longer"),
            std::string::npos);
  EXPECT_THROW(static_cast<void>(read_gcode_file("/no/such.gcode", {})), Error);
  EXPECT_THROW(static_cast<void>(read_gcode_file("/tmp", {})), Error);
}

}  // namespace
}  // namespace routebench
