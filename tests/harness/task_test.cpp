#include "routebench/harness/task.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <string>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

/// What an action is refused with; fails the test if it is not refused as bad input in one line.
std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "not refused";
  return "";
}

std::string task_refusal(std::string_view key, std::string_view value) {
  Task task;
  return refusal([&] { set_task_value(task, key, value); });
}

std::string printer_refusal(std::string_view key, std::string_view value) {
  Printer printer;
  return refusal([&] { set_printer_value(printer, key, value); });
}

std::string value_of(const std::vector<KeyValue>& values, std::string_view key) {
  const auto found = std::ranges::find(values, key, &KeyValue::key);
  return found == values.end() ? "(no such key)" : found->value;
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(Task, BeadsAtTheirSpacingFillTheLayerExactly) {
  Task task;
  task.line_width_mm = 0.45;
  task.layer_height_mm = 0.2;
  EXPECT_NEAR(task.spacing_mm(), 0.45 - 0.2 * (1 - std::numbers::pi / 4), 1e-15);
  const double rectangle_with_round_ends = (0.45 - 0.2) * 0.2 + std::numbers::pi * 0.2 * 0.2 / 4;
  EXPECT_NEAR(task.bead_section_mm2(), rectangle_with_round_ends, 1e-15);
}

TEST(Task, EveryListedValueCanBeSetAgain) {
  Task task;
  set_task_value(task, "layer_height_mm", "0.1");
  set_task_value(task, "perimeters", "0");
  set_task_value(task, "density", "1");
  set_task_value(task, "start_mm", "-1.25, 3e2");
  set_task_value(task, "gate_deposit_max", "1.5");
  EXPECT_EQ(task.start_mm, (Point2{-1.25, 300}));
  set_task_value(task, "skin_rule", "slope");
  Task copy;
  for (const KeyValue& entry : task_values(task)) set_task_value(copy, entry.key, entry.value);
  ASSERT_EQ(task_values(task).size(), 18U);
  for (const KeyValue& entry : task_values(task))
    EXPECT_EQ(value_of(task_values(copy), entry.key), entry.value) << entry.key;
  EXPECT_EQ(value_of(task_values(copy), "layer_height_mm"), "0.1");
  EXPECT_EQ(value_of(task_values(copy), "line_width_mm"), "0.45");
  EXPECT_EQ(value_of(task_values(copy), "start_mm"), "-1.25,300");
  EXPECT_EQ(value_of(task_values(copy), "skin_rule"), "slope");
}

TEST(Task, EveryListedPrinterValueCanBeSetAgain) {
  Printer printer;
  set_printer_value(printer, "retract_policy", "length_and_crossing");
  set_printer_value(printer, "travel_mm_s", "200.5");
  Printer copy;
  for (const KeyValue& entry : printer_values(printer))
    set_printer_value(copy, entry.key, entry.value);
  ASSERT_EQ(printer_values(printer).size(), 12U);
  for (const KeyValue& entry : printer_values(printer))
    EXPECT_EQ(value_of(printer_values(copy), entry.key), entry.value) << entry.key;
  EXPECT_EQ(copy.retract_policy, RetractPolicy::kLengthAndCrossing);
  EXPECT_EQ(value_of(printer_values(copy), "flavour"), "marlin");
}

TEST(Task, NegativeZeroIsZero) {
  Task task;
  set_task_value(task, "density", "-0");
  set_task_value(task, "start_mm", "-0,-0.0");
  EXPECT_EQ(value_of(task_values(task), "density"), "0");
  EXPECT_EQ(value_of(task_values(task), "start_mm"), "0,0");
}

TEST(Task, UnknownKeysAreRefusedWithTheNearestOne) {
  const std::string message = task_refusal("layer_hieght_mm", "0.2");
  EXPECT_TRUE(contains(message, "'layer_hieght_mm'")) << message;
  EXPECT_TRUE(contains(message, "did you mean 'layer_height_mm'")) << message;
  EXPECT_TRUE(contains(printer_refusal("retract_over", "2"), "'retract_over_mm'"));
  const std::string far = task_refusal("qqqqqqqqqqqqqqqqqqqqqqqqqqqqqq", "1");
  EXPECT_TRUE(contains(far, "known keys are layer_height_mm, line_width_mm")) << far;
  // A key of the one table is none of the other.
  EXPECT_TRUE(contains(task_refusal("travel_mm_s", "1"), "unknown key"));
}

TEST(Task, ValuesThatCannotBeMeantAreRefusedByName) {
  for (const std::string_view text : {"", " ", "thick", "0.2mm", "0,2", "nan", "inf", "-inf",
                                      "1e999", "0x1p3", "0", "-0.2", "101", "0.2 0.3", "true"}) {
    const std::string message = task_refusal("layer_height_mm", text);
    EXPECT_TRUE(contains(message, "layer_height_mm = '" + std::string(text) + "'")) << message;
    EXPECT_TRUE(contains(message, "a number from 0.001 to 100 mm")) << message;
  }
  for (const std::string_view text : {"-1", "1.5", "two", "", "99999999999999999999", "10001"})
    EXPECT_TRUE(contains(task_refusal("perimeters", text), "a whole number from 0 to 10000"));
  for (const std::string_view text : {"", "1", "1,", ",1", "1,2,3", "a,b", "nan,0", "1e9,0"})
    EXPECT_TRUE(contains(task_refusal("start_mm", text), "two numbers \"x,y\"")) << text;
  const std::string policy = printer_refusal("retract_policy", "lenght");
  EXPECT_TRUE(contains(policy, "length, length_and_crossing, manhattan")) << policy;
  EXPECT_TRUE(contains(policy, "did you mean 'length'")) << policy;
  EXPECT_TRUE(contains(printer_refusal("flavour", "5D"),
                       "is not one of marlin, klipper, reprap, ultigcode"));
  EXPECT_TRUE(contains(printer_refusal("accel_mm_s2", "0"), "accel_mm_s2 = '0'"));
}

TEST(Task, ARefusedValueChangesNothing) {
  Task task;
  EXPECT_THROW(set_task_value(task, "density", "1.01"), Error);
  EXPECT_EQ(task.density, Task{}.density);
}

TEST(Task, KeysAreCheckedAgainstEachOtherOnceAllAreSet) {
  Task task;
  check_task(task);
  set_task_value(task, "layer_height_mm", "0.6");  // for a moment higher than wide
  EXPECT_TRUE(contains(refusal([&] { check_task(task); }),
                       "line_width_mm = 0.45 is less than layer_height_mm = 0.6"));
  set_task_value(task, "line_width_mm", "0.6");
  check_task(task);
  set_task_value(task, "gate_deposit_min", "1.2");
  EXPECT_TRUE(contains(refusal([&] { check_task(task); }), "gate_deposit_min = 1.2"));
}

}  // namespace
}  // namespace routebench
