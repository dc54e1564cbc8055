#include "routebench/harness/pipeline.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/layer_io.hpp"
#include "routebench/geometry/solid.hpp"
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

std::vector<Route> routes_of(const std::vector<PlannedLayer>& planned) {
  std::vector<Route> routes;
  for (const PlannedLayer& layer : planned) routes.push_back(layer.route);
  return routes;
}

/// Two plates, one on the other, with equal layers in both and skins where they meet.
PreparedModel two_plates(const Task& task) {
  PreparedModel model;
  for (int i = 0; i < 16; ++i) {
    Layer& layer = model.sliced.layers.emplace_back();
    layer.index = i;
    layer.z_mm = (i + 0.5) * task.layer_height_mm;
    layer.height_mm = task.layer_height_mm;
    const double side = i < 9 ? 12 : 7;
    layer.polygons = {{{{0, 0}, {side, 0}, {side, 9}, {0, 9}}, {}},
                      {{{20, 0}, {26, 0}, {26, 6}, {20, 6}}, {}}};
  }
  model.demands = demands_of(model.sliced, task, serial_for);
  return model;
}

TEST(DemandsOf, EqualLayersGetWhatEachWouldGetAlone) {
  const Task task;
  PreparedModel model = two_plates(task);
  find_solid(model.sliced.layers, task.skin_layers);
  std::size_t with_skins = 0;
  for (std::size_t i = 0; i < model.demands.size(); ++i) {
    const Demand alone = demand_of(model.sliced.layers[i], task);
    EXPECT_EQ(model.demands[i].inside, alone.inside);
    EXPECT_EQ(model.demands[i].dense, alone.dense) << "layer " << i;
    EXPECT_EQ(model.demands[i].sparse, alone.sparse) << "layer " << i;
    with_skins += alone.dense.empty() ? 0 : 1;
  }
  EXPECT_GT(with_skins, 6U);
  EXPECT_LT(with_skins, model.demands.size());
}

TEST(PlanJob, EqualLayersHaveTheRoutesThatPlanningThemWouldGive) {
  Registry registry;
  register_builtin_planners(registry);
  const Task task;
  const PreparedModel model = two_plates(task);
  std::vector<std::size_t> chosen = all_layers(model.sliced);
  chosen.erase(chosen.begin() + 5);
  for (const auto& [name, entry] : registry.entries()) {
    const SlotSpec slot{name, {}};
    const bool shell = entry.info.role == PlannerRole::kShell;
    const Contender contender({.name = name,
                               .shell = shell ? std::optional(slot) : std::nullopt,
                               .fill = shell ? std::nullopt : std::optional(slot)},
                              registry);
    EXPECT_GT(entry.make({})->period_layers(), 0) << name;
    EXPECT_EQ(routes_of(plan_job(contender, model, chosen, task, 1, {}, serial_for)),
              routes_of(plan_layers(contender, model, chosen, task, 1, {}, serial_for)))
        << name;
  }
}

/// Counts its calls, and says after how many layers they need not be made again.
class Counting final : public Planner {
 public:
  struct Params {
    int period = 0;
    void bind(ParamBinder& bind) { bind("period", period, {0, 9}, "", "period_layers"); }
  };
  static PlannerInfo info() { return {"counting", PlannerRole::kFill, "counts calls", ""}; }
  explicit Counting(const Params& params) : params_(params) {}
  [[nodiscard]] Route plan(const Layer&, const PlanContext&) const override {
    ++calls;
    return {};
  }
  [[nodiscard]] int period_layers() const noexcept override { return params_.period; }
  static inline std::size_t calls = 0;

 private:
  Params params_;
};

TEST(PlanJob, PlansEqualLayersOnce) {
  Registry registry;
  registry.add<Counting>();
  Task task;
  task.density = 1;
  const PreparedModel model = two_plates(task);
  const auto calls = [&](std::int64_t period) {
    const Contender contender(
        {.name = "counting", .shell = {}, .fill = SlotSpec{"counting", {{"period", period}}}},
        registry);
    Counting::calls = 0;
    static_cast<void>(
        plan_job(contender, model, all_layers(model.sliced), task, 1, {}, serial_for));
    return Counting::calls;
  };
  // Two islands a layer, and two outlines.
  EXPECT_EQ(calls(0), 2 * 16U);
  EXPECT_EQ(calls(1), 2 * 2U);
  EXPECT_EQ(calls(2), 2 * 2 * 2U);
}

}  // namespace
}  // namespace routebench
