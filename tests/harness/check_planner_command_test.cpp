#include <set>

#include "program.hpp"

namespace routebench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class CheckPlannerCommand : public test::ProgramTest {};

TEST_F(CheckPlannerCommand, ABuiltInPlannerPasses) {
  const test::ProgramRun run = call({"check-planner", "greedy_shell", "--json", "-"});
  ASSERT_EQ(run.exit_code, 0) << run.out << run.err;
  const json document = run.json();
  EXPECT_EQ(document["planner"], "greedy_shell");
  EXPECT_EQ(document["role"], "shell");
  for (const json& check : document["checks"]) EXPECT_TRUE(check["passed"]) << check;
  for (const json& step : document["ladder"]) EXPECT_EQ(step["problem"], "");
}

TEST_F(CheckPlannerCommand, WhatFailsIsNamedAndDrawn) {
  // "hatch" fills bounding boxes: right for rectangles only.
  const std::string pictures = in_folder("pictures");
  const test::ProgramRun run =
      call({"check-planner", "hatch", "--plugin", ROUTEBENCH_CULPRIT_PLUGIN, "--svg", pictures,
            "--json", in_folder("found.json")});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.out.find("FAIL  inside"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("on ring with "), std::string::npos) << run.out;
  EXPECT_NE(test::content_of(fs::path(pictures) / "inside-ring.svg").find("<svg"),
            std::string::npos);
  std::set<std::string> passed;
  const json found = json::parse(test::content_of(in_folder("found.json")));
  for (const json& check : found["checks"])
    if (check["passed"]) passed.insert(check["name"]);
  EXPECT_TRUE(passed.contains("pure"));
  EXPECT_FALSE(passed.contains("inside"));
}

TEST_F(CheckPlannerCommand, UnknownPlannersAreRefused) {
  expect_refused({"check-planner", "rectilinaer"}, "rectilinear");
  expect_refused({"check-planner", "x", "--plugin", in_folder("no.so")}, "no such file");
}

}  // namespace
}  // namespace routebench
