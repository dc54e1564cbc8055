/// Walls of parts as thin as a few lines, by the judge.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "planning.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

using test::layer_of;
using test::word;

struct ThinPart {
  std::string name;
  Polygons polygons;
};

/// Parts of one width: a strip along the axes, a slanted one, a frame and a ring.
std::vector<ThinPart> parts_of(double width_mm) {
  const auto rectangle = [](double inset) {
    return test::rectangle(inset, inset, 20 - inset, 20 - inset);
  };
  Ring slanted;
  for (const Point2 p : {Point2{0, 0}, Point2{30, 0}, Point2{30, width_mm}, Point2{0, width_mm}})
    slanted.push_back(snap(Point2{std::cos(0.4) * p.x - std::sin(0.4) * p.y,
                                  std::sin(0.4) * p.x + std::cos(0.4) * p.y}));
  return {{"strip", {{test::rectangle(0, 0, 30, width_mm), {}}}},
          {"slanted strip", {{slanted, {}}}},
          {"frame", {{rectangle(0), {test::reversed(rectangle(width_mm))}}}},
          {"ring",
           {{test::circle({10, 10}, 10, 200),
             {test::reversed(test::circle({10, 10}, 10 - width_mm, 200))}}}}};
}

struct Judged {
  Verdict verdict;
  Scores scores;
  [[nodiscard]] double value(const char* metric) const {
    return scores.at(metric_index(metric)).value();
  }
};

/// By greedy_shell and rectilinear with two walls.
Judged judged(const Polygons& polygons, double density, const ParamSet& shell_params = {}) {
  Task task;
  task.density = density;
  Registry registry;
  register_builtin_planners(registry);
  const ContenderSpec spec{"two walls", SlotSpec{"greedy_shell", shell_params},
                           SlotSpec{"rectilinear", {}}};
  const Contender contender(spec, registry);
  const Judge judge(task, Printer{});
  std::vector<LayerScore> layers;
  for (int index = 0; index < 2; ++index) {
    const Layer layer = layer_of(polygons, index);
    const Demand demand = demand_of(layer, task);
    const PlannedLayer planned = contender.plan(layer, demand, task, {0, 0}, 1, {});
    layers.push_back(judge.score(layer, demand, planned.route, std::nullopt));
  }
  const Scores totals = judge.total(layers);
  return {judge.verdict(totals), totals};
}

TEST(ThinWalls, OfAnyWidthAreValid) {
  for (int i = 16; i <= 80; ++i)
    for (const ThinPart& part : parts_of(i / 40.0))
      for (const double density : {0.2, 1.0}) {
        const Judged result = judged(part.polygons, density);
        EXPECT_EQ(result.verdict.outcome, Outcome::kValid)
            << part.name << " of " << i / 40.0 << " mm at " << density << ": "
            << result.verdict.reason;
        EXPECT_EQ(result.value("hollow_mm"), 0);
        EXPECT_GE(result.value("covered"), 0.96);  // the strip between second walls may stay open
      }
}

TEST(ThinWalls, NoBeadInsideAThirdOfAMillimetreHoldsEnough) {
  // A bead 0.3 mm wide and 0.2 mm high has the section of a strip 0.257 mm wide: 86 % of the part,
  // and less by what its ends lack. All of it is reached.
  for (const ThinPart& part : parts_of(0.3)) {
    const Judged result = judged(part.polygons, 1);
    EXPECT_GE(result.value("covered"), 0.97) << part.name;
    EXPECT_GE(result.value("deposit"), 0.82) << part.name;
    EXPECT_LE(result.value("deposit"), 0.857) << part.name;
  }
}

TEST(ThinWalls, AutoIsNeverFartherFromWhatIsNeededThanAWallThereAndBack) {
  for (int tenths = 4; tenths <= 20; ++tenths)
    for (const ThinPart& part : parts_of(tenths / 10.0)) {
      const double once = judged(part.polygons, 1).value("deposit");
      const double twice = judged(part.polygons, 1, {{"thin", word("double")}}).value("deposit");
      EXPECT_LE(std::abs(once - 1), std::abs(twice - 1) + 0.01) << part.name << ", " << tenths;
    }
}

TEST(ThinWalls, ShortStripsKeepTheirWalls) {
  // A strip whose line would lack its ends, and one that is long.
  const PlanContext context = test::context_for(2, 1);
  const double near_mm = context.spacing_mm / 2;
  const auto left = [&](double length_mm) {
    const Polygons strip{{test::rectangle(0, 0, length_mm, 0.125), {}}};
    return area_mm2(without_strips(strip, {}, context.spacing_mm / 2, near_mm, context)) /
           (0.125 * length_mm);
  };
  EXPECT_NEAR(left(0.5), 1, 1e-9);
  EXPECT_NEAR(left(1), 1, 1e-9);
  EXPECT_EQ(left(10), 0);
  EXPECT_EQ(left(30), 0);
}

TEST(ThinWalls, OnlyTheStripIsTakenFromAWall) {
  // A square with an arm: the arm goes, the square stays.
  const PlanContext context = test::context_for(2, 1);
  const Polygons region{
      {{{0, 0}, {5, 0}, {5, 2}, {15, 2}, {15, 2.125}, {5, 2.125}, {5, 5}, {0, 5}}, {}}};
  const Polygons left = without_strips(region, offset(region, -context.spacing_mm),
                                       context.spacing_mm / 2, context.spacing_mm / 2, context);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_NEAR(area_mm2(left), 25, 0.1);
  EXPECT_LE(area_mm2(subtract(left, region)), 1e-6);
}

}  // namespace
}  // namespace routebench
