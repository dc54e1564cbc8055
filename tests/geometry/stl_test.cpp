#include "routebench/geometry/stl.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "meshes.hpp"
#include "model_files.hpp"

namespace routebench {
namespace {

using test::ascii_stl;
using test::mentions;
using test::ModelFile;
using test::refusal_of;

constexpr ModelOptions kRepair{.repair = true};

const Mesh& cube() {
  static const Mesh mesh = load_model("shape:box").mesh;
  return mesh;
}

/// Overwrites a number inside a file's bytes.
template <typename T>
std::string patched(std::string bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
  return bytes;
}

TEST(Stl, BinaryAndAsciiGiveTheSameModel) {
  const Mesh mesh = load_model("shape:torus?triangles=2000").mesh;
  const ModelFile binary("part.stl", stl_bytes(mesh));
  const Model from_binary = load_model(binary.path());
  EXPECT_EQ(from_binary.report.triangles, mesh.triangles.size());
  EXPECT_EQ(from_binary.report.vertices, mesh.vertices.size());
  EXPECT_TRUE(from_binary.warnings.empty());
  for (const char* const line_end : {"\n", "\r\n", "\r", " \n\t ", " "}) {
    const ModelFile ascii("part.stl", ascii_stl(mesh, line_end));
    const Model from_ascii = load_model(ascii.path());
    EXPECT_TRUE(from_ascii.mesh.vertices == from_binary.mesh.vertices);
    EXPECT_TRUE(from_ascii.mesh.triangles == from_binary.mesh.triangles);
    EXPECT_TRUE(from_ascii.warnings.empty());
  }
}

TEST(Stl, CoordinatesAreTheFloatsOfTheFileMinusTheLowestZ) {
  Mesh mesh = cube();
  for (Point3& p : mesh.vertices) p = {p.x * 0.1 - 7.3, p.y * 0.1 + 3.7, p.z * 0.1 - 0.7};
  const ModelFile file("part.stl", stl_bytes(mesh));
  const Model model = load_model(file.path());
  const double low = static_cast<double>(static_cast<float>(-0.7));
  for (const Point3& p : model.mesh.vertices) {
    EXPECT_TRUE(p.x == static_cast<double>(static_cast<float>(-7.3)) ||
                p.x == static_cast<double>(static_cast<float>(20 * 0.1 - 7.3)));
    EXPECT_TRUE(p.z == 0 || p.z == static_cast<double>(static_cast<float>(20 * 0.1 - 0.7)) - low);
  }
}

TEST(Stl, NegativeZeroIsZero) {
  std::string bytes = stl_bytes(cube());
  const float zero = 0;
  for (std::size_t facet = 0; facet < 12; facet += 2) {
    for (std::size_t i = 0; i < 9; ++i) {
      const std::size_t at = 84 + 50 * facet + 12 + 4 * i;
      if (std::memcmp(bytes.data() + at, &zero, 4) == 0) bytes = patched(bytes, at, -0.0F);
    }
  }
  const ModelFile file("part.stl", bytes);
  const Model model = load_model(file.path());
  EXPECT_EQ(model.report.vertices, 8U);
  EXPECT_EQ(content_hash(model.mesh), content_hash(load_model("shape:box").mesh));
}

TEST(Stl, EveryTruncationOfABinaryFileIsRefusedAndRepairReadsTheWholeFacets) {
  const std::string bytes = stl_bytes(cube());
  const ModelFile file("part.stl", "");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    file.rewrite(std::string_view(bytes).substr(0, length));
    EXPECT_NE(refusal_of(file.path()), "") << length;
    if (length < 84 + 50 * 4) {  // fewer than four facets enclose nothing worth a layer
      continue;
    }
    const Model model = load_model(file.path(), kRepair);
    EXPECT_EQ(model.report.triangles, (length - 84) / 50) << length;
    EXPECT_TRUE(mentions(model.warnings, "cut short")) << length;
  }
}

std::size_t occurrences(std::string_view text, std::string_view word) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string_view::npos; ++at) ++count;
  return count;
}

