#include "routebench/harness/demand.hpp"

#include <gtest/gtest.h>

#include "random_polygons.hpp"
#include "routebench/geometry/region.hpp"

namespace routebench {
namespace {

Polygon box(double x0, double y0, double x1, double y1) {
  return {test::rectangle(x0, y0, x1, y1), {}};
}

Layer layer_of(Polygons polygons, Polygons solid = {}) {
  return {.polygons = std::move(polygons), .solid = std::move(solid)};
}

/// walls + dense + sparse = outline, and dense + sparse = inside, without overlap.
void expect_partition(const Demand& demand) {
  const double outline = area_mm2(demand.outline);
  EXPECT_NEAR(area_mm2(demand.dense) + area_mm2(demand.sparse), area_mm2(demand.inside),
              1e-4 * outline);
  EXPECT_NEAR(area_mm2(intersect(demand.dense, demand.sparse)), 0, 1e-4 * outline);
  EXPECT_NEAR(area_mm2(subtract(demand.inside, demand.outline)), 0, 1e-6 * outline);
}

TEST(Demand, WallsTakeTheirSpacingFromEverySide) {
  Task task;
  task.perimeters = 2;
  const Demand demand = demand_of(layer_of({box(0, 0, 20, 10)}), task);
  const double band = 2 * task.spacing_mm();
  EXPECT_NEAR(area_mm2(demand.inside), (20 - 2 * band) * (10 - 2 * band), 1e-4);
  EXPECT_EQ(demand.sparse, demand.inside);
  EXPECT_TRUE(demand.dense.empty());
  task.perimeters = 0;
  EXPECT_EQ(demand_of(layer_of({box(0, 0, 20, 10)}), task).inside, demand.outline);
}

TEST(Demand, SkinsAreDenseWhereALineFits) {
  Task task;
  task.perimeters = 1;
  const Layer layer =
      layer_of({box(0, 0, 20, 10)}, {box(0, 0, 8, 10), box(12, 3, 12.4, 7), box(15, 0, 15.5, 10)});
  const Demand demand = demand_of(layer, task);
  const double band = task.spacing_mm();
  // The strip of 0.4 mm is narrower than a line of 0.45 mm, the one of 0.5 mm is not.
  EXPECT_NEAR(area_mm2(demand.dense), (8 - band) * (10 - 2 * band) + 0.5 * (10 - 2 * band), 1e-3);
  expect_partition(demand);
}

TEST(Demand, AtDensityOneAllOfTheInsideIsDense) {
  Task task;
  task.density = 1;
  const Demand demand = demand_of(layer_of({box(0, 0, 5, 5), box(7, 0, 7.9, 5)}), task);
  EXPECT_EQ(demand.dense, demand.inside);
  EXPECT_TRUE(demand.sparse.empty());
}

TEST(Demand, NothingIsLeftOfAnEmptyOrAThinLayer) {
  Task task;
  for (const Layer& layer : {layer_of({}), layer_of({box(0, 0, 0.3, 20)})}) {
    const Demand demand = demand_of(layer, task);
    EXPECT_EQ(demand.outline, layer.polygons);
    EXPECT_TRUE(demand.inside.empty());
    EXPECT_TRUE(demand.dense.empty());
    EXPECT_TRUE(demand.sparse.empty());
  }
}

TEST(Demand, RegionsOfAnyShapeMakeUpTheOutline) {
  const Task task;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Polygons shape = test::random_polygons(seed);
    expect_partition(
        demand_of(layer_of(shape, intersect(shape, test::random_polygons(seed + 100))), task));
  }
}

TEST(Demand, MoreWallsThanFitEndWithNothingInside) {
  Task task;
  task.perimeters = 10000;
  EXPECT_TRUE(demand_of(layer_of({box(0, 0, 20, 20)}), task).inside.empty());
}

}  // namespace
}  // namespace routebench
