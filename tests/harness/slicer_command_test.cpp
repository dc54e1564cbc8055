/// Commands of slicers: how they are split and filled.

#include <gtest/gtest.h>

#include "routebench/geometry/error.hpp"
#include "routebench/harness/slicer_spec.hpp"
#include "slicers/command.hpp"

namespace routebench::slicers {
namespace {

using Words = std::vector<std::string>;

Words filled(const std::string& command) {
  const Task task;
  const Printer printer;
  return filled_words(command_words(command),
                      {task, printer, "/tmp/a b/m.stl", "/tmp/$HOME;x.gcode", "/tmp/f"});
}

std::string complaint(const std::string& command) {
  try {
    check_slicer({"", command, {}});
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    return error.what();
  }
  return "none";
}

TEST(SlicerCommand, WordsAreSplitAtBlanksAndKeptInQuotes) {
  EXPECT_EQ(
      filled("slice  -a\t'b c' \"d'e\" f'g h'i '' {model} {gcode}"),
      (Words{"slice", "-a", "b c", "d'e", "fg hi", "", "/tmp/a b/m.stl", "/tmp/$HOME;x.gcode"}));
}

TEST(SlicerCommand, ValuesAreNeverSplitNorReadAgain) {
  EXPECT_EQ(filled("slice --in={model} -o={gcode} {folder}"),
            (Words{"slice", "--in=/tmp/a b/m.stl", "-o=/tmp/$HOME;x.gcode", "/tmp/f"}));
}

TEST(SlicerCommand, NothingIsAShell) {
  EXPECT_EQ(filled("slice $(rm) `x` * ~ a;b >c |d &e \\n {model} {gcode}"),
            (Words{"slice", "$(rm)", "`x`", "*", "~", "a;b", ">c", "|d", "&e", "\\n",
                   "/tmp/a b/m.stl", "/tmp/$HOME;x.gcode"}));
}

TEST(SlicerCommand, TaskAndPrinterCanBeNamed) {
  EXPECT_EQ(filled("s {task.layer_height_mm}/{printer.travel_mm_s} {{x}} {model} {gcode}"),
            (Words{"s", "0.2/150", "{x}", "/tmp/a b/m.stl", "/tmp/$HOME;x.gcode"}));
}

TEST(SlicerCommand, WhatIsWrongIsSaid) {
  EXPECT_EQ(complaint("s {model} {gcode}"), "none");
  EXPECT_EQ(complaint("  "), "the command is empty");
  EXPECT_EQ(complaint("s {gcode}"),
            "the command lacks {model}; write something like \"slicer --output {gcode} {model}\"");
  EXPECT_EQ(complaint("s {model}"),
            "the command lacks {gcode}; write something like \"slicer --output {gcode} {model}\"");
  EXPECT_EQ(complaint("s {modle} {gcode}"),
            "the command has the unknown placeholder {modle}; did you mean {model}?");
  EXPECT_EQ(complaint("s {zzzzzzzz} {gcode}"),
            "the command has the unknown placeholder {zzzzzzzz}; known are {model}, {gcode}, "
            "{folder}, {task.KEY} and {printer.KEY}");
  EXPECT_EQ(complaint("s {model} {gcode} 'a"), "the command has a quote ' that is not closed");
  EXPECT_EQ(complaint("s {model} {gcode} {"),
            "the command has a brace without its partner; write {{ or }} for a brace");
  EXPECT_EQ(complaint("s {model} {gcode} }"), complaint("s {model} {gcode} {"));
  EXPECT_EQ(complaint("{model} {gcode}"),
            "the command begins with {model}; its first word must be a program");
  EXPECT_EQ(complaint("s {model}\n{gcode}"),
            "the command has a control character; write it on one line");
}

TEST(SlicerCommand, KnownNamesAreTold) {
  EXPECT_NO_THROW(check_slicer({"slic3r", "", {}}));
  try {
    check_slicer({"prusaslicer", "", {}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "unknown slicer 'prusaslicer'; did you mean prusa-slicer?");
  }
}

}  // namespace
}  // namespace routebench::slicers
