/// Laws that every score obeys, whatever the route.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

#include "random_polygons.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/judge.hpp"
#include "routes.hpp"

namespace routebench {
namespace {

/// A layer of any shape, partly skin, with an honest route and some strokes at random.
struct Case {
  Layer layer;
  Task task;
  Printer printer;
  Route route;

  explicit Case(std::uint64_t seed) {
    layer.height_mm = task.layer_height_mm;
    layer.polygons = test::random_polygons(seed, 5, 20);
    layer.solid = intersect(layer.polygons, test::random_polygons(seed + 1000, 5, 20));
    const Demand demand = demand_of(layer, task);
    route = test::walls(layer.polygons, task);
    test::append(route, test::lines(demand.dense, {task.spacing_mm(), 0.4}, task.line_width_mm));
    test::append(route, test::lines(demand.sparse, {task.spacing_mm() / task.density, -0.6},
                                    task.line_width_mm));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-2, 22);
    for (int i = 0; i < 5; ++i) {
      Stroke stray{{}, 0.3 + 0.1 * i};
      for (int k = 0; k < 4; ++k) stray.points.push_back(snap({place(random), place(random)}));
      route.strokes.push_back(std::move(stray));
    }
    std::ranges::shuffle(route.strokes, random);
  }

  [[nodiscard]] Scores score(std::optional<Point2> previous_end = std::nullopt) const {
    return Judge(task, printer).score(layer, demand_of(layer, task), route, previous_end).scores;
  }
};

/// Metrics that no printer setting and no order of strokes changes.
constexpr std::string_view kDeposited[] = {
    "extrude_mm", "covered",   "skipped",     "worst_layer",  "deposit",        "doubled",
    "spilled",    "hollow_mm", "sharp_turns", "filament_mm3", "outline_covered"};

double at(const Scores& scores, std::string_view name) {
  const std::optional<double> value = scores.at(metric_index(name));
  EXPECT_TRUE(value) << name;
  return value.value_or(0);
}

class JudgeLaw : public testing::TestWithParam<int> {
 protected:
  Case bench_{static_cast<std::uint64_t>(GetParam())};
};

TEST_P(JudgeLaw, ReversalKeepsDepositsAndInnerTravel) {
  const Scores before = bench_.score();
  std::ranges::reverse(bench_.route.strokes);
  for (Stroke& stroke : bench_.route.strokes) std::ranges::reverse(stroke.points);
  const Scores after = bench_.score();
  for (const std::string_view name : kDeposited) {
    // The passes of a run are told from the disc at its beginning, rounded as it comes.
    const double slack = name == "doubled" ? 1e-4 : 1e-9;
    EXPECT_NEAR(at(after, name), at(before, name), slack * (1 + at(before, name))) << name;
  }
  for (const std::string_view name : {"travel_mm", "travels", "retractions", "crossings",
                                      "travel_outside_mm", "max_travel_mm", "strokes"})
    EXPECT_NEAR(at(after, name), at(before, name), 1e-6) << name;
  // A chain of moves takes as long in both directions.
  for (const std::string_view name :
       {"print_time_s", "print_extrude_s", "print_travel_s", "print_retract_s"})
    EXPECT_NEAR(at(after, name), at(before, name), 1e-9 * at(before, name)) << name;
}

TEST_P(JudgeLaw, TranslationChangesNothingButSampling) {
  const Scores before = bench_.score(Point2{1, 2});
  const Point2 shift = snap(Point2{123.456, -77.7});
  const auto move_polygons = [&](Polygons& polygons) {
    for (Polygon& polygon : polygons) {
      for (Point2& p : polygon.outer) p = p + shift;
      for (Ring& hole : polygon.holes)
        for (Point2& p : hole) p = p + shift;
    }
  };
  move_polygons(bench_.layer.polygons);
  move_polygons(bench_.layer.solid);
  for (Stroke& stroke : bench_.route.strokes)
    for (Point2& p : stroke.points) p = p + shift;
  const Scores after = bench_.score(Point2{1, 2} + shift);
  for (const MetricInfo& metric : metric_table()) {
    if (metric.name.starts_with("plan_") || metric.total == Total::kCell) continue;
    EXPECT_NEAR(at(after, metric.name), at(before, metric.name),
                1e-4 * (1 + at(before, metric.name)))
        << metric.name;
  }
}

TEST_P(JudgeLaw, SplittingStrokesInPlaceChangesNothing) {
  const Scores before = bench_.score(Point2{1, 2});
  Route split;
  for (const Stroke& stroke : bench_.route.strokes)
    for (std::size_t i = 1; i < stroke.points.size(); ++i) {
      const Point2 a = stroke.points[i - 1];
      const Point2 b = stroke.points[i];
      const Point2 middle = snap(lerp(a, b, 0.3));
      split.strokes.push_back({{a, middle}, stroke.width_mm});
      split.strokes.push_back({{middle, b}, stroke.width_mm});
    }
  ASSERT_GT(split.strokes.size(), 2 * bench_.route.strokes.size());
  bench_.route = split;
  const Scores after = bench_.score(Point2{1, 2});
  for (const MetricInfo& metric : metric_table()) {
    if (metric.name.starts_with("plan_") || metric.total == Total::kCell) continue;
    EXPECT_NEAR(at(after, metric.name), at(before, metric.name),
                1e-5 * (1 + at(before, metric.name)))
        << metric.name;
  }
}

TEST_P(JudgeLaw, StrokesThatLayNothingChangeNothing) {
  const Scores before = bench_.score(Point2{1, 2});
  const Route honest = bench_.route;
  // Dots that divide travels into short ones, and such as would bridge them without any gap.
  for (const double step_mm : {0.9 * bench_.printer.retract_over_mm, 0.9 * bench_.task.join_mm}) {
    bench_.route.strokes.clear();
    for (const Stroke& stroke : honest.strokes) {
      if (!bench_.route.strokes.empty()) {
        const Point2 from = bench_.route.strokes.back().points.back(), to = stroke.points.front();
        const auto steps = static_cast<int>(std::ceil(distance(from, to) / step_mm));
        for (int i = 1; i < steps; ++i) {
          const Point2 p = snap(lerp(from, to, static_cast<double>(i) / steps));
          bench_.route.strokes.push_back({{p, p}, stroke.width_mm});
        }
      }
      bench_.route.strokes.push_back(stroke);
    }
    EXPECT_EQ(bench_.score(Point2{1, 2}), before) << step_mm;
  }
}

TEST_P(JudgeLaw, ADetourAddsItsLength) {
  const Scores before = bench_.score();
  // In the middle of a stroke: out and back again.
  Stroke& stroke = bench_.route.strokes.front();
  const Point2 a = stroke.points[0];
  const Point2 b = stroke.points[1];
  const Point2 middle = snap(lerp(a, b, 0.5));
  const Point2 aside = snap(middle + Point2{3, 4});
  stroke.points.insert(stroke.points.begin() + 1, {middle, aside, middle});
  const Scores after = bench_.score();
  EXPECT_NEAR(at(after, "extrude_mm"), at(before, "extrude_mm") + 2 * distance(middle, aside),
              1e-5);
  EXPECT_NEAR(at(after, "travel_mm"), at(before, "travel_mm"), 1e-9);
  EXPECT_GT(at(after, "print_extrude_s"), at(before, "print_extrude_s"));
  EXPECT_GE(at(after, "doubled"), at(before, "doubled"));
}

TEST_P(JudgeLaw, MoreMaterialNeverCoversLess) {
  const Scores all = bench_.score();
  bench_.route.strokes.resize(bench_.route.strokes.size() / 2);
  const Scores half = bench_.score();
  for (const std::string_view name :
       {"extrude_mm", "covered", "deposit", "doubled", "spilled", "hollow_mm", "outline_covered"})
    EXPECT_GE(at(all, name), at(half, name)) << name;
  EXPECT_LE(at(all, "skipped"), at(half, "skipped"));
}

TEST_P(JudgeLaw, EqualInputGivesEqualScores) {
  EXPECT_EQ(bench_.score(Point2{3, 4}), bench_.score(Point2{3, 4}));
}

INSTANTIATE_TEST_SUITE_P(Seeds, JudgeLaw, testing::Range(1, 5));

TEST(JudgeTotals, FollowEachMetricsRule) {
  const auto place = [](std::string_view name) { return metric_index(name); };
  std::vector<LayerScore> layers(3);
  for (LayerScore& layer : layers) layer.scores.resize(metric_table().size());
  layers[0].area_mm2 = 100;
  layers[1].area_mm2 = 300;
  layers[0].outline_mm = 40;
  layers[1].outline_mm = 60;
  layers[0].demanded_mm3 = 10;
  layers[1].demanded_mm3 = 30;
  const auto set = [&](std::string_view name, double first, double second) {
    layers[0].scores[place(name)] = first;
    layers[1].scores[place(name)] = second;
  };
  set("travel_mm", 5, 7);
  set("max_travel_mm", 5, 3);
  set("covered", 1, 0.9);
  set("outline_covered", 0.5, 1);
  set("deposit", 1.2, 0.8);
  set("doubled", 0, 0);
  layers[2].scores[place("travel_mm")] = 11;  // an empty layer: nothing to cover
  const Scores totals = Judge({}, {}).total(layers);
  EXPECT_EQ(*totals[place("travel_mm")], 23);
  EXPECT_EQ(*totals[place("max_travel_mm")], 5);
  EXPECT_NEAR(*totals[place("covered")], 0.925, 1e-12);
  EXPECT_NEAR(*totals[place("outline_covered")], 0.8, 1e-12);
  EXPECT_NEAR(*totals[place("deposit")], 0.9, 1e-12);
  EXPECT_EQ(*totals[place("doubled")], 0);  // zero is a value
  EXPECT_EQ(totals[place("spilled")], std::nullopt);
  EXPECT_EQ(totals[place("peak_rss_bytes")], std::nullopt);
  for (const std::optional<double>& value : Judge({}, {}).total({})) EXPECT_EQ(value, std::nullopt);
}

}  // namespace
}  // namespace routebench
