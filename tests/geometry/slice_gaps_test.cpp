// Meshes that are not closed: what is mended unasked, what is refused, what --repair makes of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "meshes.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"

namespace routebench {
namespace {

using test::box;
using test::together;
using test::torus;

const Mesh kCube = box({0, 0, 0}, {10, 10, 10});

SliceOptions with_repair(double layer_height_mm = 0.2) {
  SliceOptions options;
  options.layer_height_mm = layer_height_mm;
  options.repair = true;
  return options;
}

Slices sliced(const Mesh& mesh, const SliceOptions& options = {}) {
  return slice_mesh(mesh, options, "part.stl");
}

std::string refusal(const Mesh& mesh, const SliceOptions& options = {}) {
  try {
    static_cast<void>(sliced(mesh, options));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "was not refused";
  return {};
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Triangles of the mesh without those at the given places.
Mesh without(Mesh mesh, std::vector<std::size_t> places) {
  std::sort(places.rbegin(), places.rend());
  for (const std::size_t place : places)
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(place));
  return mesh;
}

/// A sheet over an open line, from z = 0 to z = 10, one triangle thick.
Mesh sheet(const std::vector<Point2>& line) {
  Mesh mesh;
  for (const Point2 p : line) {
    mesh.vertices.push_back({p.x, p.y, 0});
    mesh.vertices.push_back({p.x, p.y, 10});
  }
  for (std::uint32_t i = 0; i + 3 < mesh.vertices.size(); i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 3});
    mesh.triangles.push_back({i, i + 3, i + 1});
  }
  return mesh;
}

TEST(SliceGaps, FacetsThatShareNoVerticesCloseExactly) {
  for (const Mesh& mesh : {kCube, torus(10, 4, 40, 30), torus(10, 4, 40, 30, true)}) {
    const Slices slices = sliced(test::unwelded(mesh, 0, 1));
    EXPECT_EQ(slices.layers, sliced(mesh).layers);
    EXPECT_EQ(slices.report.cracks_closed, 0u);
    EXPECT_TRUE(slices.report.warnings.empty());
  }
}

TEST(SliceGaps, CracksAreClosedAndCounted) {
  Ring circle;
  for (int i = 0; i < 60; ++i)
    circle.push_back(
        {10 * std::cos(i * std::numbers::pi / 30), 10 * std::sin(i * std::numbers::pi / 30)});
  const Mesh mesh = test::prism(circle, 0, 10);
  for (const double jitter_mm : {1e-6, 1e-4, 1e-3, 0.01}) {
    const Slices slices = sliced(test::unwelded(mesh, jitter_mm, 1));
    EXPECT_GT(slices.report.cracks_closed, 1000u);
    EXPECT_LE(slices.report.widest_crack_mm, 0.1);
    EXPECT_EQ(slices.report.repaired_layers, 0u);
    ASSERT_EQ(slices.report.warnings.size(), 1u);
    EXPECT_TRUE(mentions(slices.report.warnings[0], "crack"));
    for (const Layer& layer : slices.layers) {
      EXPECT_EQ(layer.polygons.size(), 1u);
      EXPECT_NEAR(area_mm2(layer.polygons), test::cut_area_mm2(mesh, 5), 100 * jitter_mm);
      EXPECT_FALSE(layer.repaired);
    }
  }
}

TEST(SliceGaps, CornerInTheMiddleOfAnEdgeLeavesNoGap) {
  // The edge between two walls of the cube is split on one side only, at a height off the grid.
  Mesh mesh = kCube;
  mesh.vertices.push_back({10, 0, 10.0 / 3});
  const auto corner = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto triangle = mesh.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 a = mesh.vertices[triangle[i]], b = mesh.vertices[triangle[(i + 1) % 3]];
      if (a != Point3{10, 0, 0} || b != Point3{10, 0, 10}) continue;
      mesh.triangles[t] = {triangle[i], corner, triangle[(i + 2) % 3]};
      mesh.triangles.push_back({corner, triangle[(i + 1) % 3], triangle[(i + 2) % 3]});
      t = mesh.triangles.size();
      break;
    }
  }
  ASSERT_EQ(mesh.triangles.size(), kCube.triangles.size() + 1);
  const Slices slices = sliced(mesh);
  for (const Layer& layer : slices.layers) {
    EXPECT_EQ(layer.polygons.size(), 1u);
    EXPECT_NEAR(area_mm2(layer.polygons), 100, 1e-4);
  }
}

