#include "routebench/geometry/layer_io.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "meshes.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/solid.hpp"

namespace routebench {
namespace {

/// A file of its own for each test, gone afterwards.
class LayerFile : public testing::Test {
 protected:
  LayerFile()
      : path_(std::filesystem::temp_directory_path() /
              ("routebench_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
               std::to_string(std::random_device{}()))) {}
  ~LayerFile() override { std::filesystem::remove(path_); }

  const std::filesystem::path& holding(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  std::vector<Layer> wkt(const std::string& text, double layer_height_mm = 0.2) const {
    return read_wkt(holding(text), layer_height_mm);
  }
  Layer svg(const std::string& text) const { return read_svg(holding(text)); }

  /// What the reader says about a text, without the file's name.
  template <typename Read>
  std::string complaint(const std::string& text, Read&& read) const {
    try {
      read(holding(text));
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(message.find('\n'), std::string::npos);
      EXPECT_EQ(message.find(path_.string()), 0u);
      return message.substr(path_.string().size());
    }
    ADD_FAILURE() << "was read: " << text;
    return {};
  }
  std::string wkt_complaint(const std::string& text) const {
    return complaint(text, [](const auto& path) { return read_wkt(path, 0.2); });
  }
  std::string svg_complaint(const std::string& text) const {
    return complaint(text, [](const auto& path) { return read_svg(path); });
  }

 private:
  std::filesystem::path path_;
};
using Wkt = LayerFile;
using Svg = LayerFile;

std::string wkt_of(const std::vector<Layer>& layers) {
  std::ostringstream out;
  write_wkt(out, layers);
  return out.str();
}

std::string svg_of(const Layer& layer) {
  std::ostringstream out;
  write_svg(out, layer);
  return out.str();
}

/// Layers with everything that a file must keep: holes, islands in holes, odd heights, gaps in the
/// count, empty layers, repair marks, coordinates far out and below zero.
std::vector<Layer> assorted_layers() {
  std::vector<Layer> layers;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    Layer layer;
    layer.index = static_cast<int>(3 * seed);
    layer.z_mm = 0.1 + static_cast<double>(seed) / 3;
    layer.height_mm = 1.0 / 7;
    layer.repaired = seed % 2 == 0;
    if (seed != 3) layer.polygons = test::random_polygons(seed);
    for (Polygon& polygon : layer.polygons)
      for (Point2& p : polygon.outer) p = snap(Point2{p.x - 1000.0 / 3, p.y + 12345.6789});
    for (Polygon& polygon : layer.polygons)
      for (Ring& hole : polygon.holes)
        for (Point2& p : hole) p = snap(Point2{p.x - 1000.0 / 3, p.y + 12345.6789});
    layers.push_back(layer);
  }
  return layers;
}

TEST_F(Wkt, ReadsBackWhatItWrote) {
  const std::vector<Layer> layers = assorted_layers();
  const std::string text = wkt_of(layers);
  const std::vector<Layer> read = wkt(text);
  EXPECT_EQ(read, layers);
  EXPECT_EQ(wkt_of(read), text);
}

TEST_F(Wkt, SlicedLayersSurviveTheFile) {
  const Mesh mesh = test::torus(10.1, 3.3, 50, 40, true);
  const std::vector<Layer> layers = slice_mesh(mesh, {}, "torus").layers;
  EXPECT_EQ(wkt(wkt_of(layers)), layers);
}

TEST_F(Wkt, IsOneMultipolygonALineAfterTheComments) {
  const std::vector<Layer> layers = assorted_layers();
  std::istringstream in(wkt_of(layers));
  std::size_t geometries = 0;
  for (std::string line; std::getline(in, line);) {
    if (geometries == 0 && line.starts_with("#")) continue;
    EXPECT_TRUE(line.starts_with("MULTIPOLYGON Z ")) << line;
    ++geometries;
  }
  EXPECT_EQ(geometries, layers.size());
}

TEST_F(Wkt, NumbersPlainLayersUpwards) {
  const std::vector<Layer> layers =
      wkt("POLYGON((0 0,10 0,10 10,0 10,0 0))\nMULTIPOLYGON EMPTY\n\n"
          "MULTIPOLYGON(((0 0,1 0,0 1,0 0)))",
          0.3);
  ASSERT_EQ(layers.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const Layer& layer = layers[static_cast<std::size_t>(i)];
    EXPECT_EQ(layer.index, i);
    EXPECT_EQ(layer.height_mm, 0.3);
    EXPECT_EQ(layer.z_mm, (i + 0.5) * 0.3);
    EXPECT_FALSE(layer.repaired);
  }
  EXPECT_TRUE(layers[1].polygons.empty());
  EXPECT_DOUBLE_EQ(area_mm2(layers[2].polygons), 0.5);
}

TEST_F(Wkt, UnderstandsTheDialectsOfOtherTools) {
  const Polygons expected{{test::rectangle(0, 0, 10, 10), {{{2, 2}, {2, 4}, {4, 4}, {4, 2}}}}};
  for (const std::string& text : {
           std::string("POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0), (2 2, 2 4, 4 4, 4 2, 2 2))"),
           std::string("polygon((0 0,10 0,10 10,0 10,0 0),(2 2,2 4,4 4,4 2,2 2))"),
           std::string("\xEF\xBB\xBFPOLYGON((0 0,10 0,10 10,0 10,0 0),(2 2,2 4,4 4,4 2,2 2))\r\n"),
           std::string("  MultiPolygon  ( ( ( 0.0 0.0 , 10 0 , 1e1 10.000 , 0 10 , 0 0 ) ,\t"
                       "(2 2,2 4,4 4,4 2,2 2) ) )  \r\n\r\n"),
           // Rings the wrong way round.
           std::string("POLYGON ((0 0, 0 10, 10 10, 10 0, 0 0), (2 2, 4 2, 4 4, 2 4, 2 2))"),
           // Points repeated, the closing one too.
           std::string("POLYGON((0 0,10 0,10 0,10 10,0 10,0 0,0 0),(2 2,2 4,4 4,4 2,2 2,2 2))"),
       }) {
    const std::vector<Layer> layers = wkt(text + "\n# drawn by hand");
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_EQ(layers[0].polygons, expected) << text;
  }
  for (const std::string keyword : {"POLYGON Z", "POLYGONZ", "PolygonZ ", "POLYGON"}) {
    const std::vector<Layer> layers = wkt(keyword + "((0 0 7,10 0 7,10 10 7,0 10 7,0 0 7))");
    EXPECT_EQ(layers[0].z_mm, 7);
    EXPECT_DOUBLE_EQ(area_mm2(layers[0].polygons), 100);
  }
}

TEST_F(Wkt, MakesPolygonsSound) {
  // Overlapping parts, a bow tie, a hole that reaches beyond its ring and one beside it.
  EXPECT_DOUBLE_EQ(
      area_mm2(
          wkt("MULTIPOLYGON(((0 0,10 0,10 10,0 10,0 0)),((5 5,15 5,15 15,5 15,5 5)))")[0].polygons),
      175);
  EXPECT_DOUBLE_EQ(area_mm2(wkt("POLYGON((0 0,10 10,10 0,0 10,0 0))")[0].polygons), 50);
  EXPECT_DOUBLE_EQ(
      area_mm2(wkt("POLYGON((0 0,10 0,10 10,0 10,0 0),(5 5,15 5,15 15,5 15,5 5))")[0].polygons),
      75);
  const Layer beside = wkt("POLYGON((0 0,10 0,10 10,0 10,0 0),(20 0,25 0,25 5,20 5,20 0))")[0];
  EXPECT_EQ(beside.polygons, (Polygons{{test::rectangle(0, 0, 10, 10), {}}}));
  // Two halves with a common wall are one part.
  const Layer halves =
      wkt("MULTIPOLYGON(((0 0,5 0,5 10,0 10,0 0)),((5 0,10 0,10 10,5 10,5 0)))")[0];
  EXPECT_EQ(halves.polygons.size(), 1u);
  // A line without area.
  EXPECT_TRUE(wkt("POLYGON((0 0,10 10,5 5,0 0))")[0].polygons.empty());
}

TEST_F(Wkt, SaysWhichLayersItDidNotTakeToTheLetter) {
  const std::string sound = "POLYGON((0 0,9 0,9 9,0 9,0 0),(2 2,3 2,3 3,2 2))\n";
  const std::string bow_tie = "POLYGON((0 0,4 4,4 0,0 4,0 0))\n";
  const std::string hole_outside = "POLYGON((0 0,1 0,1 1,0 1,0 0),(5 5,6 5,6 6,5 5))\n";
  std::vector<std::string> warnings;
  static_cast<void>(read_wkt(holding(sound + sound), 0.2, &warnings));
  EXPECT_TRUE(warnings.empty());
  static_cast<void>(read_wkt(holding(sound + bow_tie + sound + hole_outside), 0.2, &warnings));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("2 layers of 4, first layer 1, with rings that cross"))
      << warnings[0];
}

TEST_F(Wkt, ComplainsWithLineAndColumn) {
  const std::string good = "POLYGON((0 0,1 0,0 1,0 0))\n";
  EXPECT_NE(wkt_complaint(good + "POLYGON((0 0,1 0,x 1,0 0))").find(":2:18: expected x"),
            std::string::npos);
  EXPECT_NE(wkt_complaint(good + "LINESTRING(0 0,1 1)").find(":2:1: expected MULTIPOLYGON"),
            std::string::npos);
  EXPECT_NE(wkt_complaint("POLYGON((0 0,1 0,0 1))").find(":1:9: the ring does not end"),
            std::string::npos);
  EXPECT_NE(wkt_complaint("POLYGON((0 0,1 0,0 0))").find("three points"), std::string::npos);
  EXPECT_NE(wkt_complaint(good + good + "#\n\nPOLYGON ZM((0 0 1 1))").find(":5:9: 'ZM'"),
            std::string::npos);
}

TEST_F(Wkt, RefusesWhatIsNotALayer) {
  for (const char* text :
       {"",
        "\n\n",
        "# only a comment",
        "POLYGON",
        "POLYGON(",
        "POLYGON()",
        "POLYGON(())",
        "POLYGON((0 0,1 0,0 1,0 0)",
        "POLYGON((0 0,1 0,0 1,0 0)))",
        "POLYGON((0 0,1 0,0 1,0 0)) x",
        "POLYGON((0 0,1 0,0 1,0 0)) POLYGON((0 0,1 0,0 1,0 0))",
        "POLYGON(0 0,1 0,0 1,0 0)",
        "POLYGON((0,0 1,0 0,1 0,0))",
        "POLYGON((nan 0,1 0,0 1,nan 0))",
        "POLYGON((inf 0,1 0,0 1,inf 0))",
        "POLYGON((1e999 0,1 0,0 1,1e999 0))",
        "POLYGON((1e30 0,1 0,0 1,1e30 0))",
        "POLYGON Z((0 0,1 0,0 1,0 0))",
        "POLYGON((0 0 1,1 0 1,0 1 2,0 0 1))",
        "POLYGON((0 0,1 0 1,0 1,0 0))",
        "POLYGON((0 0 1 1,1 0 1 1,0 1 1 1,0 0 1 1))",
        "MULTIPOLYGON((0 0,1 0,0 1,0 0))",
        "MULTIPOLYGON M (((0 0 1,1 0 1,0 1 1,0 0 1)))",
        "GEOMETRYCOLLECTION EMPTY",
        "POLYGON((0 0 1,1 0 1,0 1 1,0 0 1))\nPOLYGON((0 0 1,1 0 1,0 1 1,0 0 1))"})
    EXPECT_FALSE(wkt_complaint(text).empty()) << text;
  EXPECT_THROW(static_cast<void>(read_wkt("no/such/file.wkt", 0.2)), Error);
  try {
    static_cast<void>(read_wkt(std::filesystem::temp_directory_path(), 0.2));
    ADD_FAILURE() << "a folder was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("is a folder"), std::string::npos) << error.what();
  }
}

TEST_F(Wkt, NoCutShortOrDamagedFileDoesHarm) {
  std::vector<Layer> layers = assorted_layers();
  layers.resize(2);
  for (Layer& layer : layers) layer.polygons = test::random_polygons(5, 2);
  const std::string text = wkt_of(layers);
  for (std::size_t length = 0; length + 1 < text.size(); length += 1 + length / 50)
    EXPECT_FALSE(wkt_complaint(text.substr(0, length)).empty()) << length;
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = text;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    try {
      static_cast<void>(wkt(damaged));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    }
  }
}

