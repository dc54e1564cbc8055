#include "json_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace routebench {
namespace {

TEST(JsonParts, ScoresReadBackExactly) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> exponent(-12, 15);
  for (int round = 0; round < 2000; ++round) {
    Scores scores(metric_table().size());
    for (auto& score : scores) score = std::pow(10, exponent(random));
    const Json read = Json::parse(text_of(json_of(scores)));
    for (std::size_t i = 0; i < scores.size(); ++i)
      EXPECT_EQ(read[std::string(metric_table()[i].name)].get<double>(), *scores[i]);
  }
}

TEST(JsonParts, ZeroIsAValueAndAbsenceIsNull) {
  Scores scores(metric_table().size());
  scores[metric_index("travel_mm")] = 0;
  scores[metric_index("travels")] = 12;
  scores[metric_index("covered")] = std::numeric_limits<double>::quiet_NaN();
  const Json json = json_of(scores);
  EXPECT_EQ(json["travel_mm"].dump(), "0");
  EXPECT_EQ(json["travels"].dump(), "12");
  EXPECT_EQ(json["covered"].dump(), "null");
  EXPECT_EQ(json["extrude_mm"].dump(), "null");
}

TEST(JsonParts, TasksHaveTypedValues) {
  Task task;
  task.start_mm = {1.5, -2};
  const Json json = json_of(task);
  EXPECT_EQ(json["perimeters"].dump(), "2");
  EXPECT_EQ(json["density"].dump(), "0.2");
  EXPECT_EQ(json["start_mm"].dump(), "[1.5,-2]");
  EXPECT_EQ(json_of(Printer{})["retract_policy"].dump(), "\"length\"");
}

TEST(JsonParts, BytesThatAreNoTextDoNotBreakADocument) {
  const Json json = {{"model", "caf\xe9.stl"}};
  EXPECT_EQ(Json::parse(text_of(json))["model"], "caf\xef\xbf\xbd.stl");
}

TEST(JsonParts, StrokesTellKindWidthAndPoints) {
  const PlannedLayer planned{{{{{{0, 0.5}, {1, 2}}, 0.45}}}, {StrokeKind::kSparse}, 0, 0};
  EXPECT_EQ(text_of(json_of(planned), true),
            R"([{"kind":"sparse","width_mm":0.45,"points":[[0.0,0.5],[1.0,2.0]]}])");
}

}  // namespace
}  // namespace routebench
