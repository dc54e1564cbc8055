/// The gate lets honest routes pass and catches those that do not do their task.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "random_polygons.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routes.hpp"

namespace routebench {
namespace {

using std::numbers::pi;
using test::rectangle;

Ring circle(Point2 centre, double radius, bool hole) {
  Ring ring;
  for (int i = 0; i < 96; ++i) {
    const double angle = (hole ? -1 : 1) * 2 * pi * i / 96;
    ring.push_back(snap(centre + radius * Point2{std::cos(angle), std::sin(angle)}));
  }
  return ring;
}

/// A part that goes straight up.
struct Part {
  std::string name;
  Polygons outline;
};

/// A plate with a bore and bolt holes.
Part flange() {
  Polygon plate{rectangle(0, 0, 60, 40), {circle({30, 20}, 9, true)}};
  for (const Point2 bolt : {Point2{6, 6}, Point2{54, 6}, Point2{54, 34}, Point2{6, 34}})
    plate.holes.push_back(circle(bolt, 2.2, true));
  return {"flange", {plate}};
}

/// A slice as of a figure: lobes of all sizes, hundreds of points.
Part figure() {
  Ring ring;
  for (int i = 0; i < 600; ++i) {
    const double angle = 2 * pi * i / 600;
    const double radius = 24 + 4 * std::sin(5 * angle) + 2 * std::sin(17 * angle);
    ring.push_back(snap(radius * Point2{std::cos(angle), std::sin(angle)}));
  }
  return {"figure", polygons_from_rings({ring}, FillRule::kNonZero)};
}

/// Pieces apart from each other.
Part pieces() {
  return {"pieces",
          {{circle({0, 0}, 11, false), {}},
           {circle({26, 4}, 12, false), {circle({26, 4}, 5, true)}},
           {rectangle(-8, 15, 14, 35), {}},
           {rectangle(20, 20, 40, 42), {}}}};
}

/// How a planner fills: an inside to be filled, the layer's index, the distance between lines.
using Filler = std::function<Route(const Polygons&, int layer, double distance_mm, const Task&)>;

test::Hatch hatch(int layer, double distance_mm) {
  test::Hatch lines;
  lines.distance_mm = distance_mm;
  lines.angle_rad = layer % 2 == 0 ? pi / 4 : -pi / 4;
  return lines;
}

Route honest(const Polygons& region, int layer, double distance_mm, const Task& task) {
  return test::lines(region, hatch(layer, distance_mm), task.line_width_mm);
}

constexpr int kLayers = 3;  // the lowest one is skin

/// What becomes of a layer's route before it is judged.
using Spoiler = std::function<void(Route&, int layer)>;

struct Judged {
  std::vector<LayerScore> layers;
  Scores totals;
  Verdict verdict;
};

Judged judge(
    const Part& part, const Task& task, const Filler& filler,
    const Spoiler& spoil = [](Route&, int) {}) {
  const Judge judge(task, {});
  Judged judged;
  std::optional<Point2> end;
  for (int i = 0; i < kLayers; ++i) {
    Layer layer;
    layer.index = i;
    layer.height_mm = task.layer_height_mm;
    layer.polygons = part.outline;
    if (i == 0) layer.solid = part.outline;
    const Demand demand = demand_of(layer, task);
    Route route = test::walls(part.outline, task);
    test::append(route, filler(demand.dense, i, task.spacing_mm(), task));
    if (task.density > 0)
      test::append(route, filler(demand.sparse, i, task.spacing_mm() / task.density, task));
    spoil(route, i);
    judged.layers.push_back(judge.score(layer, demand, route, end));
    if (judged.layers.back().end) end = judged.layers.back().end;
  }
  judged.totals = judge.total(judged.layers);
  judged.verdict = judge.verdict(judged.totals);
  return judged;
}

std::string figures(const Judged& judged) {
  std::string text;
  for (const std::string_view name : {"covered", "skipped", "worst_layer", "deposit", "doubled",
                                      "spilled", "outline_covered", "hollow_mm"})
    text += std::string(name) + " " +
            std::to_string(judged.totals[metric_index(name)].value_or(-1)) + "; ";
  return text + judged.verdict.reason;
}

struct Setting {
  Part part;
  double density;
  int perimeters;
};

std::ostream& operator<<(std::ostream& out, const Setting& setting) {
  return out << setting.part.name << " at density " << setting.density << " with "
             << setting.perimeters << " walls";
}

class JudgeGate : public testing::TestWithParam<Setting> {
 protected:
  JudgeGate() {
    task_.density = GetParam().density;
    task_.perimeters = GetParam().perimeters;
  }

