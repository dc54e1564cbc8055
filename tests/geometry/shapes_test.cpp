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
  double tolerance;  ///< at the default resolution, relative
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
  for (const std::string& spec : {std::string(GetParam().spec), with("triangles=30000")}) {
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
  const double fine = load_model(with("triangles=60000")).report.volume_mm3;
  EXPECT_LE(std::abs(fine - shape.volume_mm3),
            std::abs(coarse - shape.volume_mm3) + 1e-9 * shape.volume_mm3);
}

TEST_P(Shapes, HaveAboutAsManyTrianglesAsAskedFor) {
  std::size_t last = 0;
  for (const std::size_t wanted : {2000U, 20000U, 200000U}) {
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

INSTANTIATE_TEST_SUITE_P(
    All, Shapes,
    testing::Values(ShapeCase{"shape:box", 8000, 1e-12},
                    ShapeCase{"shape:box?x=7&y=11&z=0.5", 38.5, 1e-12},
                    ShapeCase{"shape:cylinder", 2000 * kPi, 0.05},
                    ShapeCase{"shape:cylinder?diameter=5&height=40", 250 * kPi, 0.05},
                    ShapeCase{"shape:sphere", 4000 * kPi / 3, 0.01},
                    ShapeCase{"shape:torus", 2 * kPi* kPi * 10 * 25, 0.02},
                    ShapeCase{"shape:torus?diameter=60&tube=4", 2 * kPi* kPi * 28 * 4, 0.06}));

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

}  // namespace
}  // namespace routebench