TEST_F(Svg, ReadsBackWhatItWrote) {
  std::vector<Layer> layers = assorted_layers();
  find_solid(layers, 1);
  for (const Layer& layer : layers) {
    const std::string text = svg_of(layer);
    const Layer read = svg(text);
    EXPECT_EQ(read, layer);
    EXPECT_EQ(svg_of(read), text);
  }
}

TEST_F(Svg, IsInMillimetresWithYUpwardsAndLargeEnoughToSee) {
  Layer layer;
  layer.polygons = {{test::rectangle(10, 20, 40, 60), {}}};
  layer.repaired = true;
  const std::string text = svg_of(layer);
  for (const char* part : {"width=\"610\" height=\"800\" viewBox=\"9 -61 32 42\"", "scale(1 -1)",
                           "data-repaired=\"true\"", "d=\"M10 20L40 20L40 60L10 60Z\""})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(Svg, AnExtremeShapeKeepsASizeOnTheScreen) {
  for (const auto& [width_mm, height_mm] : {std::pair{0.001, 0.002}, {1e6, 2.0}, {3.0, 3.0}}) {
    const PictureSize shown = picture_size(width_mm, height_mm);
    EXPECT_EQ(std::max(shown.width_px, shown.height_px), 800);
    EXPECT_GE(std::min(shown.width_px, shown.height_px), 1);
  }
}

TEST_F(Svg, ComplainsWithLineAndColumn) {
  Layer layer;
  layer.polygons = {{test::rectangle(0, 0, 1, 1), {}}};
  std::string text = svg_of(layer);
  text.replace(text.find("L1 0"), 4, "C1 0");
  EXPECT_NE(svg_complaint(text).find(":4:"), std::string::npos);
  EXPECT_NE(svg_complaint(text).find("expected L"), std::string::npos);
  EXPECT_NE(svg_complaint("<svg></svg>").find("data-index"), std::string::npos);
  EXPECT_NE(svg_complaint("").find("expected an <svg>"), std::string::npos);
}

TEST_F(Svg, NoCutShortOrDamagedFileDoesHarm) {
  Layer layer;
  layer.polygons = test::random_polygons(5, 3);
  layer.solid = test::random_polygons(6, 2);
  const std::string text = svg_of(layer);
  const std::size_t end = text.find("</svg>");
  for (std::size_t length = 0; length < end; length += 1 + length / 50)
    EXPECT_FALSE(svg_complaint(text.substr(0, length)).empty()) << length;
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = text;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<char>(random());
    try {
      static_cast<void>(svg(damaged));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    }
  }
}

}  // namespace
}  // namespace routebench
