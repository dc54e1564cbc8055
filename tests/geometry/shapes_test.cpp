#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "model_files.hpp"
#include "routebench/geometry/model.hpp"

namespace routebench {
namespace {

using test::refusal_of;

constexpr double kPi = std::numbers::pi;

/// A shape with the volume that it has in the limit of many triangles.
struct ShapeCase {
  const char* spec;
  double volume_mm3;
  double tolerance;        ///< at the default resolution, relative
  std::size_t fewest = 0;  ///< triangles that the shape cannot do without
};

void PrintTo(const ShapeCase& c, std::ostream* out) { *out << c.spec; }

class Shapes : public testing::TestWithParam<ShapeCase> {
 protected:
  [[nodiscard]] static std::string with(const std::string& parameter) {
    const std::string spec = GetParam().spec;
    return spec + (spec.find('?') == std::string::npos ? '?' : '&') + parameter;
  }
};

TEST_P(Shapes, AreClosedManifoldAndOriented) {
  for (const std::string& spec : {std::string(GetParam().spec), with("triangles=9000")}) {
    const Model model = load_model(spec);
    EXPECT_EQ(model.report.open_edges, 0U) << spec;
    EXPECT_EQ(model.report.non_manifold_edges, 0U) << spec;
    EXPECT_EQ(model.report.flipped_triangles, 0U) << spec;
    EXPECT_EQ(model.report.degenerate_triangles, 0U) << spec;
    EXPECT_EQ(model.report.duplicate_triangles, 0U) << spec;
    EXPECT_EQ(model.mesh.triangles.size(), model.report.triangles) << spec;
    EXPECT_TRUE(model.warnings.empty()) << spec << ": " << model.warnings.front();
    EXPECT_NEAR(model.report.lower_mm.x, 0, 0.1) << spec;
    EXPECT_NEAR(model.report.lower_mm.y, 0, 0.1) << spec;
    EXPECT_EQ(model.report.lower_mm.z, 0) << spec;
  }
}

TEST_P(Shapes, HaveTheirVolumeAndComeNearerWithMoreTriangles) {
  const ShapeCase& shape = GetParam();
  const double coarse = load_model(shape.spec).report.volume_mm3;
  EXPECT_NEAR(coarse, shape.volume_mm3, shape.tolerance * shape.volume_mm3);
  if (shape.fewest > 0) return;
  const double fine = load_model(with("triangles=16000")).report.volume_mm3;
  EXPECT_LE(std::abs(fine - shape.volume_mm3), std::abs(coarse - shape.volume_mm3) +
                                                   1e-3 * shape.tolerance * shape.volume_mm3 +
                                                   1e-9 * shape.volume_mm3);
}

TEST_P(Shapes, HaveAboutAsManyTrianglesAsAskedFor) {
  std::size_t last = 0;
  for (const std::size_t wanted : {2000U, 6000U, 18000U}) {
    if (wanted < GetParam().fewest) continue;
    const std::size_t made =
        load_model(with("triangles=" + std::to_string(wanted))).report.triangles;
    EXPECT_GT(made, last);
    EXPECT_GT(made, wanted / 2) << wanted;
    EXPECT_LT(made, wanted * 2) << wanted;
    last = made;
  }
}

TEST_P(Shapes, AreTheSameEveryTime) {
  const Model a = load_model(GetParam().spec);
  const Model b = load_model(GetParam().spec);
  EXPECT_TRUE(a.mesh.vertices == b.mesh.vertices);
  EXPECT_TRUE(a.mesh.triangles == b.mesh.triangles);
}

TEST_P(Shapes, RefuseParametersThatTheyDoNotKnow) {
  const std::string message = refusal_of(with("trianglse=100"));
  EXPECT_NE(message.find("did you mean 'triangles'?"), std::string::npos) << message;
  EXPECT_NE(refusal_of(with("triangles=many")).find("whole number"), std::string::npos);
  EXPECT_NE(refusal_of(with("triangles=-5")).find("whole number"), std::string::npos);
}

/// The pitch circle halves a gear's teeth.
constexpr double kGearVolume = kPi * (18 * 18 - 4 * 4) * 8;
/// A minimal surface of 3.0915 cell^2 in a cell of side 15, with walls of 1.6 mm.
constexpr double kGyroidVolume = 3.0915 / 15 * 1.6 * 15 * 15 * 15;

INSTANTIATE_TEST_SUITE_P(
    All, Shapes,
    testing::Values(
        ShapeCase{"shape:box", 8000, 1e-12}, ShapeCase{"shape:box?x=7&y=11&z=0.5", 38.5, 1e-12},
        ShapeCase{"shape:cylinder", 2000 * kPi, 0.05},
        ShapeCase{"shape:cylinder?diameter=5&height=40", 250 * kPi, 0.05},
        ShapeCase{"shape:sphere", 4000 * kPi / 3, 0.01},
        ShapeCase{"shape:torus", 2 * kPi* kPi * 10 * 25, 0.02},
        ShapeCase{"shape:torus?diameter=60&tube=4", 2 * kPi* kPi * 28 * 4, 0.06},
        // Nozzle of 6 mm with a counterbore of 9 mm, cartridge of 6 mm, two holes of 3 mm.
        ShapeCase{"shape:hotend",
                  23 * 16 * 12 - kPi*(9 * 9.6 + 20.25 * 2.4 + 9 * 12 + 2 * 2.25 * 12), 0.01},
        // Plate with rounded corners and four holes, boss with its bore, cheeks.
        ShapeCase{"shape:bracket",
                  4 * (60 * 40 - (4 - kPi) * 25 - 4 * kPi * 4 - kPi * 3.6 * 3.6) +
                      kPi*(7.2 * 7.2 - 3.6 * 3.6) * 26 / 3 + 2 * 4 * 32 * 26,
                  0.01},
        ShapeCase{"shape:gear", kGearVolume, 0.03},
        ShapeCase{"shape:gear?twist_deg=30", kGearVolume, 0.05},
        ShapeCase{"shape:comb?x=62&teeth=16", (62 * 6 + 16 * 2 * 24) * 5, 1e-9},
        ShapeCase{"shape:comb?x=30&y=20&z=1&back=5&teeth=2", (30 * 5 + 2 * 10 * 15) * 1, 1e-9},
        ShapeCase{"shape:grate?holes=3", (18 * 18 - 9 * 4 * kPi) * 3, 0.03},
        // Two slots of 1 mm, whose pointed ends add up to half a square each.
        ShapeCase{"shape:text?text=-", 2 * (22 * 32 - 2 * (5 - 3.2 + 0.5)), 1e-9},
        ShapeCase{"shape:gyroid?x=15&y=15&z=15", kGyroidVolume, 0.1, 18'001}));

TEST(ShapeNames, UnknownOnesAreRefusedWithTheNearest) {
  EXPECT_NE(refusal_of("shape:shpere").find("did you mean 'sphere'?"), std::string::npos);
  EXPECT_NE(refusal_of("shape:qqqqqqqq").find("known: box"), std::string::npos);
  EXPECT_NE(refusal_of("shape:").find("no model is named"), std::string::npos);
}

TEST(ShapeNames, SizeScalesTheLargestSide) {
  const Model model = load_model("shape:box?x=10&y=20&z=5&size=60");
  EXPECT_DOUBLE_EQ(model.report.upper_mm.x, 30);
  EXPECT_DOUBLE_EQ(model.report.upper_mm.y, 60);
  EXPECT_DOUBLE_EQ(model.report.upper_mm.z, 15);
  EXPECT_NEAR(model.report.volume_mm3, 27000, 1e-6);
}

TEST(ShapeNames, EveryShapeOfARandomKindIsSoundForEverySeed) {
  for (const char* const spec :
       {"shape:islands?count=30", "shape:islands?count=12&plate=2&height=4",
        "shape:voronoi?x=14&y=14&z=14&strut=2", "shape:voronoi?x=20&y=12&z=9&cell=9&strut=2"}) {
    std::uint64_t last_hash = 0;
    for (const int seed : {0, 77}) {
      const std::string seeded = std::string(spec) + "&seed=" + std::to_string(seed);
      const Model model = load_model(seeded);
      EXPECT_EQ(model.report.open_edges, 0U) << seeded;
      EXPECT_EQ(model.report.non_manifold_edges, 0U) << seeded;
      EXPECT_EQ(model.report.flipped_triangles, 0U) << seeded;
      EXPECT_GT(model.report.volume_mm3, 0) << seeded;
      EXPECT_TRUE(model.warnings.empty()) << seeded << ": " << model.warnings.front();
      EXPECT_NE(content_hash(model.mesh), last_hash) << seeded;
      EXPECT_EQ(content_hash(model.mesh), content_hash(load_model(seeded).mesh)) << seeded;
      last_hash = content_hash(model.mesh);
    }
  }
  EXPECT_EQ(load_model("shape:islands?count=30").report.components, 30U);
  EXPECT_EQ(load_model("shape:islands?count=30&plate=1").report.components, 1U);
}

TEST(ShapeNames, EveryLetterIsCutWithoutTouchingItsNeighbour) {
  const Model model = load_model("shape:text?text=ABCDEFGHIJKLMNOPQRSTUVWXYZ-0123456789 z");
  EXPECT_EQ(model.report.open_edges, 0U);
  EXPECT_EQ(model.report.non_manifold_edges, 0U);
  EXPECT_EQ(model.report.components, 1U);
  EXPECT_NE(refusal_of("shape:text?text=a+b").find("letters A-Z"), std::string::npos);
}

TEST(ShapeNames, ThroughHolesMakeHandles) {
  // Euler's formula: V - E + F = 2 - 2 holes, with 3 F = 2 E.
  const auto holes = [](const char* spec) {
    const Model model = load_model(spec);
    const auto vertices = static_cast<long>(model.mesh.vertices.size());
    const auto faces = static_cast<long>(model.mesh.triangles.size());
    return (2 - (vertices - faces / 2)) / 2;
  };
  EXPECT_EQ(holes("shape:box"), 0);
  EXPECT_EQ(holes("shape:torus"), 1);
  EXPECT_EQ(holes("shape:gear"), 1);
  EXPECT_EQ(holes("shape:hotend"), 4);
  EXPECT_EQ(holes("shape:bracket"), 5);
  EXPECT_EQ(holes("shape:grate?holes=4"), 16);
}

TEST(ShapeNames, WhatCannotBeBuiltIsRefused) {
  for (const char* const spec :
       {"shape:hotend?nozzle=20", "shape:bracket?plate=40", "shape:bracket?hole=20",
        "shape:gear?bore=40", "shape:comb?back=40", "shape:grate?diameter=6",
        "shape:islands?plate=20", "shape:gyroid?wall=5", "shape:gyroid?x=1000&y=1000&z=1000",
        "shape:voronoi?strut=9", "shape:torus?tube=20", "shape:box?x=0", "shape:box?x=-1",
        "shape:box?x=nan", "shape:box?x=1e9", "shape:gear?teeth=2.5", "shape:gear?teeth=0",
        "shape:sphere?triangles=1000000000"}) {
    EXPECT_NE(refusal_of(spec), "") << spec;
  }
}

}  // namespace
}  // namespace routebench
