/// Real meshes and files with one fault each, if this machine has them.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "model_files.hpp"
#include "models.hpp"

namespace routebench {
namespace {

using test::mentions;
using test::refusal_of;

constexpr ModelOptions kRepair{.repair = true};

/// The lines of a table by column name; cells may be quoted.
std::vector<std::map<std::string, std::string>> read_csv(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> lines;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (const char c : line) {
      if (c == '"') {
        quoted = !quoted;
      } else if (c == ',' && !quoted) {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    lines.push_back(cells);
  }
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::map<std::string, std::string>& row = rows.emplace_back();
    for (std::size_t c = 0; c < lines[0].size(); ++c) row[lines[0][c]] = lines[i].at(c);
  }
  return rows;
}

TEST(SoundModels, AgreeWithTheirManifest) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  std::size_t checked = 0;
  for (const auto& row : read_csv(models / "MANIFEST.csv")) {
    const std::string& file = row.at("file");
    const Model model = load_model((models / file).string());
    const MeshReport& report = model.report;
    const auto count = [&](const char* column) { return std::stoul(row.at(column)); };
    EXPECT_EQ(report.triangles, count("triangles")) << file;
    EXPECT_EQ(report.open_edges, count("open edges")) << file;
    EXPECT_EQ(report.non_manifold_edges, count("nonmanifold edges")) << file;
    EXPECT_EQ(report.flipped_triangles, count("flipped edges")) << file;
    EXPECT_EQ(report.degenerate_triangles, count("degenerate")) << file;
    EXPECT_EQ(report.duplicate_triangles, count("duplicate")) << file;
    EXPECT_EQ(report.components, count("shells")) << file;
    const double volume = std::stod(row.at("volume mm3"));
    EXPECT_NEAR(report.volume_mm3, volume, 1e-5 * volume) << file;
    EXPECT_EQ(report.lower_mm.z, 0) << file;
    ++checked;
  }
  EXPECT_EQ(checked, 37U);
}

/// What a file must become: a refusal with a text, or a model with properties.
struct Expectation {
  const char* refusal = nullptr;                      ///< without repair
  std::vector<const char*> warnings{};                ///< some line contains each
  std::function<void(const Model&)> check = nullptr;  ///< with repair, where it is refused
  bool refused_even_with_repair = false;
};

void is_cube_of_20(const Model& m) {
  EXPECT_EQ(content_hash(m.mesh), content_hash(load_model("shape:box").mesh));
  EXPECT_NEAR(m.report.volume_mm3, 8000, 1e-9);
}

std::function<void(const Model&)> has_triangles(std::size_t count) {
  return [count](const Model& m) { EXPECT_EQ(m.mesh.triangles.size(), count); };
}

std::function<void(const Model&)> has_volume(double mm3) {
  return [mm3](const Model& m) { EXPECT_NEAR(m.report.volume_mm3, mm3, 1e-4 * mm3); };
}

/// A cylinder of 96 triangles round and as many flat, 20 mm wide and high.
constexpr double kCylinderVolume = 6265.257;

std::map<std::string, Expectation> expectations() {
  const auto cylinder = has_volume(kCylinderVolume);
  return {
      {"empty_file.stl", {"empty file", {}, nullptr, true}},
      {"header_only.stl", {"without any facet", {}, nullptr, true}},
      {"count_zero.stl", {nullptr, {"says 0 facets"}, is_cube_of_20}},
      {"count_huge.stl", {nullptr, {"says 4294967295 facets"}, is_cube_of_20}},
      {"truncated.stl", {"inside facet 101 of 192", {"100 whole facets"}, has_triangles(100)}},
      {"trailing_bytes.stl", {nullptr, {"37 bytes after"}, is_cube_of_20}},
      {"solid_in_binary_header.stl", {nullptr, {}, is_cube_of_20}},
      {"attributes_and_zero_normals.stl", {nullptr, {}, is_cube_of_20}},
      {"wrong_normals.stl", {nullptr, {}, is_cube_of_20}},
      {"not_a_mesh.stl", {"not a mesh", {}, nullptr, true}},
      {"ascii_upper_crlf_tabs.stl", {nullptr, {}, is_cube_of_20}},
      {"ascii_bare_cr.stl", {nullptr, {}, is_cube_of_20}},
      {"ascii_bom_utf8_name.stl", {nullptr, {}, is_cube_of_20}},
      {"ascii_extra_words.stl", {nullptr, {}, is_cube_of_20}},
      {"ascii_decimal_comma.stl", {"facet 1 (line 4): '0,000000'", {}, nullptr, true}},
      {"ascii_truncated.stl", {"inside facet 6", {"5 whole facets"}, has_triangles(5)}},
      {"ascii_two_solids.stl",
       {nullptr,
        {},
        [](const Model& m) {
          EXPECT_EQ(m.report.triangles, 204U);
          EXPECT_EQ(m.report.components, 2U);
        }}},
      {"nan_vertex.stl", {"facet 3 (byte 184)", {"5 facets left out"}, has_triangles(7)}},
      {"infinite_vertex.stl", {"is infinite", {"1 facet left out"}, has_triangles(11)}},
      {"huge_coordinates.stl", {"too large", {}, nullptr, true}},
      {"far_away.stl", {nullptr, {"good to 0.0625 mm"}, is_cube_of_20}},
      {"metres.stl", {nullptr, {"tiny: 0.02 x 0.02 x 0.02 mm"}, has_triangles(12)}},
      {"below_bed.stl", {nullptr, {}, has_volume(8000)}},
      {"inside_out.stl", {nullptr, {"inside out: turned"}, cylinder}},
      {"half_flipped.stl", {nullptr, {"96 triangles flipped"}, cylinder}},
      {"hole_one_facet.stl", {nullptr, {"3 open edges"}, has_triangles(191)}},
      {"open_top.stl", {nullptr, {"4 open edges"}, has_triangles(10)}},
      {"duplicate_facets.stl", {nullptr, {"12 triangles there already"}, is_cube_of_20}},
      {"t_junction.stl", {nullptr, {"3 open edges"}, has_volume(8000)}},
      {"zero_area_facets.stl", {nullptr, {"3 triangles without area"}, cylinder}},
      {"cracks.stl", {nullptr, {"576 open edges"}, cylinder}},
      {"overlapping_cubes.stl", {nullptr, {}, has_volume(16000)}},
      {"nested_same_direction.stl", {nullptr, {}, has_volume(9000)}},
      {"shared_wall.stl", {nullptr, {"4 non-manifold edges"}, has_volume(16000)}},
      {"touching_edge.stl", {nullptr, {"1 non-manifold edge"}, has_volume(16000)}},
      {"flat_sheet.stl", {"nothing to print", {}, nullptr, true}},
      {"faces_on_layer_heights.stl",
       {nullptr, {}, [](const Model& m) { EXPECT_EQ(m.report.components, 10U); }}},
      {"thinner_than_nozzle.stl", {nullptr, {}, has_volume(140)}},
      {"real_50736.stl", {nullptr, {"160 open edges"}, has_triangles(420)}},
      {"real_138201.stl", {nullptr, {"448 triangles there already"}, has_triangles(224)}},
      {"real_73342.stl",
       {nullptr, {"20 triangles without area", "flipped against"}, has_triangles(400)}},
      {"real_49886.stl", {nullptr, {"12 non-manifold edges"}, has_triangles(120)}},
      {"real_42841.stl", {nullptr, {"2 shells of 2 inside out"}, has_triangles(84)}},
      {"real_100036.stl",
       {nullptr, {"open edge", "non-manifold", "flipped", "already", "without area"}, nullptr}},
      {"real_invalid_unicode_header.stl", {nullptr, {}, has_triangles(12)}},
      {"real_open_facade.stl", {nullptr, {"1177 open edges"}, has_triangles(11737)}},
      {"real_self_crossing.stl", {nullptr, {}, has_triangles(260)}},
  };
}

void expect_sane(const Model& model, const std::string& file) {
  EXPECT_FALSE(model.mesh.triangles.empty()) << file;
  EXPECT_GT(model.report.volume_mm3, 0) << file;
  double lowest = 1;
  for (const Point3& p : model.mesh.vertices) {
    EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << file;
    lowest = std::min(lowest, p.z);
  }
  EXPECT_EQ(lowest, 0) << file;
  for (const auto& t : model.mesh.triangles) {
    EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) << file;
    for (const std::uint32_t v : t) EXPECT_LT(v, model.mesh.vertices.size()) << file;
  }
}

