#include "routebench/harness/route_svg.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "random_polygons.hpp"

namespace routebench {
namespace {

std::size_t count(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return static_cast<std::size_t>(
      std::distance(std::sregex_iterator(text.begin(), text.end(), regex), std::sregex_iterator()));
}

/// The part of a document between an opening group with an id and its end.
std::string group(const std::string& svg, const std::string& id) {
  const std::size_t begin = svg.find("<g id=\"" + id + "\"");
  EXPECT_NE(begin, svg.npos) << id;
  return svg.substr(begin, svg.find("</g>", begin) - begin);
}

struct Example {
  Layer layer{.index = 12,
              .z_mm = 2.5,
              .height_mm = 0.2,
              .polygons = {{test::rectangle(0, 0, 10, 10), {{{4, 4}, {4, 6}, {6, 6}, {6, 4}}}}},
              .solid = {}};
  PlannedLayer planned;
  Example() {
    planned.route.strokes = {
        {{{1, 1}, {9, 1}, {9, 9}}, 0.45}, {{{9, 9}, {8, 8}}, 0.45}, {{{2, 8.5}, {2, -0.25}}, 0.6}};
    planned.kinds = {StrokeKind::kWall, StrokeKind::kDense, StrokeKind::kSparse};
  }
  [[nodiscard]] std::string svg(std::optional<Point2> entered_from = std::nullopt) const {
    std::ostringstream out;
    write_route_svg(out, layer, planned, entered_from);
    return out.str();
  }
};

TEST(RouteSvg, ShowsEveryStrokeOnceInItsGroup) {
  const std::string svg = Example().svg();
  EXPECT_EQ(count(svg, "data-stroke="), 3u);
  EXPECT_NE(group(svg, "wall").find("data-stroke=\"0\" stroke-width=\"0.45\" d=\"M1 1L9 1L9 9\""),
            svg.npos);
  EXPECT_NE(group(svg, "dense").find("data-stroke=\"1\""), svg.npos);
  EXPECT_NE(group(svg, "sparse").find("stroke-width=\"0.6\" d=\"M2 8.5L2 -0.25\""), svg.npos);
}

TEST(RouteSvg, DrawsTravelsApartAndMarksBothEnds) {
  const Example example;
  EXPECT_EQ(count(group(example.svg(), "travel"), "<path"), 1u) << "strokes that meet have no gap";
  EXPECT_NE(group(example.svg(), "travel").find("M8 8L2 8.5"), std::string::npos);
  EXPECT_EQ(count(group(example.svg(Point2{-3, 0}), "travel"), "<path"), 2u);
  EXPECT_EQ(count(example.svg(), "<circle id=\"start\"[^>]*cx=\"1\" cy=\"1\""), 1u);
  EXPECT_EQ(count(example.svg(), "<rect id=\"end\""), 1u);
}

TEST(RouteSvg, HolesAreHoles) {
  const std::string svg = Example().svg();
  EXPECT_EQ(count(svg, "id=\"material\"[^>]*fill-rule=\"evenodd\" d=\"M[^Z]*ZM[^Z]*Z\""), 1u);
}

TEST(RouteSvg, TheViewHoldsEverythingAndUpIsUp) {
  const std::string svg = Example().svg(Point2{-3, 12});
  std::smatch found;
  ASSERT_TRUE(std::regex_search(
      svg, found, std::regex("viewBox=\"([-0-9.]+) ([-0-9.]+) ([-0-9.]+) ([-0-9.]+)\"")));
  const double left = std::stod(found[1]), top = std::stod(found[2]);
  EXPECT_LT(left, -3);
  EXPECT_GT(left + std::stod(found[3]), 10);
  EXPECT_LT(top, -12) << "y is turned over";
  EXPECT_GT(top + std::stod(found[4]), 0.25);
  EXPECT_NE(svg.find("scale(1 -1)"), svg.npos);
}

TEST(RouteSvg, AnEmptyLayerIsAValidPicture) {
  std::ostringstream out;
  write_route_svg(out, Layer{}, PlannedLayer{});
  EXPECT_EQ(count(out.str(), "<g "), count(out.str(), "</g>"));
  EXPECT_EQ(out.str().find("inf"), std::string::npos);
  EXPECT_EQ(out.str().find("<circle"), std::string::npos);
}

}  // namespace
}  // namespace routebench
