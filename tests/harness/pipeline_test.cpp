#include "routebench/harness/pipeline.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <sstream>
#include <string>
#include <vector>

#include "judge/alike.hpp"
#include "polygons.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/layer_io.hpp"
#include "routebench/geometry/solid.hpp"
#include "routebench/harness/parallel.hpp"
#include "scratch_dir.hpp"

namespace routebench {
namespace {

std::vector<int> dense_layers(const Task& task) {
  const SlicedModel box = slice_model("shape:box?size=4", task, {}, serial_for);
  std::vector<int> dense;
  for (const Layer& layer : box.layers) {
    EXPECT_TRUE(layer.solid.empty() || layer.solid == layer.polygons);
    if (!layer.solid.empty()) dense.push_back(layer.index);
  }
  return dense;
}

TEST(SliceModel, TheTaskSaysWhichLayersAreDense) {
  Task task;
  task.layer_height_mm = 0.5;
  task.line_width_mm = 0.6;
  task.skin_layers = 1;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 7}));
  task.base_mm = 1;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 1, 7}));
  task.skin_rule = SkinRule::kSlope;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 1, 6, 7}));
  task.skin_rule = SkinRule::kNear;
  task.base_mm = 0;
  EXPECT_EQ(dense_layers(task), (std::vector<int>{0, 1, 6, 7}));
  task.skin_rule = SkinRule::kDifference;
  task.skin_layers = 0;
  EXPECT_TRUE(dense_layers(task).empty());
}

TEST(SliceModel, LayersOfAFileHaveNoFacets) {
  const test::ScratchDir folder;
  Task task;
  std::ostringstream layers;
  write_wkt(layers, slice_model("shape:box?size=4", task, {}, serial_for).layers);
  const std::string file = folder.write("box.wkt", layers.str()).string();
  task.skin_rule = SkinRule::kSlope;
  try {
    (void)slice_model(file, task, {}, serial_for);
    FAIL() << "it was not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_NE(std::string(error.what()).find("skin_rule"), std::string::npos);
  }
  EXPECT_FALSE(slice_model(file, task, {.find_skins = false}, serial_for).layers.empty());
}

/// A tower with a step, a second island and a roof: runs of equal layers, shorter and longer than
/// skins reach.
SlicedModel tower() {
  const Polygon wide{test::rectangle(0, 0, 20, 12), {}}, narrow{test::rectangle(2, 3, 11, 9), {}};
  SlicedModel model;
  const auto add = [&](const Polygons& polygons, int count) {
    for (int i = 0; i < count; ++i) {
      const int index = static_cast<int>(model.layers.size());
      Layer& layer = model.layers.emplace_back();
      layer.index = index;
      layer.z_mm = 0.1 + 0.2 * index;
      layer.height_mm = 0.2;
      layer.polygons = polygons;
    }
  };
  add({wide}, 9);
  add({narrow}, 10);
  add({narrow, {test::rectangle(13, 3, 18, 9), {}}}, 2);
  add({wide}, 5);
  return model;
}

PreparedModel prepared_tower(const Task& task) {
  PreparedModel model{tower(), {}};
  model.demands = demands_of(model.sliced, task, serial_for);
  return model;
}

TEST(DemandsOf, EqualLayersGetWhatEachWouldGetAlone) {
  for (const double density : {0.2, 1.0}) {
    Task task;
    task.density = density;
    const SlicedModel model = tower();
    const Demands demands = demands_of(model, task, serial_for);
    const SkinFinder skins(model.layers, task.skin_layers, serial_for);
    for (std::size_t i = 0; i < model.layers.size(); ++i) {
      SCOPED_TRACE(i);
      EXPECT_EQ(*demands[i],
                demand_of(model.layers[i], task, inside_of(model.layers[i], task),
                          [&](const Polygons& inside) { return skins.skins_in(inside, i); }));
    }
  }
}

TEST(PlanLayers, WhatIsTakenOverIsWhatWouldBePlanned) {
  const Task task;
  const PreparedModel model = prepared_tower(task);
  const std::vector<std::size_t> all = all_layers(model.sliced);
  // Of every third layer, too: those that follow each other are no neighbours then.
  std::vector<std::size_t> third;
  for (std::size_t i = 1; i < all.size(); i += 3) third.push_back(i);
  Registry registry;
  register_builtin_planners(registry);
  for (const auto& [name, entry] : registry.entries()) {
    EXPECT_GT(entry.info.repeats_every, 0) << name;
    ContenderSpec spec{.name = name, .shell = SlotSpec{"greedy_shell", {}}, .fill = {}};
    if (entry.info.role == PlannerRole::kFill) spec.fill = SlotSpec{name, {}};
    const Contender contender(std::move(spec), registry);
    for (const std::vector<std::size_t>& chosen : {all, third}) {
      const auto plan = [&](Repeats repeats) {
        return plan_layers(contender, model, chosen, task, 1, {}, serial_for, repeats);
      };
      const std::vector<PlannedLayer> planned = plan(Repeats::kPlan);
      const std::vector<PlannedLayer> taken = plan(Repeats::kTakeOver);
      ASSERT_EQ(taken.size(), planned.size());
      for (std::size_t i = 0; i < planned.size(); ++i) {
        EXPECT_EQ(taken[i].route, planned[i].route) << name << ", place " << i;
        EXPECT_EQ(taken[i].kinds, planned[i].kinds) << name << ", place " << i;
        EXPECT_GT(planned[i].plan_cpu_ns, 0) << name << ", place " << i;
        EXPECT_EQ(taken[i].plan_cpu_ns, 0) << name << ", place " << i;
      }
      const std::vector<std::size_t> original = first_of_equal_routes(contender, model, chosen);
      std::size_t different = 0;
      for (std::size_t i = 0; i < planned.size(); ++i) {
        if (original[i] == i) ++different;
        EXPECT_EQ(original[original[i]], original[i]);
        EXPECT_EQ(planned[original[i]].route, planned[i].route) << name << ", place " << i;
        EXPECT_EQ(planned[original[i]].kinds, planned[i].kinds) << name << ", place " << i;
      }
      EXPECT_LT(different, chosen.size()) << name;
    }
  }
}