TEST(SliceGaps, WiderGapsAreRefusedByName) {
  // One of the two triangles of the wall at y = 0: open from x = z to x = 10 in every layer.
  const std::string message = refusal(without(kCube, {0}));
  for (const char* part :
       {"part.stl", "layer 0 ", "z = 0.1 mm", "open by 9.9 mm", "x = 0.1", "y = 0", "--repair"})
    EXPECT_TRUE(mentions(message, part)) << part << " is not in: " << message;
}

TEST(SliceGaps, TheLowestOpenLayerIsNamedWhateverTheLoop) {
  const Mesh mesh = together(kCube, without(test::moved(kCube, {20, 0, 3}), {0}));
  const ParallelFor backwards = [](std::size_t count,
                                   const std::function<void(std::size_t)>& body) {
    for (std::size_t i = count; i-- > 0;) body(i);
  };
  const std::string message = refusal(mesh);
  EXPECT_TRUE(mentions(message, "layer 15 (z = 3.1 mm)")) << message;
  try {
    static_cast<void>(slice_mesh(mesh, {}, "part.stl", backwards));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), message);
  }
}

TEST(SliceGaps, RepairClosesGapsAndMarksTheLayers) {
  const Mesh open = without(test::moved(kCube, {20, 0, 3}), {0});
  const Slices slices = sliced(together(kCube, open), with_repair());
  const Slices sound = sliced(together(kCube, test::moved(kCube, {20, 0, 3})));
  ASSERT_EQ(slices.layers.size(), sound.layers.size());
  for (std::size_t i = 0; i < sound.layers.size(); ++i) {
    EXPECT_EQ(slices.layers[i].repaired, i >= 15);
    EXPECT_EQ(slices.layers[i].polygons, sound.layers[i].polygons);
  }
  EXPECT_EQ(slices.report.repaired_layers, sound.layers.size() - 15);
  EXPECT_EQ(slices.report.gaps_repaired, sound.layers.size() - 15);
  EXPECT_NEAR(slices.report.widest_gap_mm, 9.9, 1e-5);
  ASSERT_EQ(slices.report.warnings.size(), 2u);
  EXPECT_TRUE(mentions(slices.report.warnings[0], "the first is layer 15 (z = 3.1 mm)"));
}

TEST(SliceGaps, CrackLimitIsAnOption) {
  SliceOptions options;
  const Mesh mesh = test::unwelded(kCube, 0.01, 3);
  EXPECT_NO_THROW(static_cast<void>(sliced(mesh, options)));
  options.crack_mm = 1e-4;
  EXPECT_TRUE(mentions(refusal(mesh, options), "cracks up to 0.0001 mm"));
}

TEST(SliceGaps, MissingWallsAreClosedStraightAcross) {
  // A thin plate that lacks both of its narrow ends, and a box that lacks a whole side.
  const Mesh plate = box({0, 0, 0}, {50, 2, 10});
  const Mesh ends_gone = without(plate, {4, 5, 12, 13});
  for (const Layer& layer : sliced(ends_gone, with_repair(1)).layers)
    EXPECT_NEAR(area_mm2(layer.polygons), 100, 1e-4);
  for (const Layer& layer : sliced(without(kCube, {0, 1}), with_repair(1)).layers)
    EXPECT_NEAR(area_mm2(layer.polygons), 100, 1e-4);
}

TEST(SliceGaps, OpenFloorAndRoofDoNoHarm) {
  Mesh mesh = kCube;
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    return mesh.vertices[triangle[0]].z == mesh.vertices[triangle[1]].z &&
           mesh.vertices[triangle[0]].z == mesh.vertices[triangle[2]].z;
  });
  EXPECT_EQ(sliced(mesh).layers, sliced(kCube).layers);
}

