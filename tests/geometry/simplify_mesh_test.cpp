/// Models with ?simplify=.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "meshes.hpp"
#include "model_files.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/stl.hpp"

namespace routebench {
namespace {

using test::ModelFile;
using test::refusal_of;

Model loaded(const Mesh& mesh, const std::string& query) {
  const ModelFile file("part.stl", stl_bytes(mesh));
  return load_model(file.path() + query);
}

TEST(SimplifyMesh, LeavesTheShareThatIsAskedFor) {
  const Mesh mesh = test::torus(20, 5, 120, 60);
  for (const double share : {0.5, 0.1, 0.02}) {
    const Model model = loaded(mesh, "?simplify=" + std::to_string(share));
    ASSERT_TRUE(model.report.simplification);
    const Simplification& done = *model.report.simplification;
    EXPECT_EQ(done.triangles_before, mesh.triangles.size());
    EXPECT_EQ(done.triangles_after, model.mesh.triangles.size());
    EXPECT_NEAR(static_cast<double>(done.triangles_after),
                share * static_cast<double>(mesh.triangles.size()), 4);
    EXPECT_EQ(model.report.triangles, mesh.triangles.size()) << "the report tells of the file";
  }
}

// The volume between two surfaces is at most area times distance.
TEST(SimplifyMesh, TheDeviationBoundsWhatIsLost) {
  const Mesh mesh = test::torus(20, 5, 120, 60);
  const double area_mm2 = 4 * 3.14159265 * 3.14159265 * 20 * 5;
  double before = 0;
  for (const double share : {0.5, 0.1, 0.02}) {
    const Model model = loaded(mesh, "?simplify=" + std::to_string(share));
    const double deviation_mm = model.report.simplification->deviation_mm;
    EXPECT_GT(deviation_mm, before) << "fewer triangles, larger deviation";
    before = deviation_mm;
    EXPECT_LE(std::abs(test::volume_mm3(model.mesh) - test::volume_mm3(mesh)),
              area_mm2 * deviation_mm);
    EXPECT_LT(deviation_mm, 1);
  }
}

// Where faces are flat there is nothing to lose.
TEST(SimplifyMesh, FlatFacesLoseNothing) {
  const Model fine = load_model("shape:box?size=20&triangles=3000");
  const Model coarse = load_model("shape:box?size=20&triangles=3000&simplify=0.01");
  ASSERT_GT(fine.mesh.triangles.size(), 2000U);
  EXPECT_LT(coarse.mesh.triangles.size(), 60U);
  EXPECT_NEAR(coarse.report.simplification->deviation_mm, 0, 1e-9);
  EXPECT_NEAR(test::volume_mm3(coarse.mesh), 8000, 1e-6);
}

TEST(SimplifyMesh, ScalingScalesTheDeviation) {
  const Mesh mesh = test::torus(20, 5, 60, 30);
  const Model one = loaded(mesh, "?simplify=0.1&size=50");
  const Model two = loaded(mesh, "?simplify=0.1&size=100");
  EXPECT_NEAR(two.report.simplification->deviation_mm, 2 * one.report.simplification->deviation_mm,
              1e-9);
}

TEST(SimplifyMesh, DoesNotDependOnTheOrderOfTriangles) {
  const Mesh mesh = test::torus(20, 5, 60, 30);
  const std::uint64_t hash = content_hash(loaded(mesh, "?simplify=0.1").mesh);
  for (const std::uint32_t seed : {1U, 2U, 3U})
    EXPECT_EQ(content_hash(loaded(test::shuffled(mesh, seed), "?simplify=0.1").mesh), hash);
}

TEST(SimplifyMesh, OneSurfaceOrNone) {
  const Mesh touching =
      test::together(test::box({0, 0, 0}, {10, 10, 10}), test::box({10, 10, 0}, {20, 20, 10}));
  const ModelFile file("touching.stl", stl_bytes(touching));
  EXPECT_NE(refusal_of(file.path() + "?simplify=0.5").find("cannot be simplified"),
            std::string::npos);
  for (const char* share : {"0", "1.5", "-1", "nan", "half", "0.5mm"})
    EXPECT_NE(refusal_of(file.path() + "?simplify=" + share).find("share of triangles"),
              std::string::npos)
        << share;
}

}  // namespace
}  // namespace routebench
