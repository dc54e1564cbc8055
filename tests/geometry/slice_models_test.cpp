// Real meshes, sound and broken, from file to layers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
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

constexpr const char* kSoundGroups[] = {"calibration", "functional", "organic", "thin", "islands"};

struct Sliced {
  Model model;
  Slices slices;
};

Sliced load_and_slice(const std::filesystem::path& file, double layer_height_mm, bool repair) {
  Sliced result;
  ModelOptions model_options;
  model_options.repair = repair;
  result.model = load_model(file.string(), model_options);
  SliceOptions options;
  options.layer_height_mm = layer_height_mm;
  options.repair = repair;
  result.slices = slice_mesh(result.model.mesh, options, file.string());
  return result;
}

/// A layer height that puts a plane exactly through a vertex half-way up, with at least `planes`
/// planes below it.
double height_through_a_vertex(const Mesh& mesh, int planes) {
  std::vector<double> heights;
  for (const Point3& p : mesh.vertices)
    if (p.z > 0) heights.push_back(p.z);
  std::nth_element(heights.begin(),
                   heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2),
                   heights.end());
  const double z_mm = heights[heights.size() / 2];
  for (int k = planes;; ++k) {
    const double height_mm = z_mm / (k + 0.5);
    if ((k + 0.5) * height_mm == z_mm) return height_mm;
  }
}

class SoundModel : public testing::TestWithParam<const char*> {};

/// A file's name as the name of a test.
std::string test_name(std::string file) {
  file.erase(std::min(file.find('.'), file.size()));
  for (char& c : file)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return file;
}

/// Every sound model of a group: areas are those of the triangle cuts.
TEST_P(SoundModel, HasTheAreaOfItsTriangleCutsInEveryLayer) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  for (const auto& entry : std::filesystem::directory_iterator(models / GetParam())) {
    if (entry.path().extension() != ".stl") continue;
    const Mesh mesh = load_model(entry.path().string()).mesh;
    double top_mm = 0;
    for (const Point3& p : mesh.vertices) top_mm = std::max(top_mm, p.z);
    for (const double height_mm : {top_mm / 13.3, height_through_a_vertex(mesh, 4)}) {
      SliceOptions options;
      options.layer_height_mm = height_mm;
      const Slices slices = slice_mesh(mesh, options, entry.path().string());
      EXPECT_EQ(slices.report.repaired_layers, 0u);
      for (const Layer& layer : slices.layers) {
        // Bodies of one model overlap nowhere here, so winding numbers are 0 or 1.
        const double expected = test::cut_area_mm2(mesh, layer.z_mm);
        EXPECT_NEAR(area_mm2(layer.polygons), expected, 1e-6 * expected + 1e-5)
            << entry.path() << " layer " << layer.index << " of " << height_mm << " mm";
      }
    }
  }
}

