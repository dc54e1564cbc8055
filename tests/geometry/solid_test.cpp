#include "routebench/geometry/solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "meshes.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"

namespace routebench {
namespace {

std::vector<Layer> stack_of(const std::vector<Polygons>& areas) {
  std::vector<Layer> layers;
  for (const Polygons& polygons : areas) {
    Layer layer;
    layer.index = static_cast<int>(layers.size());
    layer.z_mm = layer.index + 0.5;
    layer.height_mm = 1;
    layer.polygons = polygons;
    layers.push_back(layer);
  }
  return layers;
}

std::vector<Layer> random_stack(std::uint64_t seed, std::size_t count) {
  std::vector<Polygons> areas;
  for (std::size_t i = 0; i < count; ++i) areas.push_back(test::random_polygons(seed + i));
  return stack_of(areas);
}

Polygons square(double size_mm) {
  return {{test::rectangle(-size_mm / 2, -size_mm / 2, size_mm / 2, size_mm / 2), {}}};
}

/// The definition, word for word: what any layer within reach does not cover.
Polygons solid_by_definition(const std::vector<Layer>& layers, std::size_t index, int skin_layers) {
  Polygons solid;
  for (int step = -skin_layers; step <= skin_layers; ++step) {
    const auto other = static_cast<std::ptrdiff_t>(index) + step;
    const bool beyond = other < 0 || other >= static_cast<std::ptrdiff_t>(layers.size());
    const Polygons& own = layers[index].polygons;
    solid = unite(solid,
                  beyond ? own : subtract(own, layers[static_cast<std::size_t>(other)].polygons));
  }
  return solid;
}

double difference_mm2(const Polygons& a, const Polygons& b) {
  return area_mm2(subtract(a, b)) + area_mm2(subtract(b, a));
}

TEST(FindSolid, IsWhatTheDefinitionSays) {
  for (const std::uint64_t seed : {1u, 2u})
    for (const int skin_layers : {1, 2, 4}) {
      std::vector<Layer> layers = random_stack(seed, 13);
      find_solid(layers, skin_layers);
      for (std::size_t i = 0; i < layers.size(); ++i) {
        const Polygons expected = solid_by_definition(layers, i, skin_layers);
        EXPECT_LT(difference_mm2(layers[i].solid, expected), 1e-3) << i << " of " << skin_layers;
      }
    }
}

TEST(FindSolid, BoxHasAFloorAndARoof) {
  std::vector<Layer> layers = stack_of(std::vector<Polygons>(10, square(20)));
  find_solid(layers, 3);
  for (const Layer& layer : layers)
    EXPECT_EQ(layer.solid, layer.index < 3 || layer.index >= 7 ? layer.polygons : Polygons{});
}

TEST(FindSolid, StepIsSolidUpToTheUpperBlock) {
  std::vector<Polygons> areas(10, square(20));
  std::fill(areas.begin() + 5, areas.end(), square(10));
  std::vector<Layer> layers = stack_of(areas);
  find_solid(layers, 2);
  EXPECT_TRUE(layers[2].solid.empty());
  EXPECT_DOUBLE_EQ(area_mm2(layers[3].solid), 300);
  EXPECT_DOUBLE_EQ(area_mm2(layers[4].solid), 300);
  EXPECT_TRUE(layers[5].solid.empty());  // nothing but material below and above it
}

TEST(FindSolid, EmptyLayersAreAir) {
  std::vector<Polygons> areas(9, square(20));
  areas[4].clear();
  std::vector<Layer> layers = stack_of(areas);
  find_solid(layers, 1);
  for (const int i : {0, 3, 5, 8})
    EXPECT_EQ(layers[static_cast<std::size_t>(i)].solid, square(20)) << i;
  for (const int i : {1, 2, 4, 6, 7})
    EXPECT_TRUE(layers[static_cast<std::size_t>(i)].solid.empty()) << i;
}

TEST(FindSolid, EverythingIsSolidWithinReachOfBothEnds) {
  for (const int skin_layers : {5, 6, 1000, 2'000'000'000}) {
    std::vector<Layer> layers = random_stack(7, 10);
    find_solid(layers, skin_layers);
    for (const Layer& layer : layers) EXPECT_EQ(layer.solid, layer.polygons);
  }
}

TEST(FindSolid, ZeroSkinLayersLeaveNothingSolid) {
  std::vector<Layer> layers = random_stack(7, 4);
  find_solid(layers, 2);
  find_solid(layers, 0);
  for (const Layer& layer : layers) EXPECT_TRUE(layer.solid.empty());
  std::vector<Layer> none;
  find_solid(none, 3);
  EXPECT_TRUE(none.empty());
  EXPECT_THROW(find_solid(layers, -1), Error);
}

TEST(FindSolid, LeavesNoSliversAlongSharedWalls) {
  // Walls that lean this way and that: every difference is as wide as the wall leans.
  std::vector<Layer> layers = slice_mesh(test::torus(10, 4, 90, 60, true), {}, "torus").layers;
  find_solid(layers, 2);
  for (const Layer& layer : layers)
    for (const Polygon& polygon : layer.solid)
      EXPECT_GT(area_mm2(polygon), perimeter_mm(polygon.outer) / kGridUnitsPerMm);
}

TEST(FindSolid, TheLoopThatRunsItDoesNotMatter) {
  const ParallelFor backwards = [](std::size_t count,
                                   const std::function<void(std::size_t)>& body) {
    for (std::size_t i = count; i-- > 0;) body(i);
  };
  std::vector<Layer> forth = random_stack(11, 25), back = forth;
  find_solid(forth, 3);
  find_solid(back, 3, backwards);
  EXPECT_EQ(forth, back);
}

std::vector<std::size_t> places(const std::vector<bool>& marks) {
  std::vector<std::size_t> set;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i]) set.push_back(i);
  return set;
}

TEST(FlatFacets, MarkTheLayersAboutTheEndsOfABox) {
  // Planes at 0.1, 0.3, ... 3.9 mm; walls rise by 4 mm over 10.
  const Mesh box = test::prism(test::rectangle(0, 0, 10, 10), 0, 4);
  EXPECT_EQ(places(layers_with_flat_facets(box, FlatRule::kSlope, 0.2, 20)),
            (std::vector<std::size_t>{0, 1, 18, 19}));
  EXPECT_EQ(places(layers_with_flat_facets(box, FlatRule::kNear, 0.2, 20)),
            (std::vector<std::size_t>{0, 1, 2, 3, 16, 17, 18, 19}));
}

TEST(FlatFacets, AreThoseThatRiseByLessThanAFifth) {
  const auto ramp = [](double rise_mm) {
    return Mesh{{{0, 0, 3}, {10, 0, 3}, {0, 6, 3 + rise_mm}}, {{0, 1, 2}}};
  };
  // The first plane at or above 3 mm is the third one at 3.5 mm.
  EXPECT_EQ(places(layers_with_flat_facets(ramp(1.99), FlatRule::kSlope, 1, 10)),
            (std::vector<std::size_t>{1, 2, 3, 4}));
  EXPECT_TRUE(places(layers_with_flat_facets(ramp(2), FlatRule::kSlope, 1, 10)).empty());
  EXPECT_FALSE(places(layers_with_flat_facets(ramp(0.09), FlatRule::kNear, 1, 10)).empty());
  EXPECT_TRUE(places(layers_with_flat_facets(ramp(0.11), FlatRule::kNear, 1, 10)).empty());
}

TEST(SkinFinder, FindsInRegionsWhatTheDefinitionSays) {
  for (const std::uint64_t seed : {1u, 2u}) {
    std::vector<Layer> layers = random_stack(seed, 12);
    // Some neighbours are alike, so that regions lie clear of all air.
    for (const std::size_t i : {4u, 5u, 6u, 7u}) layers[i].polygons = layers[3].polygons;
    for (const int skin_layers : {0, 1, 2, 20}) {
      const SkinFinder finder(layers, skin_layers);
      for (std::size_t i = 0; i < layers.size(); ++i) {
        const Polygons region = offset(layers[i].polygons, -0.3);
        const Polygons expected = intersect(region, solid_by_definition(layers, i, skin_layers));
        EXPECT_LT(difference_mm2(finder.skins_in(region, i), expected), 1e-3)
            << "layer " << i << ", " << skin_layers << " skin layers";
      }
    }
  }
}

TEST(SkinFinder, SeesAHoleOfANeighbourInTheMiddleOfARegion) {
  std::vector<Layer> layers = stack_of({square(10), square(10), square(10)});
  layers[2].polygons[0].holes = {{{-1, -1}, {-1, 1}, {1, 1}, {1, -1}}};
  const SkinFinder finder(layers, 1);
  EXPECT_NEAR(area_mm2(finder.skins_in(square(8), 1)), 4, 1e-9);
  EXPECT_THROW(SkinFinder(layers, -1), Error);
}

}  // namespace
}  // namespace routebench