  void expect_valid(const Judged& judged) {
    EXPECT_EQ(judged.verdict.outcome, Outcome::kValid) << figures(judged);
    EXPECT_EQ(judged.verdict.reason, "");
  }
  void expect_off_task(const Judged& judged) {
    EXPECT_EQ(judged.verdict.outcome, Outcome::kOffTask) << figures(judged);
    EXPECT_NE(judged.verdict.reason, "");
  }

  const Part& part() const { return GetParam().part; }
  Task task_;
};

TEST_P(JudgeGate, HonestLinesPass) { expect_valid(judge(part(), task_, honest)); }

TEST_P(JudgeGate, HonestPatternsOfOtherKindsPass) {
  if (task_.density < 1) {
    const Judged grid = judge(
        part(), task_, [](const Polygons& region, int layer, double distance_mm, const Task& task) {
          test::Hatch one = hatch(layer, 2 * distance_mm);
          Route route = test::lines(region, one, task.line_width_mm);
          one.angle_rad += pi / 2;
          test::append(route, test::lines(region, one, task.line_width_mm));
          // Skins, which no grid fills, by lines.
          return distance_mm > 1.5 * task.spacing_mm() ? route
                                                       : honest(region, layer, distance_mm, task);
        });
    expect_valid(grid);
  }
  expect_valid(
      judge(part(), task_, [](const Polygons& region, int, double distance_mm, const Task& task) {
        Route route;
        for (Polygons rest = offset(region, -distance_mm / 2); !rest.empty();
             rest = offset(rest, -distance_mm))
          test::append(route, test::loops(rest, task.line_width_mm));
        return route;
      }));
}

TEST_P(JudgeGate, EveryTwentiethLineLeftOut) {
  const Judged thin_slices = judge(
      part(), task_, [](const Polygons& region, int layer, double distance_mm, const Task& task) {
        test::Hatch lines = hatch(layer, distance_mm);
        lines.keep = [](long k) { return k % 20 != 7; };
        return test::lines(region, lines, task.line_width_mm);
      });
  expect_off_task(thin_slices);
}

TEST_P(JudgeGate, AFewLinesSideBySideLeftOut) {
  const Judged slices = judge(
      part(), task_, [](const Polygons& region, int layer, double distance_mm, const Task& task) {
        test::Hatch lines = hatch(layer, distance_mm);
        // One twentieth of the region's lines, in its middle.
        const Box2 box = bounding_box(region);
        const double across =
            (box.upper.x - box.lower.x + box.upper.y - box.lower.y) / std::sqrt(2);
        const long count = static_cast<long>(across / distance_mm);
        lines.keep = [count](long k) { return k < count / 2 || k > count / 2 + count / 20; };
        return test::lines(region, lines, task.line_width_mm);
      });
  expect_off_task(slices);
}

TEST_P(JudgeGate, ATwentiethOfTheAreaLeftOutInOnePlace) {
  const double side = std::sqrt(0.05 * area_mm2(part().outline));
  const Point2 corner = part().name == "flange" ? Point2{8, 10} : Point2{-5, -5};
  const Polygons left_out{{rectangle(corner.x, corner.y, corner.x + side, corner.y + side), {}}};
  const Judged hole = judge(
      part(), task_, [&](const Polygons& region, int layer, double distance_mm, const Task& task) {
        return honest(subtract(region, left_out), layer, distance_mm, task);
      });
  expect_off_task(hole);
}

TEST_P(JudgeGate, OneSideLeftOut) {
  // All that lies left of a line: of the inside, as much as makes a twentieth of the area.
  Layer layer;
  layer.polygons = part().outline;
  const Polygons inside = demand_of(layer, task_).inside;
  const Box2 box = bounding_box(inside);
  Polygons strip;
  for (double x = box.lower.x + 0.1;
       area_mm2(intersect(inside, strip)) < 0.05 * area_mm2(part().outline); x += 0.1)
    strip = {{rectangle(box.lower.x, box.lower.y, x, box.upper.y), {}}};
  const Judged side = judge(
      part(), task_, [&](const Polygons& region, int index, double distance_mm, const Task& task) {
        return honest(subtract(region, strip), index, distance_mm, task);
      });
  expect_off_task(side);
}

TEST_P(JudgeGate, TravelsExtruded) {
  const Judged joined = judge(part(), task_, honest, [](Route& route, int) {
    Stroke all{{}, route.strokes.front().width_mm};
    for (const Stroke& stroke : route.strokes)
      all.points.insert(all.points.end(), stroke.points.begin(), stroke.points.end());
    route.strokes = {all};
  });
  expect_off_task(joined);
  EXPECT_EQ(*joined.totals[metric_index("travels")], kLayers - 1);
}

TEST_P(JudgeGate, TravelsHiddenInHairs) {
  // Too thin to show in any area: only their length tells.
  for (const double width_mm : {1e-6, task_.line_width_mm / 11}) {
    double hidden_mm = 0;
    const Judged hairy = judge(part(), task_, honest, [&](Route& route, int) {
      Route all;
      for (Stroke& stroke : route.strokes) {
        if (!all.strokes.empty()) {
          const Point2 from = all.strokes.back().points.back(), to = stroke.points.front();
          hidden_mm += distance(from, to);
          all.strokes.push_back({{from, to}, width_mm});
        }
        all.strokes.push_back(std::move(stroke));
      }
      route = std::move(all);
    });
    expect_off_task(hairy);
    EXPECT_EQ(*hairy.totals[metric_index("travels")], kLayers - 1);
    EXPECT_NEAR(*hairy.totals[metric_index("hollow_mm")], hidden_mm, 1e-3 * hidden_mm);
  }
}

TEST_P(JudgeGate, OneLayerOfTwoHundredLeftOut) {
  const std::size_t walls = test::walls(part().outline, task_).strokes.size();
  const Judge judge_of_all(task_, {});
  // All of the layer, or its filling only.
  for (const std::size_t kept : {std::size_t{0}, walls}) {
    const Judged once = judge(part(), task_, honest, [kept](Route& route, int layer) {
      if (layer == 1) route.strokes.resize(kept);
    });
    std::vector<LayerScore> layers(200, once.layers[2]);
    EXPECT_EQ(judge_of_all.verdict(judge_of_all.total(layers)).outcome, Outcome::kValid);
    layers[100] = once.layers[1];
    const Verdict verdict = judge_of_all.verdict(judge_of_all.total(layers));
    EXPECT_EQ(verdict.outcome, Outcome::kOffTask);
    EXPECT_TRUE(verdict.reason.starts_with("worst_layer ")) << verdict.reason;
  }
}

/// What the built-in planners make of a region, as a filler.
Filler built_in(const Registry& registry, const std::string& link) {
  return
      [&registry, link](const Polygons& region, int index, double distance_mm, const Task& task) {
        Layer layer;
        layer.index = index;
        layer.polygons = region;
        PlanContext context;
        context.line_width_mm = task.line_width_mm;
        context.spacing_mm = task.spacing_mm();
        context.density = task.spacing_mm() / distance_mm;
        return registry.at("rectilinear").make({{"link", link}})->plan(layer, context);
      };
}

TEST_P(JudgeGate, BuiltInPlannersPassWholeAndAreCaughtCut) {
  const PlannerSet planners = load_planners({});
  for (const std::string link : {"none", "flows", "boundary"}) {
    SCOPED_TRACE(link);
    expect_valid(judge(part(), task_, built_in(planners.registry, link)));
  }
  const Filler whole = built_in(planners.registry, "none");
  expect_off_task(
      judge(part(), task_,
            [&whole](const Polygons& region, int index, double distance_mm, const Task& task) {
              Route route = whole(region, index, distance_mm, task);
              // A twentieth of the length, stroke by stroke, spread over the region.
              double owed = 0;
              std::erase_if(route.strokes, [&owed](const Stroke& stroke) {
                double length = 0;
                for (std::size_t i = 1; i < stroke.points.size(); ++i)
                  length += distance(stroke.points[i - 1], stroke.points[i]);
                owed += 0.05 * length;
                if (owed < length) return false;
                owed -= length;
                return true;
              });
              return route;
            }));
}

TEST_P(JudgeGate, NothingAtAll) {
  const Judged nothing =
      judge(part(), task_, honest, [](Route& route, int) { route.strokes.clear(); });
  expect_off_task(nothing);
  EXPECT_NE(nothing.verdict.reason.find("covered 0 < 0.95; "), std::string::npos)
      << nothing.verdict.reason;
}

TEST_P(JudgeGate, EverythingTwice) {
  expect_off_task(judge(part(), task_, honest, [](Route& route, int) {
    const Route again = route;
    test::append(route, again);
  }));
}

TEST_P(JudgeGate, AQuarterOfTheMaterialTooLittleOrTooMuch) {
  for (const double factor : {0.75, 1.3}) {
    expect_off_task(judge(part(), task_, honest, [factor](Route& route, int) {
      for (Stroke& stroke : route.strokes) stroke.width_mm *= factor;
    }));
  }
}

TEST_P(JudgeGate, WallsLeftOut) {
  if (task_.perimeters == 0) GTEST_SKIP() << "no walls are asked for";
  const std::size_t walls = test::walls(part().outline, task_).strokes.size();
  expect_off_task(judge(part(), task_, honest, [walls](Route& route, int) {
    route.strokes.erase(route.strokes.begin(),
                        route.strokes.begin() + static_cast<std::ptrdiff_t>((walls + 1) / 2));
  }));
}

TEST_P(JudgeGate, PrintedBesideThePart) {
  expect_off_task(judge(part(), task_, honest, [](Route& route, int) {
    for (Stroke& stroke : route.strokes)
      for (Point2& p : stroke.points) p = p + Point2{3, 0};
  }));
}

INSTANTIATE_TEST_SUITE_P(Parts, JudgeGate,
                         testing::Values(Setting{flange(), 0.2, 2}, Setting{flange(), 1, 2},
                                         Setting{flange(), 0.4, 0}, Setting{figure(), 0.2, 2},
                                         Setting{figure(), 1, 1}, Setting{pieces(), 0.5, 2}));

TEST(JudgeVerdict, NamesEveryMissedLimitWithItsFigure) {
  Task task;
  const Judge judge(task, {});
  Scores totals(metric_table().size());
  EXPECT_EQ(judge.verdict(totals).outcome, Outcome::kValid);  // nothing applies, nothing is missed
  const auto set = [&](std::string_view name, double value) { totals[metric_index(name)] = value; };
  set("extrude_mm", 4000);
  set("covered", 0.91);
  set("doubled", 0.3125);
  set("hollow_mm", 12.5);
  set("deposit", 1.151);
  set("outline_covered", 0.9499999);
  const Verdict verdict = judge.verdict(totals);
  EXPECT_EQ(verdict.outcome, Outcome::kOffTask);
  EXPECT_EQ(verdict.reason,
            "covered 0.91 < 0.95; deposit 1.151 > 1.15; outline_covered 0.9499999 < 0.95; doubled "
            "0.312 > 0.25; hollow_mm 12.5 > 4");
  // At the limit is within it.
  set("covered", 0.95);
  set("doubled", 0.25);
  set("hollow_mm", 4);
  set("deposit", 0.85);
  set("outline_covered", 0.95);
  EXPECT_EQ(judge.verdict(totals).outcome, Outcome::kValid);
  // The outline is asked for with walls only.
  task.perimeters = 0;
  set("outline_covered", 0);
  EXPECT_EQ(Judge(task, {}).verdict(totals).outcome, Outcome::kValid);
  // What is not a number passes no limit.
  set("covered", std::nan(""));
  EXPECT_EQ(Judge(task, {}).verdict(totals).outcome, Outcome::kOffTask);
}

TEST(JudgeVerdict, LimitsAreTheTasks) {
  Task task;
  task.gate.covered_min = 0.9;
  Scores totals(metric_table().size());
  totals[metric_index("covered")] = 0.92;
  EXPECT_EQ(Judge(task, {}).verdict(totals).outcome, Outcome::kValid);
}

TEST(JudgeVerdict, OutcomesHaveTheirNames) {
  EXPECT_EQ(to_string(Outcome::kValid), "valid");
  EXPECT_EQ(to_string(Outcome::kOffTask), "off_task");
  EXPECT_EQ(to_string(Outcome::kFailed), "failed");
  EXPECT_EQ(to_string(Outcome::kCrashed), "crashed");
  EXPECT_EQ(to_string(Outcome::kTimedOut), "timed_out");
  EXPECT_EQ(to_string(Outcome::kOutOfMemory), "out_of_memory");
}

TEST(JudgeVerdict, PlacesTooThinForALineExcuseALayerNotAMissingOne) {
  // A layer of ribs narrower than two lines beside a block; the block is filled, the ribs are not.
  Task task;
  task.density = 1;
  task.perimeters = 0;
  Layer layer;
  layer.height_mm = task.layer_height_mm;
  layer.polygons = {{rectangle(0, 0, 10, 10), {}}};
  for (int i = 0; i < 30; ++i) layer.polygons.push_back({rectangle(12 + i, 0, 12.4 + i, 10), {}});
  const Demand demand = demand_of(layer, task);
  const Route block = test::lines({layer.polygons.front()}, {task.spacing_mm(), 0.1}, 0.45);
  const auto worst = [&](const Route& route) {
    return *Judge(task, {})
                .score(layer, demand, route, std::nullopt)
                .scores[metric_index("worst_layer")];
  };
  EXPECT_LT(worst(block), 0.1);
  EXPECT_GT(worst({}), 0.4);
}

}  // namespace
}  // namespace routebench