TEST_P(SoundModel, OrderAndMethodDoNotMatter) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  for (const auto& entry : std::filesystem::directory_iterator(models / GetParam())) {
    if (entry.path().extension() != ".stl" || entry.file_size() > 2'000'000) continue;
    const Mesh mesh = load_model(entry.path().string()).mesh;
    SliceOptions options;
    options.layer_height_mm = height_through_a_vertex(mesh, 3);
    const std::vector<Layer> expected = slice_mesh(mesh, options, "").layers;
    EXPECT_EQ(slice_mesh(test::shuffled(mesh, 1), options, "").layers, expected) << entry.path();
    for (const SliceMethod method : {SliceMethod::kSweep, SliceMethod::kNaive}) {
      options.method = method;
      EXPECT_EQ(slice_mesh(mesh, options, "").layers, expected) << entry.path();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Groups, SoundModel, testing::ValuesIn(kSoundGroups),
                         [](const auto& group) { return test_name(group.param); });

/// What becomes of a broken file at layers of 0.2 mm.
struct BrokenFile {
  const char* file;
  const char* refusal;         ///< part of the message without repair; nullptr: it slices
  const char* repair_refusal;  ///< the same with repair
  std::size_t layers = 0;
  double least_mm2 = 0;  ///< area of any layer
  double most_mm2 = 0;
  std::size_t fewest = 1;  ///< polygons of any layer
  std::size_t most = 1;
};

constexpr double kCylinderMm2 = 313.263;  // 64-gon of 10 mm radius
constexpr const char* kSlices = nullptr;

/// A 20 mm cube, as it should be.
constexpr BrokenFile cube(const char* file) { return {file, kSlices, kSlices, 100, 400, 400}; }
constexpr BrokenFile cylinder(const char* file) {
  return {file, kSlices, kSlices, 100, kCylinderMm2, kCylinderMm2};
}
constexpr BrokenFile refused(const char* file, const char* refusal) {
  return {file, refusal, refusal};
}

const BrokenFile kBrokenFiles[] = {
    refused("empty_file.stl", "empty"),
    refused("header_only.stl", "facet"),
    cube("count_zero.stl"),
    cube("count_huge.stl"),
    // Half a cylinder, closed by its chord.
    {"truncated.stl", "--repair", kSlices, 100, 160, 180},
    cube("trailing_bytes.stl"),
    cube("solid_in_binary_header.stl"),
    cube("attributes_and_zero_normals.stl"),
    cube("wrong_normals.stl"),
    refused("not_a_mesh.stl", "not a mesh"),
    cube("ascii_upper_crlf_tabs.stl"),
    cube("ascii_bare_cr.stl"),
    cube("ascii_bom_utf8_name.stl"),
    cube("ascii_extra_words.stl"),
    refused("ascii_decimal_comma.stl", "comma"),
    {"ascii_truncated.stl", "--repair", "nothing to print"},
    {"ascii_two_solids.stl", kSlices, kSlices, 100, 400 + kCylinderMm2, 400 + kCylinderMm2, 2, 2},
    // The cube less a corner: empty near the top, where next to nothing of its walls is left.
    {"nan_vertex.stl", "--repair", kSlices, 100, 0, 400, 0, 1},
    {"infinite_vertex.stl", "--repair", kSlices, 100, 400, 400},
    refused("huge_coordinates.stl", "too large"),
    cube("far_away.stl"),
    refused("metres.stl", "0.02 mm high"),
    cube("below_bed.stl"),
    cylinder("inside_out.stl"),
    cylinder("half_flipped.stl"),
    {"hole_one_facet.stl", "open by", kSlices, 100, kCylinderMm2, kCylinderMm2},
    cube("open_top.stl"),
    cube("duplicate_facets.stl"),
    cube("t_junction.stl"),
    cylinder("zero_area_facets.stl"),
    cylinder("cracks.stl"),
    {"overlapping_cubes.stl", kSlices, kSlices, 125, 400, 696},
    cube("nested_same_direction.stl"),
    {"shared_wall.stl", kSlices, kSlices, 100, 800, 800},
    {"touching_edge.stl", kSlices, kSlices, 100, 800, 800, 1, 2},
    refused("flat_sheet.stl", "nothing to print"),
    {"faces_on_layer_heights.stl", kSlices, kSlices, 50, 4, 400},
    {"thinner_than_nozzle.stl", kSlices, kSlices, 50, 14, 14, 2, 2},
    {"real_50736.stl", kSlices, kSlices, 115, 8.943, 343.42, 1, 4},
    {"real_138201.stl", kSlices, kSlices, 13, 1367.8, 1414, 1, 8},
    {"real_73342.stl", kSlices, kSlices, 109, 0.0404, 1709.8, 1, 2},
    {"real_49886.stl", kSlices, kSlices, 324, 293.8, 2373.9, 1, 2},
    {"real_42841.stl", kSlices, kSlices, 37, 2143.5, 2451.7, 2, 2},
    {"real_100036.stl", kSlices, kSlices, 99, 1.154, 816.6, 1, 2},
    {"real_invalid_unicode_header.stl", kSlices, kSlices, 10, 4, 4},
    {"real_open_facade.stl", "a contour is open by", kSlices, 1000, 3000, 7000},
    {"real_self_crossing.stl", kSlices, kSlices, 32, 1741.3, 1926.4, 1, 2},
};

class BrokenModel : public testing::TestWithParam<BrokenFile> {
 protected:
  static void expect_refusal(const std::filesystem::path& file, bool repair,
                             const std::string& part) {
    try {
      static_cast<void>(load_and_slice(file, 0.2, repair));
      FAIL() << "was not refused";
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_NE(message.find(file.filename().string()), std::string::npos) << message;
      EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }

  static void expect_layers(const std::filesystem::path& file, bool repair,
                            const BrokenFile& expected) {
    const std::vector<Layer> layers = load_and_slice(file, 0.2, repair).slices.layers;
    ASSERT_EQ(layers.size(), expected.layers);
    for (const Layer& layer : layers) {
      const double area = area_mm2(layer.polygons);
      EXPECT_GE(area, expected.least_mm2 - 0.01) << layer.index;
      EXPECT_LE(area, expected.most_mm2 + 0.01) << layer.index;
      EXPECT_GE(layer.polygons.size(), expected.fewest) << layer.index;
      EXPECT_LE(layer.polygons.size(), expected.most) << layer.index;
    }
  }
};

TEST_P(BrokenModel, IsSlicedOrRefusedByName) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  const std::filesystem::path file = models / "broken" / GetParam().file;
  if (GetParam().refusal != kSlices)
    expect_refusal(file, false, GetParam().refusal);
  else
    expect_layers(file, false, GetParam());
}

TEST_P(BrokenModel, IsSlicedWithRepair) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  const std::filesystem::path file = models / "broken" / GetParam().file;
  if (GetParam().repair_refusal != kSlices)
    expect_refusal(file, true, GetParam().repair_refusal);
  else
    expect_layers(file, true, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Files, BrokenModel, testing::ValuesIn(kBrokenFiles),
                         [](const auto& row) { return test_name(row.param.file); });

TEST(BrokenModels, AllOfThemAreTested) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  std::set<std::string> tested, present;
  for (const BrokenFile& broken : kBrokenFiles) tested.insert(broken.file);
  for (const auto& entry : std::filesystem::directory_iterator(models / "broken"))
    if (entry.path().extension() == ".stl") present.insert(entry.path().filename().string());
  EXPECT_EQ(tested, present);
}

