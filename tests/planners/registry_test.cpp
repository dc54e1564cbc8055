#include "routebench/planning/registry.hpp"

#include <gtest/gtest.h>

#include <string>

#include "routebench/geometry/error.hpp"
#include "routebench/planning/plugin.hpp"

namespace routebench {
namespace {

/// Lays one stroke whose length is its parameter, so that a test sees which value arrived.
class Ruler final : public Planner {
 public:
  struct Params {
    double length_mm = 5;
    void bind(ParamBinder& bind) { bind("length_mm", length_mm, {1, 10}, "mm", "of the stroke"); }
  };
  static PlannerInfo info() { return {"ruler", PlannerRole::kFill, "one stroke", "a test"}; }
  explicit Ruler(const Params& params) : params_(params) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext& context) const override {
    return {{{{{0, 0}, {params_.length_mm, 0}}, context.line_width_mm}}};
  }

 private:
  Params params_;
};

class BadName final : public Planner {
 public:
  struct Params {
    void bind(ParamBinder&) {}
  };
  static PlannerInfo info() { return {"Bad Name", PlannerRole::kFill, "", ""}; }
  explicit BadName(const Params&) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override { return {}; }
};

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    return error.what();
  }
  return "";
}

TEST(Registry, KnowsWhatWasAdded) {
  Registry registry;
  registry.set_origin("a file");
  registry.add<Ruler>();
  const Registry::Entry& entry = registry.at("ruler");
  EXPECT_EQ(entry.info.role, PlannerRole::kFill);
  EXPECT_EQ(entry.info.source, "a test");
  EXPECT_EQ(entry.origin, "a file");
  ASSERT_EQ(entry.params.size(), 1U);
  EXPECT_EQ(entry.params[0].name, "length_mm");
}

TEST(Registry, MakesPlannersFromParameters) {
  Registry registry;
  registry.add<Ruler>();
  const auto made = registry.at("ruler").make({{"length_mm", 7.0}});
  EXPECT_EQ(made->plan({}, {}).strokes[0].points[1], (Point2{7, 0}));
  EXPECT_EQ(registry.at("ruler").make({})->plan({}, {}).strokes[0].points[1], (Point2{5, 0}));
  EXPECT_EQ(registry.at("ruler").resolve({}), (ParamSet{{"length_mm", 5.0}}));
}

TEST(Registry, RefusesBadParametersByPlannerAndName) {
  Registry registry;
  registry.add<Ruler>();
  for (const ParamSet& bad : {ParamSet{{"length_mm", 11.0}}, ParamSet{{"lenght_mm", 2.0}}}) {
    const std::string made = refusal([&] { (void)registry.at("ruler").make(bad); });
    EXPECT_NE(made.find("planner ruler"), std::string::npos) << made;
    EXPECT_NE(made.find("length_mm"), std::string::npos) << made;
    EXPECT_EQ(refusal([&] { (void)registry.at("ruler").resolve(bad); }), made);
  }
}

TEST(Registry, RefusesANameThatIsTakenAndSaysByWhom) {
  Registry registry;
  registry.set_origin("first.so");
  registry.add<Ruler>();
  registry.set_origin("second.so");
  const std::string message = refusal([&] { registry.add<Ruler>(); });
  EXPECT_NE(message.find("ruler"), std::string::npos) << message;
  EXPECT_NE(message.find("first.so"), std::string::npos) << message;
  EXPECT_EQ(registry.at("ruler").origin, "first.so");
}

TEST(Registry, RefusesANameThatNoConfigCouldWrite) {
  Registry registry;
  EXPECT_NE(refusal([&] { registry.add<BadName>(); }).find("'Bad Name'"), std::string::npos);
  EXPECT_TRUE(registry.entries().empty());
}

TEST(Registry, UnknownPlannerIsRefusedWithTheNearest) {
  Registry registry;
  EXPECT_NE(refusal([&] { (void)registry.at("rular"); }).find("there are none"), std::string::npos);
  registry.add<Ruler>();
  const std::string message = refusal([&] { (void)registry.at("rular"); });
  EXPECT_NE(message.find("did you mean 'ruler'"), std::string::npos) << message;
}

TEST(Registry, BuiltInPlannersSayWhereTheyComeFrom) {
  Registry registry;
  register_builtin_planners(registry);
  for (const auto& [name, entry] : registry.entries()) {
    EXPECT_EQ(name, entry.info.name);
    EXPECT_EQ(entry.origin, "built in");
    EXPECT_FALSE(entry.info.summary.empty()) << name;
    for (const ParamSchema& param : entry.params) EXPECT_FALSE(param.help.empty()) << param.name;
  }
}

}  // namespace
}  // namespace routebench
