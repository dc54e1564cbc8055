#include "routebench/planning/line_crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "planning.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

std::vector<double> places(const std::vector<Crossing>& crossings, std::uint32_t line) {
  std::vector<double> xs;
  for (const Crossing& crossing : crossings)
    if (crossing.line == line) xs.push_back(crossing.x);
  return xs;
}

using Xs = std::vector<double>;

TEST(LineCrossings, ADiamondIsCrossedWhereItMustBe) {
  const Ring diamond{{0, -2}, {2, 0}, {0, 2}, {-2, 0}};
  const auto crossings = cross_lines({diamond}, {-3, 1, 7}, CrossingSearch::kBucket);
  EXPECT_EQ(places(crossings, 0), Xs{});         // y = -3, below
  EXPECT_EQ(places(crossings, 1), (Xs{0, 0}));   // y = -2, its lowest vertex: both edges begin here
  EXPECT_EQ(places(crossings, 2), (Xs{-1, 1}));  // y = -1
  EXPECT_EQ(places(crossings, 3), (Xs{-2, 2}));  // y = 0, through two vertices: once each
  EXPECT_EQ(places(crossings, 4), (Xs{-1, 1}));  // y = 1
  EXPECT_EQ(places(crossings, 5), Xs{});         // y = 2, its highest vertex
  EXPECT_EQ(places(crossings, 6), Xs{});         // y = 3, above
}

TEST(LineCrossings, LevelEdgesAreNoCrossings) {
  const Ring step{{0, 0}, {4, 0}, {4, 1}, {2, 1}, {2, 2}, {0, 2}};
  const auto crossings = cross_lines({step}, {0, 1, 3}, CrossingSearch::kBucket);
  EXPECT_EQ(places(crossings, 0), (Xs{0, 4}));
  EXPECT_EQ(places(crossings, 1), (Xs{0, 2}));
  EXPECT_EQ(places(crossings, 2), Xs{});
}

TEST(LineCrossings, TheyNameRingAndEdge) {
  const Ring outer = test::rectangle(0, 0, 9, 9);
  const Ring hole = test::reversed(test::rectangle(3, 3, 6, 6));
  const auto crossings = cross_lines({outer, hole}, {4, 100, 1}, CrossingSearch::kBucket);
  ASSERT_EQ(crossings.size(), 4U);
  EXPECT_EQ(crossings[0], (Crossing{0, 0, 0, 3}));
  EXPECT_EQ(crossings[1].ring, 1U);
  EXPECT_EQ(crossings[2].ring, 1U);
  EXPECT_EQ(crossings[3], (Crossing{9, 0, 0, 1}));
}

TEST(LineCrossings, AllSearchesAgreeAndEveryLineHasAnEvenNumber) {
  for (const Layer& layer : test::trial_layers()) {
    const std::vector<Ring> rings = rings_of(layer.polygons);
    // Lines through vertices and edges of the made layers, and lines through none.
    for (const EvenLines lines : {EvenLines{-1, 0.5, 100}, EvenLines{0.137, 0.4071, 90},
                                  EvenLines{5, 3, 1}, EvenLines{0, 1, 0}}) {
      const auto bucket = cross_lines(rings, lines, CrossingSearch::kBucket);
      EXPECT_EQ(cross_lines(rings, lines, CrossingSearch::kSweep), bucket);
      EXPECT_EQ(cross_lines(rings, lines, CrossingSearch::kNaive), bucket);
      for (std::uint32_t line = 0; line < lines.count; ++line)
        EXPECT_EQ(places(bucket, line).size() % 2, 0U);
      EXPECT_TRUE(std::is_sorted(bucket.begin(), bucket.end(), [](const auto& a, const auto& b) {
        return a.line != b.line ? a.line < b.line : a.x < b.x;
      }));
    }
  }
}

TEST(EvenLinesTest, TheFirstLineAtOrAboveIsFoundInSpiteOfRounding) {
  const EvenLines lines{0.1, 0.1, 1000};
  for (std::uint32_t line = 0; line < lines.count; ++line) {
    const double y = lines.y(line);
    EXPECT_EQ(lines.first_at_or_above(y), line);
    EXPECT_EQ(lines.first_at_or_above(std::nextafter(y, 1e9)), line + 1);
    EXPECT_EQ(lines.first_at_or_above(std::nextafter(y, -1e9)), line);
  }
  EXPECT_EQ(lines.first_at_or_above(-1e12), 0U);
  EXPECT_EQ(lines.first_at_or_above(1e12), 1000U);
}

}  // namespace
}  // namespace routebench
