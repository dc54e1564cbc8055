#include "routebench/geometry/slice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "meshes.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/region.hpp"
#include "slicing/slivers.hpp"

namespace routebench {
namespace {

using test::box;
using test::together;
using test::torus;

std::vector<Layer> layers_of(const Mesh& mesh, double layer_height_mm,
                             SliceMethod method = SliceMethod::kBucket) {
  SliceOptions options;
  options.layer_height_mm = layer_height_mm;
  options.method = method;
  return slice_mesh(mesh, options, "test").layers;
}

/// What slice_mesh says about a mesh that it refuses.
std::string refusal(const Mesh& mesh, const SliceOptions& options,
                    ErrorKind kind = ErrorKind::kBadInput) {
  try {
    static_cast<void>(slice_mesh(mesh, options, "part.stl"));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "was not refused";
  return {};
}

std::size_t holes(const Polygons& polygons) {
  std::size_t count = 0;
  for (const Polygon& polygon : polygons) count += polygon.holes.size();
  return count;
}

/// Meshes whose vertices, edges and faces meet planes in every way that a slicer gets wrong.
std::vector<Mesh> nasty_meshes() {
  const Mesh cube = box({0, 0, 0}, {10, 10, 10});
  std::vector<Mesh> meshes;
  meshes.push_back(torus(10, 4, 16, 12));
  meshes.push_back(torus(10, 4, 16, 12, true));
  meshes.push_back(together(cube, box({10, 10, 0}, {20, 20, 10})));  // touch along an edge
  meshes.push_back(together(cube, box({10, 0, 0}, {20, 10, 10})));   // share a wall
  meshes.push_back(together(cube, box({5, 5, 5}, {15, 15, 15})));    // overlap
  meshes.push_back(together(cube, box({2, 2, 10}, {8, 8, 15})));     // stand on one another
  meshes.push_back(together(cube, cube));                            // are the same
  meshes.push_back(together(cube, test::inside_out(box({2, 2, 2}, {8, 8, 8}))));  // a cavity
  return meshes;
}

TEST(SliceMesh, BoxHasItsFootprintInEveryLayer) {
  const std::vector<Layer> layers = layers_of(box({1, 2, 0}, {11, 22, 2}), 0.2);
  ASSERT_EQ(layers.size(), 10u);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    EXPECT_EQ(layers[i].index, static_cast<int>(i));
    EXPECT_EQ(layers[i].z_mm, (static_cast<double>(i) + 0.5) * 0.2);
    EXPECT_EQ(layers[i].height_mm, 0.2);
    ASSERT_EQ(layers[i].polygons.size(), 1u);
    EXPECT_TRUE(layers[i].polygons[0].holes.empty());
    EXPECT_DOUBLE_EQ(area_mm2(layers[i].polygons), 200);
    EXPECT_FALSE(layers[i].repaired);
    EXPECT_TRUE(layers[i].solid.empty());
  }
}

TEST(SliceMesh, CoordinatesLieOnTheGrid) {
  for (const Layer& layer : layers_of(torus(10.123, 3.7, 31, 17), 0.3))
    for (const Polygon& polygon : layer.polygons)
      for (const Point2 p : polygon.outer) EXPECT_EQ(p, snap(p));
}

TEST(SliceMesh, LayersAreThePlanesStrictlyBelowTheTop) {
  for (const double height_mm : {0.1, 0.2, 0.3, 1.0 / 3, 0.7})
    for (const double top_mm : {0.9, 1.0, 1.5, 2.1, 2.7, 3.0, 10 * height_mm, 7.5 * height_mm}) {
      const std::vector<Layer> layers = layers_of(box({0, 0, 0}, {1, 1, top_mm}), height_mm);
      ASSERT_FALSE(layers.empty());
      EXPECT_LT(layers.back().z_mm, top_mm);
      EXPECT_GE((static_cast<double>(layers.size()) + 0.5) * height_mm, top_mm);
      for (const Layer& layer : layers) EXPECT_DOUBLE_EQ(area_mm2(layer.polygons), 1);
    }
}

TEST(SliceMesh, PlaneThroughAFlatFaceIsTheLimitFromBelow) {
  // Planes at 0.25, 0.75, 1.25: the step is exactly on the second, the top on no plane.
  const Mesh steps = together(box({0, 0, 0}, {20, 20, 0.75}), box({5, 5, 0.75}, {15, 15, 1.5}));
  const std::vector<Layer> layers = layers_of(steps, 0.5);
  ASSERT_EQ(layers.size(), 3u);
  EXPECT_DOUBLE_EQ(area_mm2(layers[0].polygons), 400);
  EXPECT_DOUBLE_EQ(area_mm2(layers[1].polygons), 400);
  EXPECT_DOUBLE_EQ(area_mm2(layers[2].polygons), 100);
}

TEST(SliceMesh, PlanesThroughVerticesAreTheLimitFromBelow) {
  for (const bool upright : {false, true}) {
    const Mesh mesh = torus(8, 4, 24, 16, upright);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += 5) {
      const double z_mm = mesh.vertices[v].z;
      if (z_mm < 0.5 || z_mm > 23.5 || (!upright && z_mm > 7.9)) continue;  // no plane at the ends
      const double height_mm = 2 * z_mm;  // puts the lowest plane through the vertex
      const std::vector<Layer> layers = layers_of(mesh, height_mm);
      ASSERT_EQ(layers[0].z_mm, z_mm);
      EXPECT_NEAR(area_mm2(layers[0].polygons), test::cut_area_mm2(mesh, z_mm), 1e-4);
      EXPECT_NEAR(area_mm2(layers[0].polygons), test::cut_area_mm2(mesh, z_mm - 1e-8), 1e-4);
    }
  }
}

TEST(SliceMesh, AreaIsThatOfTheTriangleCuts) {
  for (const Mesh& mesh : {torus(10, 4, 64, 48), torus(10, 4, 64, 48, true)})
    for (const double height_mm : {0.05, 0.2, 0.5, 1.0})
      for (const Layer& layer : layers_of(mesh, height_mm)) {
        const double expected = test::cut_area_mm2(mesh, layer.z_mm);
        EXPECT_NEAR(area_mm2(layer.polygons), expected, 1e-6 * expected + 1e-4);
      }
}

TEST(SliceMesh, UprightWallsHaveTheSameContourInEveryLayer) {
  // Wherever the diagonals of their facets run.
  for (const std::string spec : {"shape:cylinder", "shape:gear", "shape:grate"}) {
    SCOPED_TRACE(spec);
    const std::vector<Layer> layers =
        slice_mesh(load_model(spec).mesh, {.straight_mm = 0.001}, spec).layers;
    ASSERT_GT(layers.size(), 3u);
    for (const Layer& layer : layers) EXPECT_EQ(layer.polygons, layers[0].polygons);
  }
}

TEST(SliceMesh, LeaningWallsKeepTheirPlaceInEveryLayer) {
  constexpr double kStraightMm = 0.01, kHeightMm = 10;
  for (const double lean_mm : {0.0, 1e-5, 2e-4, 1e-3, 0.1, 5.0}) {
    SCOPED_TRACE(lean_mm);
    Mesh mesh = box({0, 0, 0}, {20, 20, kHeightMm});
    for (Point3& p : mesh.vertices)
      if (p.z > 0) p.x += lean_mm;
    const Slices slices =
        slice_mesh(mesh, {.layer_height_mm = 0.5, .straight_mm = kStraightMm}, "test");
    for (const Layer& layer : slices.layers) {
      const Box2 found = bounding_box(layer.polygons);
      const double left_mm = lean_mm * layer.z_mm / kHeightMm;
      EXPECT_NEAR(found.lower.x, left_mm, kStraightMm / 100);
      EXPECT_NEAR(found.upper.x, 20 + left_mm, kStraightMm / 100);
    }
  }
}

TEST(SliceMesh, AGapInAnUprightWallIsAsWideAsItIsInEachLayer) {
  Mesh mesh = box({0, 0, 0}, {10, 10, 10});
  const auto is_wall = [&](const auto& corners) {
    const auto z = [&](std::size_t i) { return mesh.vertices[corners[i]].z; };
    return z(0) != z(1) || z(1) != z(2);
  };
  // The gap is nothing at one end of the wall and the whole wall at the other.
  mesh.triangles.erase(std::find_if(mesh.triangles.begin(), mesh.triangles.end(), is_wall));
  for (const double straight_mm : {0.0, 0.01}) {
    SliceOptions options{.layer_height_mm = 0.25, .repair = true, .crack_mm = 1};
    options.straight_mm = straight_mm;
    const Slices slices = slice_mesh(mesh, options, "test");
    EXPECT_EQ(slices.report.cracks_closed, 4u);
    EXPECT_NEAR(slices.report.widest_crack_mm, 0.875, 1e-6);
    EXPECT_EQ(slices.report.repaired_layers, 36u);
    EXPECT_NEAR(slices.report.widest_gap_mm, 9.875, 1e-6);
    options.repair = false;
    EXPECT_NE(refusal(mesh, options), "");
  }
}

TEST(SliceMesh, LayersWithAsManyCutsKeepTheirOwnContours) {
  const Mesh boxes[] = {box({0, 0, 0}, {10, 10, 1}), box({1, 1, 1}, {9, 9, 2}),
                        box({0, 0, 2}, {10, 10, 3})};
  const auto layers = layers_of(together(together(boxes[0], boxes[1]), boxes[2]), 0.2);
  ASSERT_EQ(layers.size(), 15u);
  for (const Layer& layer : layers) {
    const auto storey = static_cast<std::size_t>(layer.index / 5);
    // Alone, from the same bed on.
    const auto alone = layers_of(boxes[storey], 0.2);
    EXPECT_EQ(layer.polygons, alone[static_cast<std::size_t>(layer.index)].polygons) << layer.index;
  }
}

TEST(Slivers, SpikesAndNotchesWithoutWidthGoAndNothingElse) {
  // Cut at any place along their sides, on a square and with a corner of their own beside them.
  const Ring square{{10, 0}, {10, 10}, {0, 10}, {0, 0}};
  const Ring notched{{10, 0},     {10, 4.9999}, {7, 4.9999}, {4, 5},  {6, 5.0001},
                     {9, 5.0001}, {10, 5.0001}, {10, 10},    {0, 10}, {0, 7},
                     {-3, 7},     {-1, 7.0002}, {0, 7.0002}, {0, 0}};
  const Ring clean = slicing::without_spikes(notched);
  EXPECT_NEAR(signed_area_mm2(clean), 100, 1e-2);
  for (const Point2 p : clean) EXPECT_TRUE(p.x > -0.001 && (p.x < 0.001 || p.x > 9.999));
  EXPECT_EQ(slicing::without_spikes(square), square);
  const Ring wide{{10, 0}, {10, 4.9}, {4, 5}, {10, 5.1}, {10, 10}, {0, 10}, {0, 0}};
  EXPECT_EQ(slicing::without_spikes(wide), wide);
  EXPECT_LT(slicing::without_spikes({{0, 0}, {5, 0}, {9, 0}, {4, 0.0001}}).size(), 3U);
  EXPECT_TRUE(slicing::without_spikes({}).empty());
}

TEST(SliceMesh, SumOfAreasApproachesTheVolume) {
  const Mesh mesh = torus(10, 4, 64, 48, true);
  const double volume_mm3 = test::volume_mm3(mesh);
  double error_before = std::numeric_limits<double>::infinity();
  for (const double height_mm : {2.0, 0.5, 0.125}) {
    double sum_mm3 = 0;
    for (const Layer& layer : layers_of(mesh, height_mm))
      sum_mm3 += area_mm2(layer.polygons) * layer.height_mm;
    const double error = std::abs(sum_mm3 / volume_mm3 - 1);
    EXPECT_LT(error, error_before);
    error_before = error;
  }
  EXPECT_LT(error_before, 1e-3);
}

TEST(SliceMesh, HolesAndIslandsAreThoseOfTheSolid) {
  for (const Layer& layer : layers_of(torus(10, 4, 64, 48), 0.2)) {
    ASSERT_EQ(layer.polygons.size(), 1u);
    EXPECT_EQ(layer.polygons[0].holes.size(), 1u);
  }
  for (const Layer& layer : layers_of(torus(10, 4, 64, 48, true), 0.2)) {
    const bool beside_the_hole = layer.z_mm > 8 && layer.z_mm < 20;  // and no plane near its ends
    EXPECT_EQ(holes(layer.polygons), 0u);
    EXPECT_EQ(layer.polygons.size(), beside_the_hole ? 2u : 1u) << layer.z_mm;
  }
}

TEST(SliceMesh, OverlappingShellsAreOneSolid) {
  const Mesh mesh = together(box({0, 0, 0}, {10, 10, 10}), box({5, 5, 0}, {15, 15, 10}));
  for (const Layer& layer : layers_of(mesh, 0.5)) {
    ASSERT_EQ(layer.polygons.size(), 1u);
    EXPECT_DOUBLE_EQ(area_mm2(layer.polygons), 175);
  }
}

TEST(SliceMesh, SharedWallsVanishAndDuplicatesDoNoHarm) {
  const Mesh cube = box({0, 0, 0}, {10, 10, 10});
  for (const Layer& layer : layers_of(together(cube, box({10, 0, 0}, {20, 10, 10})), 0.5)) {
    EXPECT_EQ(layer.polygons.size(), 1u);
    EXPECT_DOUBLE_EQ(area_mm2(layer.polygons), 200);
  }
  for (const Layer& layer : layers_of(together(cube, cube), 0.5)) {
    EXPECT_EQ(layer.polygons.size(), 1u);
    EXPECT_DOUBLE_EQ(area_mm2(layer.polygons), 100);
  }
}

TEST(SliceMesh, CavitiesAreHollowAndShellsWithinShellsAreSolid) {
  const Mesh outer = box({0, 0, 0}, {10, 10, 10}), inner = box({2, 2, 2}, {8, 8, 8});
  const std::vector<Layer> hollow = layers_of(together(outer, test::inside_out(inner)), 1);
  const std::vector<Layer> nested = layers_of(together(outer, inner), 1);
  EXPECT_DOUBLE_EQ(area_mm2(hollow[4].polygons), 64);
  EXPECT_EQ(holes(hollow[4].polygons), 1u);
  EXPECT_DOUBLE_EQ(area_mm2(nested[4].polygons), 100);
  EXPECT_EQ(holes(nested[4].polygons), 0u);
}

TEST(SliceMesh, EveryOrderGivesTheSameLayers) {
  for (const Mesh& mesh : nasty_meshes())
    for (const double height_mm : {0.5, 0.8, 1.0, 1.7}) {
      const std::vector<Layer> expected = layers_of(mesh, height_mm);
      for (std::uint32_t seed = 1; seed <= 5; ++seed)
        EXPECT_EQ(layers_of(test::shuffled(mesh, seed), height_mm), expected);
    }
}

TEST(SliceMesh, EveryMethodGivesTheSameLayers) {
  for (const Mesh& mesh : nasty_meshes())
    for (const double height_mm : {0.1, 0.8, 1.0, 30.0 / 7}) {
      const std::vector<Layer> expected = layers_of(mesh, height_mm);
      EXPECT_EQ(layers_of(mesh, height_mm, SliceMethod::kSweep), expected);
      EXPECT_EQ(layers_of(mesh, height_mm, SliceMethod::kNaive), expected);
    }
}

TEST(SliceMesh, UprightWallsAreTheSameByEveryMethodAndInAnyOrder) {
  std::vector<Mesh> meshes = nasty_meshes();
  meshes.push_back(load_model("shape:gear").mesh);
  meshes.push_back(box({0, 0, 0}, {10, 10, 10}));
  for (Point3& p : meshes.back().vertices)
    if (p.z > 0) p.x += 1e-4;  // leans by hardly less than makes a difference
  meshes.push_back(box({0, 0, 0}, {10, 10, 10}));
  for (Point3& p : meshes.back().vertices)
    if (p.z > 0 && p.x > 0) p.x += 1;  // of the four walls one leans
  for (const Mesh& mesh : meshes) {
    const auto layers_by = [&](const Mesh& of, SliceMethod method) {
      return slice_mesh(of, {.method = method, .straight_mm = 0.0125}, "test").layers;
    };
    const std::vector<Layer> expected = layers_by(mesh, SliceMethod::kBucket);
    EXPECT_EQ(layers_by(mesh, SliceMethod::kSweep), expected);
    EXPECT_EQ(layers_by(mesh, SliceMethod::kNaive), expected);
    for (const std::uint32_t seed : {1U, 2U})
      EXPECT_EQ(layers_by(test::shuffled(mesh, seed), SliceMethod::kBucket), expected);
  }
}

TEST(SliceMesh, TheLoopThatRunsItDoesNotMatter) {
  const ParallelFor backwards = [](std::size_t count,
                                   const std::function<void(std::size_t)>& body) {
    for (std::size_t i = count; i-- > 0;) body(i);
  };
  const Mesh mesh = torus(10, 4, 300, 300);  // more than one block of triangles
  EXPECT_EQ(slice_mesh(mesh, {}, "test", backwards).layers, slice_mesh(mesh, {}, "test").layers);
}

TEST(SliceMesh, RefusesWhatHasNothingToPrint) {
  EXPECT_NE(refusal(Mesh{}, {}).find("part.stl: nothing to print"), std::string::npos);
  EXPECT_NE(refusal(box({0, 0, 0}, {0.02, 0.02, 0.02}), {}).find("0.02 mm high"),
            std::string::npos);
  const Mesh sheet{{{0, 0, 0}, {10, 0, 0}, {0, 0, 10}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_NE(refusal(sheet, {}).find("surface without volume"), std::string::npos);
}

TEST(SliceMesh, RefusesAbsurdOptions) {
  const Mesh cube = box({0, 0, 0}, {10, 10, 10});
  for (const double height_mm :
       {0.0, -0.2, std::nan(""), std::numeric_limits<double>::infinity()}) {
    SliceOptions options;
    options.layer_height_mm = height_mm;
    EXPECT_NE(refusal(cube, options).find("layer_height_mm"), std::string::npos);
  }
  SliceOptions too_thin;
  too_thin.layer_height_mm = 1e-5;
  EXPECT_NE(refusal(cube, too_thin).find("at least 0.0001 mm"), std::string::npos);
  too_thin.layer_height_mm = std::numeric_limits<double>::denorm_min();
  EXPECT_NE(refusal(cube, too_thin).find("100000"), std::string::npos);
  SliceOptions no_crack;
  no_crack.crack_mm = std::nan("");
  EXPECT_NE(refusal(cube, no_crack).find("crack_mm"), std::string::npos);
}

TEST(SliceMesh, RefusesMeshesThatAreNone) {
  Mesh mesh = box({0, 0, 0}, {10, 10, 10});
  mesh.triangles.push_back({0, 1, 99});
  EXPECT_NE(refusal(mesh, {}).find("vertex 99"), std::string::npos);
  mesh.triangles.pop_back();
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30}) {
    mesh.vertices[3].y = bad;
    EXPECT_NE(refusal(mesh, {}).find("vertex 3"), std::string::npos);
  }
}

TEST(SliceMesh, VerticesOfNoTriangleDoNotCount) {
  const Mesh mesh = box({0, 0, 0}, {10, 10, 10});
  const Slices expected = slice_mesh(mesh, {}, "part");
  // The highest vertices belong to no triangle, or one of several that are as high does not.
  for (const double z_mm : {10.0, 70.0}) {
    Mesh with_more = mesh;
    for (auto& triangle : with_more.triangles)
      for (std::uint32_t& corner : triangle) ++corner;
    with_more.vertices.insert(with_more.vertices.begin(), {3, 3, z_mm});
    with_more.vertices.push_back({3, 4, z_mm});
    const Slices slices = slice_mesh(with_more, {}, "part");
    ASSERT_EQ(slices.layers.size(), expected.layers.size());
    for (std::size_t i = 0; i < slices.layers.size(); ++i)
      EXPECT_EQ(slices.layers[i].polygons, expected.layers[i].polygons);
  }
}

TEST(SliceMethod, NamesAreUnderstoodOrRefused) {
  EXPECT_EQ(slice_method("bucket"), SliceMethod::kBucket);
  EXPECT_EQ(slice_method("sweep"), SliceMethod::kSweep);
  EXPECT_EQ(slice_method("naive"), SliceMethod::kNaive);
  EXPECT_EQ(slice_method("voxel"), SliceMethod::kVoxel);
  EXPECT_THROW(static_cast<void>(slice_method("fast")), Error);
}

}  // namespace
}  // namespace routebench
