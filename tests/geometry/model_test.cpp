#include "routebench/geometry/model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "meshes.hpp"
#include "model_files.hpp"
#include "routebench/geometry/stl.hpp"

namespace routebench {
namespace {

using test::box;
using test::inside_out;
using test::mentions;
using test::ModelFile;
using test::moved;
using test::refusal_of;
using test::together;
using test::torus;

Model loaded(const Mesh& mesh, const std::string& query = "") {
  const ModelFile file("part.stl", stl_bytes(mesh));
  return load_model(file.path() + query);
}

const Mesh& cube() {
  static const Mesh mesh = box({0, 0, 0}, {20, 20, 20});
  return mesh;
}

/// Every second triangle turned over.
Mesh half_flipped(Mesh mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return mesh;
}

TEST(Mending, ASoundMeshIsLeftAsItIs) {
  const Mesh mesh = torus(20, 5, 40, 20);
  const Model model = loaded(mesh);
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(model.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_NEAR(model.report.volume_mm3, test::volume_mm3(mesh), 1e-2);
  EXPECT_EQ(model.report.components, 1U);
}

TEST(Mending, TheHashKnowsTheSurfaceAndNothingElse) {
  const Mesh mesh = torus(20, 5, 40, 20);
  const std::uint64_t hash = content_hash(loaded(mesh).mesh);
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    EXPECT_EQ(content_hash(loaded(test::shuffled(mesh, seed)).mesh), hash);
  }
  // A cube's heights stay exact when it is lifted; a torus's are rounded anew in the file.
  EXPECT_EQ(content_hash(loaded(moved(cube(), {0, 0, 8})).mesh), content_hash(loaded(cube()).mesh));
  EXPECT_NE(content_hash(loaded(moved(mesh, {8, 0, 0})).mesh), hash);
  Mesh dented = mesh;
  dented.vertices[7].z += 1e-3;
  EXPECT_NE(content_hash(loaded(dented).mesh), hash);
}

TEST(Mending, FlippedTrianglesAreTurnedWhateverTheirNumber) {
  const Mesh mesh = torus(20, 5, 40, 20);
  const Model sound = loaded(mesh);
  for (const std::size_t flipped : {std::size_t{1}, std::size_t{300}, std::size_t{1300}}) {
    Mesh broken = mesh;
    for (std::size_t t = 0; t < flipped; ++t) {
      std::swap(broken.triangles[t][1], broken.triangles[t][2]);
    }
    const Model model = loaded(test::shuffled(broken, 5));
    EXPECT_EQ(content_hash(model.mesh), content_hash(sound.mesh));
    EXPECT_EQ(model.report.flipped_triangles, std::min(flipped, mesh.triangles.size() - flipped));
    EXPECT_TRUE(mentions(model.warnings, "flipped"));
  }
  EXPECT_EQ(content_hash(loaded(half_flipped(cube())).mesh), content_hash(loaded(cube()).mesh));
}

TEST(Mending, ShellsThatFaceInwardsAreTurnedButCavitiesStay) {
  const Mesh outer = box({0, 0, 0}, {30, 30, 30});
  const Mesh inner = box({5, 5, 5}, {25, 25, 25});
  const Mesh innermost = box({10, 10, 10}, {20, 20, 20});
  const Mesh beside = moved(inner, {60, 0, -5});
  const double out = 27000;
  const double in = 8000;
  const double most = 1000;
  struct Case {
    Mesh mesh;
    double volume;
  };
  for (const Case& c : {
           Case{inside_out(outer), out},
           Case{together(outer, inside_out(inner)), out - in},
           Case{together(inside_out(outer), inner), out - in},
           Case{together(outer, inner), out + in},
           Case{together(inside_out(outer), inside_out(inner)), out + in},
           Case{together(together(outer, inside_out(inner)), innermost), out - in + most},
           Case{together(together(inside_out(outer), inner), inside_out(innermost)),
                out - in + most},
           Case{together(outer, inside_out(beside)), out + in},
           Case{together(inside_out(outer), beside), out + in},
           Case{together(together(inside_out(outer), inner), beside), out - in + in},
       }) {
    for (const std::uint32_t seed : {1U, 2U}) {
      EXPECT_NEAR(loaded(test::shuffled(c.mesh, seed)).report.volume_mm3, c.volume, 1e-6);
    }
  }
}

TEST(Mending, CavitiesAreFoundWhereVerticesLieOverOneAnother) {
  // The lowest corner of the cavity lies under edges and corners of the shell around it.
  Mesh outer = box({0, 0, 0}, {20, 20, 20});
  const Mesh cavity = box({10, 10, 5}, {15, 15, 15});  // the lid's middle vertex is at 10, 10
  EXPECT_NEAR(loaded(together(outer, inside_out(cavity))).report.volume_mm3, 8000 - 250, 1e-6);
  const Mesh diagonal = box({5, 5, 5}, {8, 8, 8});  // under the lid's diagonal
  EXPECT_NEAR(loaded(together(outer, inside_out(diagonal))).report.volume_mm3, 8000 - 27, 1e-6);
}

TEST(Mending, ManyCavitiesAreFoundInOnePass) {
  Mesh mesh = box({0, 0, 0}, {100, 100, 10});
  std::size_t holes = 0;
  for (double x = 2; x < 98; x += 4) {
    for (double y = 2; y < 98; y += 4, ++holes) {
      test::append(mesh, inside_out(box({x, y, 3}, {x + 2, y + 2, 7})));
    }
  }
  const Model model = loaded(mesh);
  EXPECT_EQ(model.report.components, holes + 1);
  EXPECT_NEAR(model.report.volume_mm3, 100000 - 16 * static_cast<double>(holes), 1e-3);
  EXPECT_TRUE(model.warnings.empty());
}

TEST(Mending, CopiesGoWhereTheSurfaceClosesWithoutThem) {
  const std::uint64_t sound = content_hash(loaded(cube()).mesh);
  const Mesh twice = together(cube(), cube());
  EXPECT_EQ(content_hash(loaded(twice).mesh), sound);
  EXPECT_EQ(loaded(twice).report.duplicate_triangles, cube().triangles.size());
  EXPECT_EQ(content_hash(loaded(together(twice, cube())).mesh), sound);
  // Both sides of every face, as some programs for pictures write them.
  EXPECT_EQ(content_hash(loaded(together(cube(), inside_out(cube()))).mesh), sound);
  // A part of the surface twice.
  Mesh patch = cube();
  patch.triangles.resize(5);
  const Model patched = loaded(together(cube(), patch));
  EXPECT_EQ(content_hash(patched.mesh), sound);
  EXPECT_EQ(patched.report.duplicate_triangles, 5U);
}

TEST(Mending, AWallBetweenTwoRoomsIsKept) {
  const Mesh rooms = together(cube(), box({20, 0, 0}, {40, 20, 20}));
  const Model model = loaded(rooms);
  EXPECT_EQ(model.mesh.triangles.size(), rooms.triangles.size());
  EXPECT_NEAR(model.report.volume_mm3, 16000, 1e-9);
  EXPECT_NEAR(loaded(inside_out(rooms)).report.volume_mm3, 16000, 1e-9);
}

TEST(Mending, ShellsThatTouchAlongAnEdgeAreJudgedAlone) {
  const Mesh other = box({20, 20, 0}, {40, 40, 20});
  EXPECT_NEAR(loaded(together(cube(), inside_out(other))).report.volume_mm3, 16000, 1e-9);
  EXPECT_EQ(loaded(together(cube(), other)).report.components, 1U);
}

TEST(Mending, TrianglesWithoutAreaGoUnlessTheyHoldTheSurfaceTogether) {
  Mesh extra = cube();
  const auto middle = static_cast<std::uint32_t>(extra.vertices.size());
  extra.vertices.push_back({10, 0, 0});
  extra.triangles.push_back({0, middle, 1});
  const Model dropped = loaded(extra);
  EXPECT_EQ(content_hash(dropped.mesh), content_hash(loaded(cube()).mesh));
  EXPECT_EQ(dropped.report.degenerate_triangles, 1U);

  // The front face is split at the middle of its lower edge, the bottom is not: a flat triangle
  // closes the seam.
  Mesh joined = box({0, 0, 0}, {20, 20, 20});
  const auto m = static_cast<std::uint32_t>(joined.vertices.size());
  joined.vertices.push_back({10, 0, 0});
  std::erase(joined.triangles, std::array<std::uint32_t, 3>{0, 1, 6});
  joined.triangles.push_back({0, m, 6});
  joined.triangles.push_back({m, 1, 6});
  joined.triangles.push_back({0, 1, m});
  const Model kept = loaded(joined);
  EXPECT_EQ(kept.mesh.triangles.size(), joined.triangles.size());
  EXPECT_EQ(kept.report.open_edges, 0U);
  EXPECT_EQ(kept.report.degenerate_triangles, 1U);
  EXPECT_NEAR(kept.report.volume_mm3, 8000, 1e-9);
}

TEST(Mending, AFarPointOfADroppedTriangleDoesNotLiftTheModel) {
  Mesh mesh = cube();
  const auto v = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({-50, 0, -50});
  mesh.triangles.push_back({v, v, 0});
  const Model model = loaded(mesh);
  EXPECT_EQ(content_hash(model.mesh), content_hash(loaded(cube()).mesh));
  EXPECT_EQ(model.report.lower_mm, (Point3{0, 0, 0}));
}

TEST(Mending, OpenShellsFaceOutwards) {
  Mesh open = box({0, 0, 0}, {20, 20, 20});
  open.triangles.pop_back();
  const double volume = test::volume_mm3(open);
  EXPECT_GT(volume, 0);
  EXPECT_GT(test::volume_mm3(loaded(open).mesh), 0);
  EXPECT_GT(test::volume_mm3(loaded(inside_out(open)).mesh), 0);
  const Mesh cracked = test::unwelded(moved(torus(20, 5, 40, 20), {30, 30, 1}), 1e-4, 3);
  EXPECT_NEAR(test::volume_mm3(loaded(cracked).mesh), test::volume_mm3(cracked), 1e-1);
  EXPECT_NEAR(test::volume_mm3(loaded(inside_out(cracked)).mesh), test::volume_mm3(cracked), 1e-1);
}

TEST(Mending, WhatEnclosesNothingIsRefused) {
  Mesh sheet{{{0, 0, 0}, {20, 0, 5}, {0, 20, 5}}, {{0, 1, 2}, {0, 2, 1}}};
  const ModelFile file("part.stl", stl_bytes(sheet));
  EXPECT_NE(refusal_of(file.path()).find("encloses no volume"), std::string::npos);
  sheet = {{{0, 0, 0}, {20, 0, 0}, {0, 20, 0}}, {{0, 1, 2}}};
  file.rewrite(stl_bytes(sheet));
  EXPECT_NE(refusal_of(file.path()).find("no extent along z"), std::string::npos);
  sheet = {{{0, 0, 0}, {10, 0, 10}, {20, 0, 20}}, {{0, 1, 2}, {0, 0, 1}}};
  file.rewrite(stl_bytes(sheet));
  EXPECT_NE(refusal_of(file.path()).find("no triangle has an area"), std::string::npos);
  const Model model =
      loaded(together(cube(), {{{30, 0, 0}, {40, 0, 5}, {30, 10, 5}}, {{0, 1, 2}, {0, 2, 1}}}));
  EXPECT_TRUE(mentions(model.warnings, "1 shell of 2 without volume"));
}

TEST(Placing, ModelsStandOnTheBedAndKeepTheirPlaceWithinAMetre) {
  const Model near = loaded(moved(cube(), {-300, 700, -55}));
  EXPECT_EQ(near.report.lower_mm, (Point3{-300, 700, 0}));
  EXPECT_TRUE(near.warnings.empty());
  for (const Point3 far : {Point3{1500, 0, 0}, Point3{0, -2000, 0}, Point3{-1e6, 1e6, 1e6}}) {
    const Model model = loaded(moved(cube(), far));
    EXPECT_EQ(model.report.lower_mm, (Point3{0, 0, 0}));
    EXPECT_EQ(model.report.upper_mm, (Point3{20, 20, 20}));
    EXPECT_TRUE(mentions(model.warnings, "moved to begin at x = y = 0"));
  }
  const ModelFile file("part.stl", stl_bytes(moved(cube(), {1e8, 0, 0})));
  EXPECT_NE(refusal_of(file.path()).find("too far away"), std::string::npos);
}

TEST(Placing, TheSizeIsLimitedAndScalesEverything) {
  const ModelFile file("part.stl", stl_bytes(box({0, 0, 0}, {20000, 10, 10})));
  EXPECT_NE(refusal_of(file.path()).find("?size=200"), std::string::npos);
  const Model scaled = load_model(file.path() + "?size=100");
  EXPECT_DOUBLE_EQ(scaled.report.upper_mm.x, 100);
  EXPECT_DOUBLE_EQ(scaled.report.upper_mm.z, 0.05);
  EXPECT_NEAR(scaled.report.volume_mm3, 100 * 0.05 * 0.05, 1e-9);
  const Model tiny = loaded(box({0, 0, 0}, {0.02, 0.02, 0.02}));
  EXPECT_TRUE(mentions(tiny.warnings, "metres or inches"));
  EXPECT_TRUE(loaded(box({0, 0, 0}, {0.02, 0.02, 0.02}), "?size=20").warnings.empty());
}

}  // namespace
}  // namespace routebench
