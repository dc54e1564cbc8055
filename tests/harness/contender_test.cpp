#include "routebench/harness/contender.hpp"

#include <gtest/gtest.h>

#include <set>

#include "random_polygons.hpp"
#include "routebench/geometry/vec.hpp"
#include "toy_planners.hpp"

namespace routebench {
namespace {

using test::rectangle;
using test::toy_registry;

ContenderSpec spec_of(const char* shell, const char* fill, LayerOrder order) {
  ContenderSpec spec{"toy", {}, {}, order};
  if (shell != nullptr) spec.shell = SlotSpec{shell, {}};
  if (fill != nullptr) spec.fill = SlotSpec{fill, {}};
  return spec;
}

Polygon square(double x, double y, double side) {
  return {rectangle(x, y, x + side, y + side), {}};
}

/// Three islands in a row; each has something dense on the left and something sparse on the right.
struct Row {
  Layer layer{.index = 7, .z_mm = 1.5, .height_mm = 0.2, .polygons = {}, .solid = {}};
  Demand demand;
  Row() {
    for (const double x : {0.0, 20.0, 40.0}) {
      layer.polygons.push_back(square(x, 0, 10));
      demand.inside.push_back(square(x + 1, 1, 8));
      demand.dense.push_back({rectangle(x + 1, 1, x + 5, 9), {}});
      demand.sparse.push_back({rectangle(x + 5, 1, x + 9, 9), {}});
    }
    demand.outline = layer.polygons;
    // The order of regions is nobody's promise.
    std::swap(demand.dense[0], demand.dense[2]);
    std::swap(demand.sparse[1], demand.sparse[2]);
  }
};

PlannedLayer plan_row(const ContenderSpec& spec, const Task& task) {
  const Registry registry = toy_registry();
  const Row row;
  return Contender(spec, registry).plan(row.layer, row.demand, task, {0, 0}, 1, {});
}

/// One letter a stroke: kind and island, "w0 d0 s0 ...".
std::string story(const PlannedLayer& planned) {
  std::string text;
  EXPECT_EQ(planned.kinds.size(), planned.route.strokes.size());
  for (std::size_t i = 0; i < planned.kinds.size(); ++i) {
    const Point2 end = planned.route.strokes[i].points.back();
    text += std::string(text.empty() ? "" : " ") + to_string(planned.kinds[i]).front() +
            std::to_string(static_cast<int>(end.x / 20));
  }
  return text;
}

TEST(Contender, FinishesAnIslandBeforeTheNextNearest) {
  Task task;
  const ContenderSpec spec = spec_of("once_round", "leash", LayerOrder::kIsland);
  EXPECT_EQ(story(plan_row(spec, task)), "w0 d0 s0 w1 d1 s1 w2 d2 s2");
  task.start_mm = {36, 5};  // 4 mm from island 2, 6 mm from island 1
  EXPECT_EQ(story(plan_row(spec, task)), "w2 d2 s2 w1 d1 s1 w0 d0 s0");
}

TEST(Contender, StageOrderHandsOverTheWholeLayer) {
  const ContenderSpec spec = spec_of("once_round", "leash", LayerOrder::kStage);
  EXPECT_EQ(story(plan_row(spec, {})), "w0 w1 w2 d2 d1 d0 s0 s2 s1");
}

TEST(Contender, EachCallBeginsWhereTheNozzleIs) {
  Task task;
  task.start_mm = {3, -2};
  const PlannedLayer planned = plan_row(spec_of(nullptr, "leash", LayerOrder::kIsland), task);
  ASSERT_EQ(planned.route.strokes.size(), 6u);
  Point2 nozzle = task.start_mm;
  for (const Stroke& stroke : planned.route.strokes) {
    EXPECT_EQ(stroke.points.front(), nozzle);
    nozzle = stroke.points.back();
  }
}

TEST(Contender, DenseIsAskedForAtOneAndSparseAtTheTasksDensity) {
  Task task;
  task.density = 0.15;
  const PlannedLayer planned = plan_row(spec_of(nullptr, "leash", LayerOrder::kStage), task);
  ASSERT_EQ(planned.kinds.size(), 6u);
  for (std::size_t i = 0; i < planned.kinds.size(); ++i)
    EXPECT_EQ(planned.route.strokes[i].width_mm, planned.kinds[i] == StrokeKind::kDense ? 1 : 0.15);
}

TEST(Contender, LaysOnlyWhatTheTaskAsksFor) {
  Task task;
  task.density = 0;
  EXPECT_EQ(story(plan_row(spec_of("once_round", "leash", LayerOrder::kStage), task)),
            "w0 w1 w2 d2 d1 d0");
  task.perimeters = 0;
  EXPECT_EQ(story(plan_row(spec_of("once_round", "leash", LayerOrder::kStage), task)), "d2 d1 d0");
  EXPECT_EQ(story(plan_row(spec_of("once_round", nullptr, LayerOrder::kIsland), {})), "w0 w1 w2");
}

TEST(Contender, IslandsWithNothingToLayAreNotVisited) {
  const Registry registry = toy_registry();
  Row row;
  row.demand.dense.clear();
  row.demand.sparse = {row.demand.sparse[1]};  // of island 2
  const PlannedLayer planned = Contender(spec_of(nullptr, "leash", LayerOrder::kIsland), registry)
                                   .plan(row.layer, row.demand, {}, {0, 0}, 1, {});
  EXPECT_EQ(story(planned), "s2");
}

TEST(Contender, AnEmptyLayerHasAnEmptyRoute) {
  const Registry registry = toy_registry();
  for (const LayerOrder order : {LayerOrder::kIsland, LayerOrder::kStage}) {
    const PlannedLayer planned = Contender(spec_of("once_round", "leash", order), registry)
                                     .plan(Layer{}, Demand{}, {}, {0, 0}, 1, {});
    EXPECT_TRUE(planned.route.strokes.empty());
    EXPECT_TRUE(planned.kinds.empty());
  }
}

TEST(Contender, ParametersReachThePlannerAndAreKnownInFull) {
  const Registry registry = toy_registry();
  ContenderSpec spec = spec_of("once_round", "leash", LayerOrder::kStage);
  EXPECT_EQ(std::get<double>(Contender(spec, registry).fill_params().at("lift_mm")), 0.0);
  spec.fill->params["lift_mm"] = 2.5;
  const Contender contender(spec, registry);
  EXPECT_EQ(std::get<double>(contender.fill_params().at("lift_mm")), 2.5);
  EXPECT_TRUE(contender.shell_params().empty());
  const Row row;
  const PlannedLayer planned = contender.plan(row.layer, row.demand, {}, {0, 0}, 1, {});
  EXPECT_EQ(planned.route.strokes.back().points.back(), (Point2{25, 3.5}));
}

TEST(Contender, SeedsDifferFromLayerToLayerAndFromRunToRun) {
  const Registry registry = toy_registry();
  const Contender contender(spec_of(nullptr, "seed_teller", LayerOrder::kStage), registry);
  Row row;
  const auto told = [&](int layer_index, std::uint64_t seed) {
    row.layer.index = layer_index;
    return contender.plan(row.layer, row.demand, {}, {0, 0}, seed, {})
        .route.strokes.front()
        .points.back()
        .x;
  };
  std::set<double> seen;
  for (int layer = 0; layer < 20; ++layer)
    for (std::uint64_t seed = 0; seed < 20; ++seed) seen.insert(told(layer, seed));
  EXPECT_GE(seen.size(), 395u);  // 400 draws of 19 bits: a collision is possible, five are not
  EXPECT_EQ(told(3, 9), told(3, 9));
}

void expect_error(const std::function<void()>& act, ErrorKind kind, const std::string& part) {
  try {
    act();
    FAIL() << "no error that says: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Contender, RefusesSpecsThatCannotBeMeant) {
  const Registry registry = toy_registry();
  const auto make = [&](const ContenderSpec& spec) {
    return [&, spec] { Contender(spec, registry); };
  };
  expect_error(make(spec_of(nullptr, nullptr, LayerOrder::kIsland)), ErrorKind::kBadInput,
               "contender toy: it has no planner");
  expect_error(make(spec_of("leash", nullptr, LayerOrder::kIsland)), ErrorKind::kBadInput,
               "leash is no shell planner; name it as fill, or take one of: once_round");
  expect_error(make(spec_of(nullptr, "once_round", LayerOrder::kIsland)), ErrorKind::kBadInput,
               "once_round is no fill planner");
  expect_error(make(spec_of("once_rond", nullptr, LayerOrder::kIsland)), ErrorKind::kBadInput,
               "once_round");
  ContenderSpec mistyped = spec_of(nullptr, "leash", LayerOrder::kIsland);
  mistyped.fill->params["lift"] = 1.0;
  expect_error(make(mistyped), ErrorKind::kBadInput, "lift_mm");
}

TEST(Contender, NamesPlannerAndLayerOfAFault) {
  const Registry registry = toy_registry();
  const Row row;
  const auto doing = [&](const char* wrong) {
    return [&, wrong] {
      ContenderSpec spec = spec_of(nullptr, "wrongdoer", LayerOrder::kIsland);
      spec.fill->params["wrong"] = std::string(wrong);
      static_cast<void>(Contender(spec, registry).plan(row.layer, row.demand, {}, {0, 0}, 1, {}));
    };
  };
  const std::string who = "planner wrongdoer, layer 7: ";
  const ErrorKind kind = ErrorKind::kBadInput;
  expect_error(doing("one_point"), kind, who + "stroke 0 of the returned route has 1 points");
  expect_error(doing("not_finite"), kind, who + "stroke 0 of the returned route has point 1");
  expect_error(doing("far_away"), kind, "must be finite and within a kilometre");
  expect_error(doing("no_width"), kind, who + "stroke 1 of the returned route has the width");
  expect_error(doing("error"), kind, who + "lost my way");
  expect_error(doing("exception"), kind, who + "lost my list");
  expect_error(doing("number"), kind, who + "it threw something");
  expect_error(doing("stop"), ErrorKind::kStopped, "stopped");
}

TEST(Contender, StopsBetweenCallsEvenIfPlannersDoNotLook) {
  const Registry registry = toy_registry();
  const Row row;
  std::stop_source source;
  source.request_stop();
  const Contender contender(spec_of("once_round", nullptr, LayerOrder::kIsland), registry);
  expect_error(
      [&] {
        static_cast<void>(contender.plan(row.layer, row.demand, {}, {0, 0}, 1, source.get_token()));
      },
      ErrorKind::kStopped, "stopped");
}

TEST(LayerOrder, HasNames) {
  for (const LayerOrder order : {LayerOrder::kIsland, LayerOrder::kStage})
    EXPECT_EQ(layer_order(to_string(order)), order);
  expect_error([] { static_cast<void>(layer_order("isle")); }, ErrorKind::kBadInput,
               "order 'isle' is unknown");
}

}  // namespace
}  // namespace routebench