TEST(BrokenModels, LayersAreThoseOfTheSoundSolid) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  const auto layers_of = [&](const char* file) {
    return load_and_slice(models / "broken" / file, 0.2, false).slices.layers;
  };
  EXPECT_EQ(layers_of("half_flipped.stl"), layers_of("inside_out.stl"));
  EXPECT_EQ(layers_of("zero_area_facets.stl"), layers_of("inside_out.stl"));
  EXPECT_EQ(layers_of("duplicate_facets.stl"), layers_of("open_top.stl"));
}

TEST(BrokenModels, ModelsWhoseShellsDoNotOverlapHaveTheAreaOfTheirCuts) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  for (const char* file :
       {"real_50736.stl", "real_138201.stl", "real_73342.stl", "real_49886.stl", "real_42841.stl",
        "real_100036.stl", "real_self_crossing.stl", "faces_on_layer_heights.stl"}) {
    const Sliced sliced = load_and_slice(models / "broken" / file, 0.2, false);
    for (const Layer& layer : sliced.slices.layers) {
      const double expected = test::cut_area_mm2(sliced.model.mesh, layer.z_mm);
      EXPECT_NEAR(area_mm2(layer.polygons), expected, 1e-5 * expected) << file << layer.index;
    }
  }
}

TEST(BrokenModels, StepsOnLayerHeightsAreCutInTheMiddleOfTheirSlabs) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  const Sliced sliced =
      load_and_slice(models / "broken" / "faces_on_layer_heights.stl", 0.2, false);
  double sum_mm3 = 0;
  for (const Layer& layer : sliced.slices.layers) {
    EXPECT_EQ(layer.polygons.size(), 1u);
    EXPECT_TRUE(layer.polygons[0].holes.empty());
    sum_mm3 += area_mm2(layer.polygons) * layer.height_mm;
  }
  EXPECT_NEAR(sum_mm3, sliced.model.report.volume_mm3, 1e-6);
}

}  // namespace
}  // namespace routebench
