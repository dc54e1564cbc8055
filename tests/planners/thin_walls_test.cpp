/// Walls of parts as thin as a few lines, by the judge.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "planning.hpp"
#include "polygons.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/planning/walls.hpp"
#include "src/near_sides.hpp"

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

/// By greedy_shell and a fill planner.
Judged judged(const Polygons& polygons, double density, const ParamSet& shell_params = {},
              int walls = 2, const std::string& fill = "rectilinear") {
  Task task;
  task.density = density;
  task.perimeters = walls;
  Registry registry;
  register_builtin_planners(registry);
  const ContenderSpec spec{"walls", SlotSpec{"greedy_shell", shell_params}, SlotSpec{fill, {}}};
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

TEST(ThinWalls, HardlyWiderThanWhatWallsTakeAreValid) {
  // Facets of the two sides do not face each other, so the wall's region is a chain of slivers.
  for (const int walls : {1, 2})
    for (int i = -5; i <= 20; ++i) {
      const double width_mm = 0.45 + (walls - 1) * 2 * 0.4070796 + i / 500.0;
      const Polygon ring{test::circle({10, 10}, 10, 200),
                         {test::reversed(test::circle({10, 10}, 10 - width_mm, 170))}};
      const Judged result = judged({ring}, 1);
      EXPECT_EQ(result.verdict.outcome, Outcome::kValid)
          << width_mm << " mm: " << result.verdict.reason;
      EXPECT_LE(result.value("doubled"), 0.1) << width_mm;
    }
}

TEST(ThinWalls, ThatWidenSlowlyAreValid) {
  for (const double least_mm : {0.4, 0.42, 0.45, 0.5})
    for (const double ratio : {1.2, 1.24, 1.3, 1.5}) {
      const double most_mm = ratio * least_mm;
      Ring wedge;
      for (const Point2 p : {Point2{0, -least_mm / 2}, Point2{40, -most_mm / 2},
                             Point2{40, most_mm / 2}, Point2{0, least_mm / 2}})
        wedge.push_back(snap(p));
      const Judged result = judged({{wedge, {}}}, 1);
      EXPECT_EQ(result.verdict.outcome, Outcome::kValid)
          << least_mm << " to " << most_mm << " mm: " << result.verdict.reason;
    }
}

TEST(ThinWalls, GetNoMoreThanTheyNeedOfSparseFillBetweenThem) {
  const auto expect_valid = [](const std::string& fill, int walls, double width_mm,
                               double density) {
    const Polygon frame{
        test::rectangle(0, 0, 60, 60),
        {test::reversed(test::rectangle(width_mm, width_mm, 60 - width_mm, 60 - width_mm))}};
    const Judged result = judged({frame}, density, {}, walls, fill);
    EXPECT_EQ(result.verdict.outcome, Outcome::kValid)
        << fill << ", " << walls << " walls, " << width_mm << " mm at " << density << ": "
        << result.verdict.reason;
  };
  for (const int walls : {1, 2, 3})
    for (int fifths = 5; fifths <= 30; ++fifths)
      for (const double density : {0.1, 0.2, 0.3}) {
        expect_valid("rectilinear", walls, fifths / 5.0, density);
        // Whole loops cannot always be nearer to what is needed.
        if (walls > 1 && density < 0.3) expect_valid("concentric", walls, fifths / 5.0, density);
      }
}

TEST(ThinWalls, ThatStandOnOthersAreValid) {
  // A comb: its teeth have one end of their own, so shorter ones than of strips get one line.
  for (const double width_mm : {0.46, 0.5, 0.55, 0.6, 0.7})
    for (int length_mm = 3; length_mm <= 8; ++length_mm) {
      const double far = 2.25 + length_mm;
      Ring comb{{0, 0}, {30, 0}};
      for (int tooth = 19; tooth >= 0; --tooth) {
        const double x = 1.5 * tooth;
        comb.insert(comb.end(), {snap(Point2{x + width_mm, 2.25}), snap(Point2{x + width_mm, far}),
                                 snap(Point2{x, far}), snap(Point2{x, 2.25})});
      }
      comb.insert(comb.begin() + 2, {30, 2.25});
      const Judged result = judged({{comb, {}}}, 1);
      EXPECT_EQ(result.verdict.outcome, Outcome::kValid)
          << width_mm << " x " << length_mm << " mm: " << result.verdict.reason;
      EXPECT_LE(result.value("doubled"), 0.05) << width_mm << " x " << length_mm;
    }
}

TEST(ThinWalls, ScrapsStayWhereNoLineFits) {
  // Two parts of a wall's region, in a place hardly longer than they are and in a long one.
  const PlanContext context = test::context_for(2, 1);
  const double half_mm = context.line_width_mm / 2;
  const Polygons scraps{{test::rectangle(0, 0, 0.5, 0.0625), {}},
                        {test::rectangle(1, 0, 1.5, 0.0625), {}}};
  const auto left = [&](double beyond_mm) {
    const Polygons place{
        {test::rectangle(-beyond_mm, -half_mm, 1.5 + beyond_mm, 0.0625 + half_mm), {}}};
    return without_scraps(scraps, place, half_mm, 0.25, context).size();
  };
  EXPECT_EQ(left(half_mm), 2U);
  EXPECT_EQ(left(10), 0U);
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
    return area_mm2(without_strips(strip, context.spacing_mm / 2, near_mm, context)) /
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
  const Polygons left =
      without_strips(region, context.spacing_mm / 2, context.spacing_mm / 2, context);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_NEAR(area_mm2(left), 25, 0.1);
  EXPECT_LE(area_mm2(subtract(left, region)), 1e-6);
}

/// A polygon along a bent line, of one width.
Polygon bent_strip(double length_mm, double width_mm, double bend, double angle_deg, int pieces) {
  const double angle = angle_deg * std::numbers::pi / 180;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  Ring left, right;
  for (int i = 0; i <= pieces; ++i) {
    const double t = bend * (1.0 * i / pieces - 0.5), radius = length_mm / bend;
    for (const double side : {-1.0, 1.0}) {
      const Point2 p{(radius + side * width_mm / 2) * std::cos(t),
                     (radius + side * width_mm / 2) * std::sin(t)};
      (side < 0 ? left : right)
          .push_back(snap(Point2{cosine * p.x - sine * p.y, sine * p.x + cosine * p.y}));
    }
  }
  right.insert(right.end(), left.rbegin(), left.rend());
  return {right, {}};
}

TEST(NearSides, AreInWhateverIsNarrowAndLong) {
  for (int i = 0; i < 200; ++i) {
    const double width_mm = 0.05 + 0.01 * (i % 30), length_mm = 1.5 + 0.07 * (i % 41);
    const Polygon strip =
        bent_strip(length_mm, width_mm, 0.1 + 0.02 * (i % 37), 7.7 * i, i % 2 == 0 ? 24 : 8);
    EXPECT_TRUE(has_near_sides(strip, width_mm + 0.01, 0.75 * length_mm)) << i;
    EXPECT_FALSE(has_near_sides(strip, width_mm - 0.01, 0.75 * length_mm)) << i;
    EXPECT_FALSE(has_near_sides(strip, width_mm + 0.01, 3 * length_mm)) << i;
    // The same as an arm of a wider part.
    const Polygons square{{test::rectangle(-1, -1, 1, 1), {}}};
    const Point2 end = strip.outer.front();
    Polygons arm{strip};
    for (Point2& p : arm[0].outer) p = p - end;
    const Polygons both = unite(square, arm);
    bool any = false;
    for (const Polygon& part : both) any |= has_near_sides(part, width_mm + 0.01, 0.3 * length_mm);
    EXPECT_TRUE(any || length_mm < 3.5) << i;
  }
}

TEST(NearSides, AreAcrossTheInsideOnly) {
  // A slot is narrow outside, and a ring round a hole inside.
  const Ring slotted{{0, 0}, {5, 0}, {5, 4}, {2.6, 4}, {2.6, 1}, {2.5, 1}, {2.5, 4}, {0, 4}};
  EXPECT_FALSE(has_near_sides({slotted, {}}, 0.3, 1));
  const Polygons ring =
      subtract({{test::circle({0, 0}, 2, 60), {}}}, {{test::circle({0, 0}, 1.8, 60), {}}});
  ASSERT_EQ(ring.size(), 1U);
  EXPECT_TRUE(has_near_sides(ring[0], 0.22, 100));
  EXPECT_FALSE(has_near_sides(ring[0], 0.18, 100));
  EXPECT_FALSE(has_near_sides({test::circle({0, 0}, 2, 60), {}}, 0.3, 1));
}

}  // namespace
}  // namespace routebench