TEST(BrokenModels, BecomeWhatASaneReaderMakesOfThem) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  const std::map<std::string, Expectation> expected = expectations();
  std::set<std::string> seen;
  for (const auto& row : read_csv(models / "broken" / "BROKEN.csv")) {
    const std::string& file = row.at("file");
    seen.insert(file);
    const auto found = expected.find(file);
    if (found == expected.end()) {
      ADD_FAILURE() << "nothing is expected of " << file;
      continue;
    }
    SCOPED_TRACE(file);
    const Expectation& want = found->second;
    const std::string path = (models / "broken" / file).string();
    if (want.refusal != nullptr) {
      EXPECT_NE(row.at("expected"), "accept");
      const std::string message = refusal_of(path);
      EXPECT_NE(message.find(want.refusal), std::string::npos) << message;
    } else {
      EXPECT_NE(row.at("expected"), "reject");
    }
    if (want.refused_even_with_repair) {
      EXPECT_NE(refusal_of(path, kRepair), "");
      continue;
    }
    const Model model = load_model(path, {.repair = want.refusal != nullptr});
    expect_sane(model, file);
    for (const char* const warning : want.warnings) {
      EXPECT_TRUE(mentions(model.warnings, warning)) << warning;
    }
    EXPECT_FALSE(row.at("expected") == "warn" && model.warnings.empty());
    if (want.check) want.check(model);
  }
  EXPECT_EQ(seen.size(), expected.size());
}

}  // namespace
}  // namespace routebench