TEST(SliceGaps, SurfacesWithoutThicknessAreNotFilled) {
  const Mesh bent = sheet({{30, 0}, {35, 1}, {40, 0}});
  EXPECT_TRUE(mentions(refusal(together(kCube, bent)), "open by 10 mm"));
  const Slices slices = sliced(together(kCube, bent), with_repair());
  for (const Layer& layer : slices.layers) {
    EXPECT_DOUBLE_EQ(area_mm2(layer.polygons), 100);
    EXPECT_TRUE(layer.repaired);
  }
  EXPECT_EQ(slices.report.gaps_repaired, 0u);
  EXPECT_TRUE(std::any_of(
      slices.report.warnings.begin(), slices.report.warnings.end(),
      [](const std::string& warning) { return mentions(warning, "without thickness"); }));
  EXPECT_TRUE(mentions(refusal(bent, with_repair()), "nothing to print"));
}

TEST(SliceGaps, SheetsWithTwoSidesVanish) {
  const Mesh front = sheet({{30, 0}, {35, 1}, {40, 0}});
  const Slices slices = sliced(together(kCube, together(front, test::inside_out(front))));
  EXPECT_EQ(slices.layers, sliced(kCube).layers);
}

TEST(SliceGaps, FacetsThatDisagreeAreJoinedAgainstTheirDirection) {
  Mesh mesh = torus(10, 4, 40, 30, true);
  std::mt19937 random(1);
  for (auto& triangle : mesh.triangles)
    if (random() % 5 == 0) std::swap(triangle[1], triangle[2]);
  const Slices slices = sliced(mesh);
  const Slices sound = sliced(torus(10, 4, 40, 30, true));
  for (std::size_t i = 0; i < sound.layers.size(); ++i)
    EXPECT_NEAR(area_mm2(slices.layers[i].polygons), area_mm2(sound.layers[i].polygons), 1e-3) << i;
  EXPECT_TRUE(mentions(slices.report.warnings.back(), "disagree"));
}

TEST(SliceGaps, EveryOrderAndMethodGivesTheSameLayers) {
  std::vector<Mesh> meshes;
  meshes.push_back(test::unwelded(torus(10, 4, 20, 12, true), 1e-3, 1));
  meshes.push_back(without(torus(10, 4, 20, 12, true), {3, 77, 78, 140, 141, 300, 301}));
  meshes.push_back(together(kCube, sheet({{5, 5}, {20, 6}, {5, 7}, {12, 30}})));
  Mesh flipped = torus(10, 4, 20, 12);
  for (std::size_t t = 0; t < flipped.triangles.size(); t += 3)
    std::swap(flipped.triangles[t][1], flipped.triangles[t][2]);
  meshes.push_back(flipped);
  for (const Mesh& mesh : meshes) {
    SliceOptions options = with_repair(0.5);
    const Slices expected = sliced(mesh, options);
    for (std::uint32_t seed = 1; seed <= 5; ++seed)
      EXPECT_EQ(sliced(test::shuffled(mesh, seed), options).layers, expected.layers);
    for (const SliceMethod method : {SliceMethod::kSweep, SliceMethod::kNaive}) {
      options.method = method;
      EXPECT_EQ(sliced(mesh, options).layers, expected.layers);
    }
  }
}

TEST(SliceGaps, TensOfThousandsOfLoosePiecesEndInAResult) {
  // Single upright facets everywhere: no two of them belong together.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0, 200), step(-1, 1);
  Mesh mesh = test::moved(kCube, {-20, 0, 0});
  for (int i = 0; i < 10'000; ++i) {
    const double x = place(random), y = place(random);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({x, y, 0});
    mesh.vertices.push_back({x + step(random), y + step(random), 0});
    mesh.vertices.push_back({x, y, 0.25});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(mentions(refusal(mesh), "--repair"));
  const Slices slices = sliced(mesh, with_repair());
  EXPECT_DOUBLE_EQ(area_mm2(slices.layers.back().polygons), 100);
  EXPECT_EQ(slices.report.repaired_layers, 1u);
}

}  // namespace
}  // namespace routebench