TEST(Stl, EveryTruncationOfAnAsciiFileIsRefusedOrReportsWhatIsMissing) {
  const std::string text = ascii_stl(cube());
  const ModelFile file("part.stl", "");
  for (std::size_t length = 0; length + 1 < text.size(); ++length) {
    const std::string_view head = std::string_view(text).substr(0, length);
    file.rewrite(head);
    const std::size_t whole = occurrences(head, "endfacet");
    const bool inside_facet = occurrences(head, "facet") > 2 * whole;
    if (whole < 4) continue;  // too little to be a model, whatever the reader says
    if (inside_facet) {
      EXPECT_NE(refusal_of(file.path()).find("cut short"), std::string::npos) << length;
    }
    const Model model = load_model(file.path(), kRepair);
    EXPECT_EQ(model.report.triangles, whole) << length;
    EXPECT_EQ(model.report.open_edges == 0, whole == 12) << length;
    const bool ended = occurrences(head, "endsolid") > 0;
    EXPECT_EQ(mentions(model.warnings, "cut short"), !ended) << length;
  }
}

TEST(Stl, FlippedBitsNeverDoWorseThanAnError) {
  const std::string binary = stl_bytes(cube());
  const std::string ascii = ascii_stl(cube());
  const ModelFile file("part.stl", "");
  for (const std::string& bytes : {binary, ascii}) {
    std::size_t read = 0;
    for (std::size_t bit = 0; bit < bytes.size() * 8; bit += 7) {
      std::string damaged = bytes;
      damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
      file.rewrite(damaged);
      for (const bool repair : {false, true}) {
        try {
          const Model model = load_model(file.path(), {.repair = repair});
          for (const Point3& p : model.mesh.vertices) {
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && p.z >= 0) << bit;
          }
          ++read;
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << bit;
        }
      }
    }
    EXPECT_GT(read, 0U);
  }
}

TEST(Stl, ACountFieldIsNotTrusted) {
  const std::string bytes = stl_bytes(cube());
  const ModelFile file("part.stl", "");
  for (const std::uint32_t unset : {0U, 0xFFFFFFFFU}) {
    file.rewrite(patched(bytes, 80, unset));
    const Model model = load_model(file.path());
    EXPECT_EQ(model.mesh.triangles.size(), 12U);
    EXPECT_TRUE(mentions(model.warnings, "count field"));
  }
  file.rewrite(patched(bytes, 80, std::uint32_t{4'000'000'000}));
  EXPECT_NE(refusal_of(file.path()).find("4000000000 facets, the file holds 12"),
            std::string::npos);
  EXPECT_EQ(load_model(file.path(), kRepair).mesh.triangles.size(), 12U);
  file.rewrite(bytes + "END OF FILE");
  const Model trailing = load_model(file.path());
  EXPECT_EQ(trailing.mesh.triangles.size(), 12U);
  EXPECT_TRUE(mentions(trailing.warnings, "11 bytes after"));
}

TEST(Stl, CornersThatAreNotFiniteAreRefusedByFacetAndDroppedByRequest) {
  const std::string bytes = stl_bytes(cube());
  const std::size_t facet = 6;  // counted from 0
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    const ModelFile file("part.stl", patched(bytes, 84 + 50 * facet + 12 + 4 * 4, bad));
    const std::string message = refusal_of(file.path());
    EXPECT_NE(message.find("facet 7 (byte 384): the y of corner 2 is"), std::string::npos)
        << message;
    const Model model = load_model(file.path(), kRepair);
    EXPECT_EQ(model.mesh.triangles.size(), 11U);
    EXPECT_EQ(model.report.open_edges, 3U);
    EXPECT_TRUE(mentions(model.warnings, "1 facet left out"));
  }
}

TEST(Stl, NormalsAndAttributesAreNotLookedAt) {
  std::string bytes = stl_bytes(cube());
  for (std::size_t facet = 0; facet < 12; ++facet) {
    bytes = patched(bytes, 84 + 50 * facet, std::numeric_limits<float>::quiet_NaN());
    bytes = patched(bytes, 84 + 50 * facet + 48, std::uint16_t{0xFFFF});
  }
  const ModelFile file("part.stl", bytes);
  EXPECT_EQ(content_hash(load_model(file.path()).mesh), content_hash(load_model("shape:box").mesh));
}

TEST(Stl, AsciiTakesWhatWritersMakeOfIt) {
  const std::string plain = ascii_stl(cube());
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = plain;
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
      text.replace(at, from.size(), to);
    }
    return text;
  };
  std::string upper = plain;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const ModelFile file("part.stl", "");
  for (const std::string& text : {
           "\xEF\xBB\xBF" + plain,
           "\n\n  \t" + plain,
           upper,
           replaced("solid part", "solid"),
           replaced("solid part", "solid facet vertex endloop solid facet normal"),
           replaced("solid part", "solid p\xC3\xA4rt 1.0 2.0"),
           replaced("endloop", "endloop of facet"),
           replaced("endfacet", "endfacet vertex outer facet"),
           replaced("facet normal 0 0 0", "facet normal nan -nan(ind) 1,5"),
           replaced("vertex 20", "vertex   +2.0e+01"),
           replaced("vertex 0", "vertex 1e-300"),
           replaced("endsolid part\n", "endsolid part\n\n\n; remark\n"),
           replaced("outer loop\n", "outer loop # remark\n"),
       }) {
    file.rewrite(text);
    const Model model = load_model(file.path());
    EXPECT_EQ(content_hash(model.mesh), content_hash(load_model("shape:box").mesh))
        << text.substr(0, 300);
  }
}

