#include "routebench/planning/params.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

enum class Search { kBucket, kSweep };

struct Params {
  double angle_deg = 45;
  int loops = 2;
  bool alternate = true;
  Search search = Search::kSweep;

  void bind(ParamBinder& bind) {
    bind("angle_deg", angle_deg, {-180, 180}, "deg", "direction");
    bind("loops", loops, {1, 9}, "", "how often");
    bind("alternate", alternate, "turn on odd layers");
    bind("search", search, {{"bucket", Search::kBucket}, {"sweep", Search::kSweep}}, "crossings");
  }
};

Params bound(const ParamSet& values) {
  Params params;
  ParamBinder bind("planner test", values);
  params.bind(bind);
  bind.finish();
  return params;
}

/// The message with which values are refused; empty if they are taken.
std::string refusal(const ParamSet& values) {
  try {
    bound(values);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    return error.what();
  }
  return "";
}

void expect_refused(const ParamSet& values, const std::vector<std::string>& mentions) {
  const std::string message = refusal(values);
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& part : mentions) {
    EXPECT_NE(message.find(part), std::string::npos)
        << "'" << message << "' lacks '" << part << "'";
  }
}

TEST(Params, SchemaComesFromTheBindings) {
  Params params;
  ParamBinder bind;
  params.bind(bind);
  ASSERT_EQ(bind.schema().size(), 4U);
  const ParamSchema& angle = bind.schema()[0];
  EXPECT_EQ(angle.name, "angle_deg");
  EXPECT_EQ(angle.type, ParamType::kReal);
  EXPECT_EQ(angle.default_value, ParamValue(45.0));
  EXPECT_EQ(angle.lowest, -180);
  EXPECT_EQ(angle.highest, 180);
  EXPECT_EQ(angle.unit, "deg");
  EXPECT_EQ(angle.help, "direction");
  EXPECT_EQ(bind.schema()[1].type, ParamType::kInt);
  EXPECT_EQ(bind.schema()[1].default_value, ParamValue(std::int64_t{2}));
  EXPECT_EQ(bind.schema()[2].type, ParamType::kBool);
  EXPECT_FALSE(bind.schema()[2].lowest);
  const ParamSchema& search = bind.schema()[3];
  EXPECT_EQ(search.type, ParamType::kChoice);
  EXPECT_EQ(search.default_value, ParamValue(std::string("sweep")));
  EXPECT_EQ(search.choices, (std::vector<std::string>{"bucket", "sweep"}));
}

TEST(Params, ValuesReachTheMembersAndTheRestKeepsItsDefault) {
  const Params params =
      bound({{"angle_deg", -30.5}, {"loops", std::int64_t{7}}, {"search", "bucket"}});
  EXPECT_EQ(params.angle_deg, -30.5);
  EXPECT_EQ(params.loops, 7);
  EXPECT_EQ(params.search, Search::kBucket);
  EXPECT_TRUE(params.alternate);
}

TEST(Params, EveryValueOfTheSchemaIsTaken) {
  for (const double angle : {-180.0, 0.0, 180.0}) EXPECT_EQ(refusal({{"angle_deg", angle}}), "");
  for (const std::int64_t loops : {1, 9}) EXPECT_EQ(refusal({{"loops", loops}}), "");
  for (const bool yes : {false, true}) EXPECT_EQ(refusal({{"alternate", yes}}), "");
  for (const char* name : {"bucket", "sweep"}) EXPECT_EQ(refusal({{"search", name}}), "");
}

TEST(Params, AWholeNumberServesAsARealOne) {
  EXPECT_EQ(bound({{"angle_deg", std::int64_t{90}}}).angle_deg, 90.0);
}

TEST(Params, TheRecordHoldsEveryParameterAndDoesNotDependOnHowItWasWritten) {
  const auto resolved = [](const ParamSet& values) {
    Params params;
    ParamBinder bind("planner test", values);
    params.bind(bind);
    return bind.resolved();
  };
  const ParamSet all{{"angle_deg", 90.0},
                     {"loops", std::int64_t{2}},
                     {"alternate", true},
                     {"search", std::string("sweep")}};
  EXPECT_EQ(resolved({{"angle_deg", std::int64_t{90}}}), all);
  EXPECT_EQ(resolved({{"angle_deg", 90.0}}), all);
  EXPECT_EQ(resolved(all), all);
}