/// Counts its calls, and says after how many layers they need not be made again.
template <int every>
class Counting final : public Planner {
 public:
  struct Params {
    void bind(ParamBinder&) {}
  };
  static PlannerInfo info() {
    return {"counting", PlannerRole::kFill, "counts calls", "", {}, every};
  }
  explicit Counting(const Params&) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override {
    ++calls;
    return {};
  }
  static inline std::atomic<std::size_t> calls = 0;
};

template <int every>
std::size_t calls_for_tower(Repeats repeats, const ParallelFor& parallel_for = serial_for) {
  Registry registry;
  registry.add<Counting<every>>();
  Task task;
  task.density = 1;
  const PreparedModel model = prepared_tower(task);
  const Contender contender({.name = "counting", .shell = {}, .fill = SlotSpec{"counting", {}}},
                            registry);
  Counting<every>::calls = 0;
  static_cast<void>(
      plan_layers(contender, model, all_layers(model.sliced), task, 1, {}, parallel_for, repeats));
  return Counting<every>::calls;
}

TEST(PlanLayers, RegionsOfEqualLayersArePlannedOnce) {
  // 26 layers, two of them with two islands, of three outlines.
  EXPECT_EQ(calls_for_tower<1>(Repeats::kPlan), 28U);
  EXPECT_EQ(calls_for_tower<0>(Repeats::kTakeOver), 28U);
  EXPECT_EQ(calls_for_tower<1>(Repeats::kTakeOver), 3U);
  EXPECT_EQ(calls_for_tower<2>(Repeats::kTakeOver), 6U);
  EXPECT_EQ(calls_for_tower<2>(Repeats::kTakeOver, parallel_loop(4)), 6U);
}

TEST(JudgeLayers, EqualLayersGetWhatEachWouldGetAlone) {
  const Task task;
  PreparedModel model = prepared_tower(task);
  Registry registry;
  register_builtin_planners(registry);
  const Contender contender(
      {.name = "both", .shell = SlotSpec{"greedy_shell", {}}, .fill = SlotSpec{"rectilinear", {}}},
      registry);
  const std::vector<std::size_t> all = all_layers(model.sliced);
  std::vector<PlannedLayer> planned =
      plan_layers(contender, model, all, task, 1, {}, serial_for, Repeats::kPlan);
  // Layers that are equal but for one thing each: a point, a width, a skin, how they are marked.
  planned[11].route.strokes.back().points.back().x += 0.5;
  planned[13].route.strokes.back().width_mm *= 2;
  Demand other = *model.demands[15];
  std::swap(other.dense, other.sparse);
  model.demands[15] = std::make_shared<const Demand>(other);
  model.sliced.layers[16].repaired = true;

  const Judge judge(task, {});
  const JudgedCell cell = judge_layers(judge, model, all, planned, serial_for);
  std::vector<judging::LayerCase> cases;
  std::optional<Point2> nozzle;
  for (const std::size_t i : all) {
    SCOPED_TRACE(i);
    LayerScore alone =
        judge.score(model.sliced.layers[i], *model.demands[i], planned[i].route, nozzle);
    alone.scores[metric_index("plan_wall_ns")] = static_cast<double>(planned[i].plan_wall_ns);
    alone.scores[metric_index("plan_cpu_ns")] = static_cast<double>(planned[i].plan_cpu_ns);
    EXPECT_EQ(cell.layers[i], alone);
    cases.push_back({model.demands[i].get(), &planned[i].route, nozzle});
    nozzle = alone.end;
  }
  // Lines turn from layer to layer.
  const std::vector<std::size_t> first = judging::first_alike(cases);
  EXPECT_EQ(first[18], 10U);
  EXPECT_EQ(first[24], 2U);
  EXPECT_EQ(first[25], 1U);
  for (const std::size_t own : {9U, 11U, 12U, 13U, 15U}) EXPECT_EQ(first[own], own);
}

}  // namespace
}  // namespace routebench
