/// Slicing by way of a container of cells.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "meshes.hpp"
#include "models.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"

namespace routebench {
namespace {

using test::box;
using test::together;
using test::torus;

Slices slices_of(const Mesh& mesh, double height_mm, double cell_mm,
                 SliceMethod method = SliceMethod::kVoxel) {
  SliceOptions options;
  options.layer_height_mm = height_mm;
  options.method = method;
  options.cell_mm = cell_mm;
  return slice_mesh(mesh, options, "test");
}

double volume_mm3(const Slices& slices) {
  double sum = 0;
  for (const Layer& layer : slices.layers) sum += area_mm2(layer.polygons) * layer.height_mm;
  return sum;
}

/// What lies deeper than a cell inside a layer has the centre of its cell inside too: if it is not
/// there, the flood came through the surface.
void expect_no_leak(const Mesh& mesh, double height_mm, double cell_mm) {
  const Slices exact = slices_of(mesh, height_mm, cell_mm, SliceMethod::kBucket);
  const Slices voxels = slices_of(mesh, height_mm, cell_mm);
  ASSERT_EQ(voxels.layers.size(), exact.layers.size());
  EXPECT_TRUE(voxels.report.warnings.empty());
  for (std::size_t i = 0; i < exact.layers.size(); ++i) {
    EXPECT_EQ(voxels.layers[i].z_mm, exact.layers[i].z_mm);
    const Polygons deep = offset(exact.layers[i].polygons, -1.02 * cell_mm);
    ASSERT_LT(area_mm2(subtract(deep, voxels.layers[i].polygons)), 1e-6) << "layer " << i;
  }
}

Mesh tetrahedron(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0, 12);
  Mesh mesh;
  for (int i = 0; i < 4; ++i)
    mesh.vertices.push_back({place(random), place(random), place(random)});
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return test::volume_mm3(mesh) > 0 ? mesh : test::inside_out(mesh);
}

TEST(SliceVoxel, ABoxBetweenCentresIsExactlyItsCells) {
  // 21 centres lie from 0 to 10 mm, every half of one, and the cells reach a quarter beyond.
  const Slices slices = slices_of(box({0, 0, 0}, {10, 10, 10}), 0.5, 0.5);
  ASSERT_EQ(slices.layers.size(), 20U);
  for (const Layer& layer : slices.layers) {
    ASSERT_EQ(layer.polygons.size(), 1U);
    EXPECT_EQ(layer.polygons[0].outer,
              (Ring{{-0.25, -0.25}, {10.25, -0.25}, {10.25, 10.25}, {-0.25, 10.25}}));
    EXPECT_TRUE(layer.polygons[0].holes.empty());
  }
  EXPECT_EQ(slices.layers[3].z_mm, 1.75);
}

TEST(SliceVoxel, VolumeTendsToTheMeshs) {
  const Mesh mesh = torus(10, 4, 64, 48);
  const double exact = volume_mm3(slices_of(mesh, 0.05, 1, SliceMethod::kBucket));
  double last_error = exact;
  for (const double cell_mm : {1.0, 0.5, 0.25, 0.125}) {
    const double error = volume_mm3(slices_of(mesh, cell_mm, cell_mm)) - exact;
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.65 * last_error);
    last_error = error;
  }
  EXPECT_LT(last_error, 0.06 * exact);
}

TEST(SliceVoxel, NoTriangleHasPinholes) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    expect_no_leak(tetrahedron(seed), 0.2, 0.3);
  }
}

TEST(SliceVoxel, FacesOnCentresAndBetweenThemHold) {
  for (const double size : {4.0, 4.25, 4.5, 4.1}) {
    const Mesh cube = box({0, 0, 0}, {size, size, size});
    expect_no_leak(cube, 0.5, 0.5);
    expect_no_leak(together(cube, box({size, size, 0}, {2 * size, 2 * size, size})), 0.5, 0.5);
    expect_no_leak(together(cube, box({1, 1, size}, {2, 2, size + 3})), 0.5, 0.5);
  }
  expect_no_leak(torus(10, 4, 16, 12), 0.25, 0.25);
  expect_no_leak(torus(10, 4, 16, 12, true), 0.25, 0.4);
}

TEST(SliceVoxel, RealModelsHold) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  for (const char* name :
       {"calibration/voron_cube.stl", "functional/kossel_effector.stl", "organic/spot.stl"}) {
    SCOPED_TRACE(name);
    expect_no_leak(load_model((models / name).string(), {}).mesh, 0.6, 0.5);
  }
}

TEST(SliceVoxel, CellsThatTouchInAnEdgeAreTwoPolygons) {
  const Mesh mesh = together(box({0, 0, 0}, {1, 1, 1}), box({1.5, 1.5, 0}, {2.5, 2.5, 1}));
  for (const Layer& layer : slices_of(mesh, 0.5, 0.5).layers) {
    ASSERT_EQ(layer.polygons.size(), 2U);
    EXPECT_EQ(layer.polygons[0].outer,
              (Ring{{-0.25, -0.25}, {1.25, -0.25}, {1.25, 1.25}, {-0.25, 1.25}}));
  }
}

TEST(SliceVoxel, HolesAreOpenAndCavitiesAreFilled) {
  // A cavity cannot be reached from outside; a hole can, from above.
  const Mesh cube = box({0, 0, 0}, {10, 10, 10});
  const Slices cavity =
      slices_of(together(cube, test::inside_out(box({3, 3, 3}, {7, 7, 7}))), 1, 0.5);
  for (const Layer& layer : cavity.layers) EXPECT_EQ(area_mm2(layer.polygons), 110.25);
  const Slices ring = slices_of(torus(10, 4, 32, 24), 0.5, 0.5);
  ASSERT_EQ(ring.layers[8].polygons.size(), 1U);
  EXPECT_EQ(ring.layers[8].polygons[0].holes.size(), 1U);
}

TEST(SliceVoxel, SaysThatAnOpenMeshLosesItsInside) {
  Mesh mesh = box({0, 0, 0}, {10, 10, 10});
  mesh.triangles.pop_back();
  EXPECT_EQ(slices_of(mesh, 0.5, 0.5).report.warnings.size(), 1U);
}

TEST(SliceVoxel, SaysWhatItNeedsAndRefusesMoreThanThereMayBe) {
  const Mesh cube = box({0, 0, 0}, {100, 100, 100});
  SliceOptions options;
  options.method = SliceMethod::kVoxel;
  options.layer_height_mm = 1;
  options.cell_mm = 0.5;
  const VoxelContainer container = voxel_container(cube, options, "part.stl");
  EXPECT_EQ(container.cells, (std::array<std::int64_t, 3>{203, 203, 102}));
  EXPECT_EQ(container.bytes, 2 * 4 * 8 * 203 * 102);
  for (const double cell_mm : {0.001, 1e-300}) {
    options.cell_mm = cell_mm;
    try {
      static_cast<void>(slice_mesh(cube, options, "part.stl"));
      FAIL() << "it was not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with("part.stl: ")) << message;
      EXPECT_NE(message.find("GiB"), message.npos) << message;
    }
  }
}

}  // namespace
}  // namespace routebench
