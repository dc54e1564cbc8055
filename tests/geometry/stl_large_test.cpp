/// STL files that are read in several parts, and the numbers in them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "meshes.hpp"
#include "model/quick_float.hpp"
#include "model_files.hpp"
#include "routebench/geometry/stl.hpp"

namespace routebench {
namespace {

using test::ascii_stl;
using test::ModelFile;
using test::refusal_of;

/// The last items first, four at a time.
void backwards_on_threads(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::vector<std::exception_ptr> failures(count);
  for (std::size_t end = count; end > 0;) {
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < 4 && end > 0; ++k)
      threads.emplace_back([&, i = --end] {
        try {
          body(i);
        } catch (...) {
          failures[i] = std::current_exception();
        }
      });
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

/// More facets than are read at a time, in both kinds of file.
const Mesh& large_mesh() {
  static const Mesh mesh = load_model("shape:torus?triangles=150000&size=77").mesh;
  return mesh;
}

TEST(LargeStl, LargeFilesAreReadTheSameWhateverTheLoop) {
  for (const std::string& bytes : {stl_bytes(large_mesh()), ascii_stl(large_mesh())}) {
    const ModelFile file("part.stl", bytes);
    const Model serial = load_model(file.path());
    const Model parallel = load_model(file.path(), {}, backwards_on_threads);
    EXPECT_TRUE(parallel.mesh.vertices == serial.mesh.vertices);
    EXPECT_TRUE(parallel.mesh.triangles == serial.mesh.triangles);
    EXPECT_EQ(content_hash(parallel.mesh), content_hash(serial.mesh));
    EXPECT_EQ(parallel.report.volume_mm3, serial.report.volume_mm3);
    EXPECT_EQ(parallel.warnings, serial.warnings);
  }
}

TEST(LargeStl, VerticesAreNumberedInOrderOfAppearanceAndEveryCornerIsThatOfTheFile) {
  const std::string bytes = stl_bytes(large_mesh());
  const ModelFile file("part.stl", bytes);
  const Model model = load_model(file.path(), {}, backwards_on_threads);
  ASSERT_EQ(model.mesh.triangles.size(), large_mesh().triangles.size());
  EXPECT_EQ(model.mesh.vertices.size(), large_mesh().vertices.size());
  float lowest_z = std::numeric_limits<float>::infinity();
  std::vector<std::array<std::array<float, 3>, 3>> facets(model.mesh.triangles.size());
  for (std::size_t t = 0; t < facets.size(); ++t) {
    std::memcpy(&facets[t], bytes.data() + 84 + 50 * t + 12, sizeof facets[t]);
    for (const auto& corner : facets[t]) lowest_z = std::min(lowest_z, corner[2]);
  }
  std::size_t known = 0;
  for (std::size_t t = 0; t < facets.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = model.mesh.triangles[t][i];
      ASSERT_LE(vertex, known);
      if (vertex == known) ++known;
      const auto& [x, y, z] = facets[t][i];
      const Point3 expected{double{x}, double{y}, double{z} - double{lowest_z}};
      ASSERT_EQ(model.mesh.vertices[vertex], expected);
    }
  }
  EXPECT_EQ(known, model.mesh.vertices.size());
}

TEST(LargeStl, FacetsLeftOutInAnyPartLeaveWhatAFileWithoutThemWouldGive) {
  Mesh rest = large_mesh();
  const std::string bytes = stl_bytes(rest);
  std::string damaged = bytes;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::size_t left_out = 0;
  for (std::size_t t = 7; t < rest.triangles.size(); t += 997, ++left_out)
    std::memcpy(damaged.data() + 84 + 50 * t + 12, &kNan, sizeof kNan);
  std::size_t number = 0;
  std::erase_if(rest.triangles, [&](const auto&) { return number++ % 997 == 7; });
  ASSERT_EQ(rest.triangles.size() + left_out, large_mesh().triangles.size());
  const ModelFile damaged_file("part.stl", damaged);
  const ModelFile rest_file("rest.stl", stl_bytes(rest));
  const Model repaired = load_model(damaged_file.path(), {.repair = true}, backwards_on_threads);
  const Model expected = load_model(rest_file.path(), {.repair = true}, backwards_on_threads);
  EXPECT_TRUE(repaired.mesh.vertices == expected.mesh.vertices);
  EXPECT_TRUE(repaired.mesh.triangles == expected.mesh.triangles);
  ASSERT_EQ(repaired.warnings.size(), expected.warnings.size() + 1);
  EXPECT_TRUE(repaired.warnings[0].starts_with(std::to_string(left_out) + " facets left out"));
}

TEST(LargeStl, TheOrderOfFacetsChangesNothingButNumbers) {
  Mesh mesh = large_mesh();
  mesh.triangles.erase(mesh.triangles.begin() + 100'000);
  test::append(mesh, test::moved(large_mesh(), {100, 0, 0}));
  const ModelFile in_order("in_order.stl", stl_bytes(mesh));
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937_64(1));
  const ModelFile shuffled("shuffled.stl", stl_bytes(mesh));
  const Model expected = load_model(in_order.path(), {}, backwards_on_threads);
  const Model model = load_model(shuffled.path(), {}, backwards_on_threads);
  EXPECT_EQ(model.report.components, 2U);
  EXPECT_EQ(model.report.open_edges, 3U);
  EXPECT_EQ(model.report.non_manifold_edges, 0U);
  EXPECT_EQ(model.report.vertices, expected.report.vertices);
  EXPECT_EQ(content_hash(model.mesh), content_hash(expected.mesh));
  EXPECT_EQ(model.warnings, expected.warnings);
}

TEST(LargeStl, CopiesAreFoundHoweverFarTheyAreApart) {
  Mesh mesh = large_mesh();
  const std::size_t facets = mesh.triangles.size(), corners = mesh.vertices.size();
  std::vector<std::array<std::uint32_t, 3>> again = mesh.triangles;
  std::shuffle(again.begin(), again.end(), std::mt19937_64(7));
  mesh.triangles.insert(mesh.triangles.end(), again.begin(), again.end());
  const ModelFile file("twice.stl", stl_bytes(mesh));
  const Model model = load_model(file.path(), {}, backwards_on_threads);
  EXPECT_EQ(model.report.triangles, 2 * facets);
  EXPECT_EQ(model.report.vertices, corners);
  EXPECT_EQ(model.report.duplicate_triangles, facets);
  EXPECT_EQ(model.mesh.triangles.size(), facets);
}

TEST(LargeStl, FaultsFarInsideALargeBinaryFileAreNamedWithFacetAndByte) {
  const std::string plain = stl_bytes(large_mesh());
  // One stands at the beginning of what is looked at together, the others inside and at its end.
  for (const std::size_t facet : {100'001U, 120'000U, 149'999U}) {
    std::string bytes = plain;
    const std::size_t offset = 84 + 50 * (facet - 1);
    const float infinite = -std::numeric_limits<float>::infinity();
    std::memcpy(bytes.data() + offset + 12 + 4 * 7, &infinite, sizeof infinite);
    const ModelFile file("part.stl", bytes);
    const std::string said = refusal_of(file.path());
    const std::string place = "facet " + std::to_string(facet) + " (byte " + std::to_string(offset);
    EXPECT_NE(said.find(place + "): the y of corner 3 is infinite"), std::string::npos) << said;
  }
}

TEST(LargeStl, FaultsFarInsideALargeAsciiFileAreNamedWithFacetAndLine) {
  const std::string plain = ascii_stl(large_mesh());
  ASSERT_GT(plain.size(), 20U << 20U);
  // A facet has seven lines, and a line stands before the first.
  const std::size_t facet = 120'000;
  const std::size_t lines_before = 1 + 7 * (facet - 1);
  std::size_t start = 0;
  for (std::size_t line = 0; line < lines_before; ++line) start = plain.find('\n', start) + 1;
  const ModelFile file("part.stl", "");
  const auto refusal = [&](const char* line, std::string_view instead) {
    std::string text = plain;
    const std::size_t at = text.find(line, start);
    text.replace(at, text.find('\n', at) - at, instead);
    file.rewrite(text);
    std::string serial = refusal_of(file.path());
    try {
      static_cast<void>(load_model(file.path(), {}, backwards_on_threads));
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(serial, error.what());
    }
    return serial;
  };
  const std::string place = "facet 120000 (line " + std::to_string(lines_before + 1) + ")";
  EXPECT_NE(refusal("endfacet", "").find(place + " has no endfacet"), std::string::npos);
  EXPECT_NE(refusal("vertex", "").find(place + " has 2 corners"), std::string::npos);
  EXPECT_NE(refusal("vertex", "vertex 1e99 0 0").find(place + ": the x of corner 1 is infinite"),
            std::string::npos);
  EXPECT_NE(refusal("vertex", "vertex 1 y 2")
                .find("facet 120000 (line " + std::to_string(lines_before + 3) + "): 'y'"),
            std::string::npos);
}

TEST(LargeStl, LargeAsciiFilesMayNameTheirSolidsAfterKeywords) {
  const Mesh& mesh = large_mesh();
  std::string text = ascii_stl(mesh);
  // Names and remarks all over the file, where a section may begin.
  for (std::size_t at = 0; (at = text.find("endfacet\n", at + 100'000)) != std::string::npos;)
    text.insert(at + 9, "endsolid facet normal\nsolid facet normal x\n ; facet\n");
  const ModelFile file("part.stl", text);
  const Model model = load_model(file.path(), {}, backwards_on_threads);
  EXPECT_EQ(model.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_TRUE(model.warnings.empty());
}

TEST(QuickFloat, DecimalNumbersAreRoundedAsTheStandardLibraryDoes) {
  std::mt19937_64 random(1);
  std::size_t quick = 0;
  const auto check = [&](const std::string& number) {
    float expected = 0;
    const auto [end, error] =
        std::from_chars(number.data(), number.data() + number.size(), expected);
    const std::string text = number + " ";
    float value = 0;
    const char* const after = models::quick_float(text.data(), text.data() + text.size(), value);
    if (after == nullptr) return;
    ++quick;
    ASSERT_EQ(error, std::errc()) << number;
    ASSERT_EQ(end, number.data() + number.size()) << number;
    ASSERT_EQ(after, text.data() + number.size()) << number;
    ASSERT_EQ(std::bit_cast<std::uint32_t>(value), std::bit_cast<std::uint32_t>(expected))
        << number;
  };
  const auto printed = [](const char* format, double value) {
    std::array<char, 512> text;
    const int length = std::snprintf(text.data(), text.size(), format, value);
    return std::string(text.data(), static_cast<std::size_t>(length));
  };
  constexpr std::size_t kNumbers = 200'000;
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const auto bits = static_cast<std::uint32_t>(random());
    const float any = std::bit_cast<float>(bits);
    const float usual = std::bit_cast<float>((bits & 0x81FFFFFFU) | 0x3E000000U);
    for (const char* const format : {"%.9g", "%.6e", "%f", "%.17g", "%.3f"}) {
      if (std::isfinite(any)) check(printed(format, any));
      check(printed(format, usual));
    }
    // Halfway between two floats, and next to that.
    const double halfway = (double{usual} + double{std::nextafter(usual, 1e9F)}) / 2;
    check(printed("%.17g", halfway));
    check(printed("%.15g", halfway));
    check(printed("%.17g", std::nextafter(halfway, 1e9)));
  }
  EXPECT_GT(quick, kNumbers);  // the quick way is the usual one
  for (const char* const odd : {"", "-", ".", "-.", "1e", "1e+", "1.5mm", "0x10", "1,5", "nan",
                                "inf", "+1", "1e400", "1e-400", "--1", "1.2.3", "1e5.0", "1e1e1"})
    check(odd);
  float untouched = 5;
  EXPECT_EQ(models::quick_float("12", "12" + 2, untouched), nullptr);  // may have lost digits
  EXPECT_EQ(untouched, 5);
}

/// Several closed shells, some of them turned, in one mesh of many blocks.
TEST(LargeMesh, MendingDoesNotDependOnTheLoop) {
  Mesh mesh;
  for (int i = 0; i < 3; ++i) {
    const Mesh shell = test::moved(large_mesh(), {100.0 * i, 0, 0});
    test::append(mesh, i == 1 ? test::inside_out(shell) : shell);
  }
  for (std::size_t t = 0; t < 1000; ++t)  // against their neighbours
    std::swap(mesh.triangles[100 * t][0], mesh.triangles[100 * t][1]);
  mesh.triangles.erase(mesh.triangles.begin() + 400'001);
  const ModelFile file("part.stl", stl_bytes(mesh));
  const Model serial = load_model(file.path());
  const Model parallel = load_model(file.path(), {}, backwards_on_threads);
  for (const Model* const model : {&serial, &parallel}) {
    EXPECT_EQ(model->report.components, 3U);
    EXPECT_EQ(model->report.open_edges, 3U);
    EXPECT_EQ(model->report.flipped_triangles, 1000U);
    EXPECT_EQ(model->report.non_manifold_edges, 0U);
  }
  EXPECT_TRUE(parallel.mesh.triangles == serial.mesh.triangles);
  EXPECT_EQ(parallel.report.volume_mm3, serial.report.volume_mm3);
  EXPECT_EQ(parallel.warnings, serial.warnings);
  const double one_mm3 = load_model("shape:torus?triangles=150000&size=77").report.volume_mm3;
  EXPECT_NEAR(serial.report.volume_mm3, 3 * one_mm3, 1e-3 * one_mm3);
}

}  // namespace
}  // namespace routebench
