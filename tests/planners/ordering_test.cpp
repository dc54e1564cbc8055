#include "routebench/planning/ordering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

Stroke line(Point2 a, Point2 b) { return {{a, b}, 0.4}; }

TEST(NearestFirst, TurnsStrokesRoundWhereTheirLastEndIsNearer) {
  const std::vector<Stroke> ordered = nearest_first(
      {line({0, 0}, {10, 0}), line({0, 2}, {10, 2}), line({0, 1}, {10, 1})}, {11, 0}, {});
  const std::vector<Stroke> expected{line({10, 0}, {0, 0}), line({0, 1}, {10, 1}),
                                     line({10, 2}, {0, 2})};
  EXPECT_EQ(ordered, expected);
}

TEST(NearestFirst, KeepsEveryStrokeAndAlwaysGoesToTheNearestEnd) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> place(0, 50);
  std::vector<Stroke> strokes;
  for (int i = 0; i < 200; ++i)
    strokes.push_back(line({place(random), place(random)}, {place(random), place(random)}));
  const std::vector<Stroke> ordered = nearest_first(strokes, {25, 25}, {});
  ASSERT_EQ(ordered.size(), strokes.size());
  Point2 nozzle{25, 25};
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    Stroke turned = ordered[i];
    std::reverse(turned.points.begin(), turned.points.end());
    EXPECT_EQ(std::count(strokes.begin(), strokes.end(), ordered[i]) +
                  std::count(strokes.begin(), strokes.end(), turned),
              1);
    const double gone = squared_distance(nozzle, ordered[i].points.front());
    for (std::size_t k = i; k < ordered.size(); ++k)
      for (const Point2 end : {ordered[k].points.front(), ordered[k].points.back()})
        ASSERT_LE(gone, squared_distance(nozzle, end));
    nozzle = ordered[i].points.back();
  }
}

TEST(NearestFirst, NothingStaysNothing) { EXPECT_TRUE(nearest_first({}, {0, 0}, {}).empty()); }

}  // namespace
}  // namespace routebench