TEST(Params, OutOfRangeIsRefusedWithRangeAndUnit) {
  expect_refused({{"angle_deg", 400.0}},
                 {"planner test", "angle_deg", "400", "-180", "180", "deg"});
  expect_refused({{"loops", std::int64_t{0}}}, {"loops", "0", "1", "9"});
  expect_refused({{"loops", std::int64_t{1} << 40}}, {"loops", "1099511627776"});
}

TEST(Params, NotANumberAndInfinityAreRefused) {
  expect_refused({{"angle_deg", std::nan("")}}, {"angle_deg", "nan"});
  expect_refused({{"angle_deg", std::numeric_limits<double>::infinity()}}, {"angle_deg", "inf"});
}

TEST(Params, WrongTypesAreRefused) {
  expect_refused({{"angle_deg", std::string("steep")}}, {"angle_deg", "'steep'", "number"});
  expect_refused({{"angle_deg", true}}, {"angle_deg", "true", "number"});
  expect_refused({{"loops", 2.5}}, {"loops", "2.5", "whole number"});
  expect_refused({{"alternate", std::int64_t{1}}}, {"alternate", "1", "true or false"});
  expect_refused({{"search", std::int64_t{1}}}, {"search", "bucket, sweep"});
}

TEST(Params, UnknownChoiceIsRefusedWithTheNearest) {
  expect_refused({{"search", std::string("bukcet")}},
                 {"search", "'bukcet'", "bucket, sweep", "did you mean 'bucket'"});
}

TEST(Params, UnknownNameIsRefusedWithTheNearest) {
  expect_refused({{"angel_deg", 3.0}},
                 {"planner test", "'angel_deg'", "did you mean 'angle_deg'", "loops"});
  const std::string far_off = refusal({{"nozzle", 3.0}});
  EXPECT_EQ(far_off.find("did you mean"), std::string::npos) << far_off;
  EXPECT_NE(far_off.find("angle_deg, loops, alternate, search"), std::string::npos) << far_off;
}

TEST(Params, APlannerThatBindsANameTwiceIsAtFault) {
  double one = 0;
  double two = 0;
  ParamBinder bind("planner test", {});
  bind("one", one, {0, 1}, "", "");
  EXPECT_THROW(bind("one", two, {0, 1}, "", ""), Error);
}

TEST(Params, ADefaultOutsideOfItsRangeIsAtFault) {
  double one = 2;
  ParamBinder bind("planner test", {});
  EXPECT_THROW(bind("one", one, {0, 1}, "", ""), Error);
}

TEST(Params, ValuesAreWrittenAsAConfigHasThem) {
  EXPECT_EQ(to_string(ParamValue(true)), "true");
  EXPECT_EQ(to_string(ParamValue(false)), "false");
  EXPECT_EQ(to_string(ParamValue(std::int64_t{-3})), "-3");
  EXPECT_EQ(to_string(ParamValue(0.25)), "0.25");
  EXPECT_EQ(to_string(ParamValue(0.1)), "0.1");
  EXPECT_EQ(to_string(ParamValue(std::string("grid"))), "grid");
}

TEST(NearestName, FindsSlipsOfThePen) {
  const std::vector<std::string> names{"angle_deg", "spacing", "search"};
  EXPECT_EQ(nearest_name("spaceing", names), "spacing");
  EXPECT_EQ(nearest_name("spcaing", names), "spacing");
  EXPECT_EQ(nearest_name("serch", names), "search");
  EXPECT_EQ(nearest_name("angle", names), "angle_deg");
  EXPECT_EQ(nearest_name("search", names), "search");
}

TEST(NearestName, KeepsQuietWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("temperature", {"angle_deg", "search"}), std::nullopt);
  EXPECT_EQ(nearest_name("", {"angle_deg", "search"}), std::nullopt);
  EXPECT_EQ(nearest_name("word", {}), std::nullopt);
}

TEST(NearestName, DoesNotDependOnTheOrderOfTheCandidates) {
  EXPECT_EQ(nearest_name("walk", {"wall", "talk"}), "talk");
  EXPECT_EQ(nearest_name("walk", {"talk", "wall"}), "talk");
}

}  // namespace
}  // namespace routebench