TEST(Stl, SeveralSolidsAreOneModel) {
  Mesh beside = cube();
  for (Point3& p : beside.vertices) p.x += 30;
  const ModelFile file("part.stl", ascii_stl(cube()) + ascii_stl(beside));
  const Model model = load_model(file.path());
  EXPECT_EQ(model.mesh.triangles.size(), 24U);
  EXPECT_EQ(model.report.components, 2U);
  EXPECT_DOUBLE_EQ(model.report.volume_mm3, 16000);
}

TEST(Stl, AsciiFaultsAreNamedWithFacetAndLine) {
  const std::string plain = ascii_stl(cube());
  const auto with_line_8 = [&](const std::string& line) {
    std::string text;
    std::size_t number = 1;
    for (std::size_t at = 0, end = 0; at < plain.size(); at = end + 1, ++number) {
      end = plain.find('\n', at);
      text += (number == 11 ? line : plain.substr(at, end - at)) + '\n';
    }
    return text;
  };
  struct Case {
    const char* line;
    const char* complaint;
  };
  const ModelFile file("part.stl", "");
  for (const Case& c :
       {Case{"vertex 0 x 0", "'x' is not a number"},
        Case{"vertex 0 1.5mm 0", "'1.5mm' is not a number"},
        Case{"vertex 0 0,5 0", "'0,5' is written with a comma"},
        Case{"vertex 0 0", "is not a number"}, Case{"vertex 0 0 0 0", "more than three numbers"},
        Case{"vertex 0 0x10 0", "is not a number"}, Case{"vertex 0 + 0", "is not a number"},
        Case{"vertex 0 1e99 0", "is infinite"}, Case{"vertex 0 1e999 0", "is infinite"},
        Case{"vertex 0 nan 0", "is not a number"}, Case{"", "has 2 corners"},
        Case{"vertex 0 0 0\nvertex 0 0 0", "more than three corners"},
        Case{"facet normal 0 0 0", "has no endfacet"}}) {
    file.rewrite(with_line_8(c.line));
    const std::string message = refusal_of(file.path());
    EXPECT_NE(message.find(c.complaint), std::string::npos) << message;
    EXPECT_NE(message.find("facet 2 (line"), std::string::npos) << message;
  }
}

TEST(Stl, WhatIsNoStlIsRefused) {
  const ModelFile file("part.stl", "");
  EXPECT_NE(refusal_of(file.path()).find("empty file"), std::string::npos);
  for (const std::string& bytes :
       {std::string(84, '\0'), std::string("solid nothing\nendsolid nothing\n"),
        std::string("solid"), std::string("# a text\nwith lines\n"), std::string(1000, ' '),
        std::string(1000, '\xFF'), std::string("solid made of water\nice and steam\n")}) {
    file.rewrite(bytes);
    EXPECT_NE(refusal_of(file.path()), "");
    EXPECT_NE(refusal_of(file.path(), kRepair), "");
  }
  EXPECT_NE(refusal_of(file.path() + ".absent").find("cannot be opened"), std::string::npos);
  EXPECT_NE(refusal_of(std::filesystem::path(file.path()).parent_path()).find("is a folder"),
            std::string::npos);
  EXPECT_NE(refusal_of("/dev/zero").find("not a regular file"), std::string::npos);
}

TEST(Stl, WritingAndReadingIsLossless) {
  const Model model = load_model("shape:cylinder?triangles=500");
  const ModelFile first("part.stl", "");
  write_stl(first.path(), model.mesh);
  const Model once = load_model(first.path());
  const ModelFile second("part.stl", stl_bytes(once.mesh));
  EXPECT_EQ(content_hash(load_model(second.path()).mesh), content_hash(once.mesh));
  EXPECT_NEAR(once.report.volume_mm3, model.report.volume_mm3, 1e-3);
  EXPECT_THROW(write_stl("/absent/folder/part.stl", model.mesh), Error);
}

}  // namespace
}  // namespace routebench
