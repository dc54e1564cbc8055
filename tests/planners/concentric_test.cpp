#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "concentric/insets.hpp"
#include "planning.hpp"
#include "routebench/geometry/grid.hpp"

namespace routebench {
namespace {

using test::context_for;
using test::kSpacing;
using test::kWidth;
using test::layer_of;
using test::length_mm;
using test::word;

Route plan(const Polygons& polygons, double density, const ParamSet& params = {}) {
  return test::plan("concentric", layer_of(polygons), context_for(0, density), params);
}

const ParamSet kLoops{{"link", word("none")}, {"thin", word("drop")}};

Polygons square(double side) { return {{test::rectangle(0, 0, side, side), {}}}; }

Polygons annulus() {
  return {{test::circle({10, 10}, 10, 64), {test::reversed(test::circle({10, 10}, 4, 64))}}};
}

/// Two rooms and a corridor that is too narrow for a second loop.
Polygons dumbbell() {
  return {{{{0, 0},
            {8, 0},
            {8, 3.2},
            {12, 3.2},
            {12, 0},
            {20, 0},
            {20, 8},
            {12, 8},
            {12, 4.8},
            {8, 4.8},
            {8, 8},
            {0, 8}},
           {}}};
}

bool is_loop(const Stroke& stroke) { return stroke.points.front() == stroke.points.back(); }

TEST(Concentric, LoopsOfASquareAreWhereTheyMustBe) {
  // Distance 0.4375 / 0.25 = 1.75: at 0.25, 2 and 3.75 mm from the walls, sides 9.5, 6 and 2.5.
  ParamSet params = kLoops;
  const double sides[] = {9.5, 6, 2.5};
  for (const char* order : {"outside_in", "inside_out"}) {
    params["order"] = word(order);
    const Route route = plan(square(10), 0.25, params);
    ASSERT_EQ(route.strokes.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const Stroke& stroke = route.strokes[word(order) == word("outside_in") ? i : 2 - i];
      EXPECT_TRUE(is_loop(stroke));
      EXPECT_EQ(stroke.width_mm, kWidth);
      EXPECT_NEAR(length_mm({{stroke}}), 4 * sides[i], 1e-4);
    }
  }
}

TEST(Concentric, EveryLoopKeepsItsDistanceFromTheBoundary) {
  for (const Polygons& polygons : {annulus(), square(10), dumbbell(), test::blob()})
    for (const char* method : {"clipper", "skeleton"}) {
      ParamSet params = kLoops;
      params["method"] = word(method);
      const Route route = plan(polygons, 0.5, params);
      ASSERT_GE(route.strokes.size(), 3U);
      const EdgeGrid edges(polygons);
      for (const Stroke& stroke : route.strokes) {
        EXPECT_TRUE(is_loop(stroke));
        // Mitred corners are farther away.
        double least = 100;
        for (const Point2 p : stroke.points)
          if (const auto away = edges.distance_to_edge_mm(p, least)) least = *away;
        const double loops = (least - kWidth / 2) / (kSpacing / 0.5);
        EXPECT_NEAR(loops, std::round(loops), 0.05) << method;
      }
    }
}

/// Bands between the loops of a route: between the first and the second, the third and the fourth.
Polygons bands_of(const Route& route) {
  std::vector<Ring> rings;
  for (const Stroke& stroke : route.strokes)
    rings.emplace_back(stroke.points.begin(), stroke.points.end() - 1);
  return polygons_from_rings(rings, FillRule::kEvenOdd);
}

TEST(Concentric, ClipperAndSkeletonAgree) {
  ParamSet skeleton = kLoops;
  skeleton["method"] = word("skeleton");
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    // A skeleton mitres without end corners that point inwards, so they are rounded.
    const Polygons polygons =
        offset(offset(test::random_polygons(seed, 3), 0.6, Join::kRound), -0.6, Join::kRound);
    const Polygons a = bands_of(plan(polygons, 0.3, kLoops));
    const Polygons b = bands_of(plan(polygons, 0.3, skeleton));
    ASSERT_FALSE(a.empty());
    // They differ by slivers.
    const Polygons differences[] = {subtract(a, b), subtract(b, a)};
    for (const Polygons& difference : differences) {
      EXPECT_LE(area_mm2(difference), 0.01 * area_mm2(polygons)) << seed;
      EXPECT_LE(area_mm2(offset(difference, -0.03)), 0.001 * area_mm2(polygons)) << seed;
    }
  }
}

/// A wheel with so many teeth.
Polygons wheel(int teeth) {
  Ring ring = test::circle({30, 30}, 30, 2 * teeth);
  for (std::size_t i = 0; i < ring.size(); i += 2) ring[i] = snap(lerp({30, 30}, ring[i], 0.995));
  return {{ring, {}}};
}

TEST(Concentric, PolygonsOfMorePointsThanASkeletonMayHaveAreLeftToTheClipper) {
  // So flat are the teeth that the first inset, of which the skeleton is made, keeps their points.
  ParamSet skeleton = kLoops;
  skeleton["method"] = word("skeleton");
  constexpr int kTeeth = concentric::kMostSkeletonPoints / 2;
  for (const int teeth : {kTeeth - 25, kTeeth + 1}) {
    const bool by_clipper = plan(wheel(teeth), 0.1, skeleton) == plan(wheel(teeth), 0.1, kLoops);
    EXPECT_EQ(by_clipper, teeth > kTeeth) << teeth;
  }
}

TEST(Concentric, LinkedAsATreeARegionIsOneStroke) {
  for (const Polygons& polygons : {square(10), annulus(), dumbbell()})
    for (const double density : {1.0, 0.25})
      for (const char* order : {"inside_out", "outside_in"}) {
        const ParamSet linked{{"thin", word("drop")}, {"order", word(order)}};
        const Route tree = plan(polygons, density, linked);
        const Route loose = plan(polygons, density, kLoops);
        EXPECT_EQ(tree.strokes.size(), 1U) << density;
        EXPECT_GE(loose.strokes.size(), 3U);
        // Openings and joints are about as long.
        const double joint = kSpacing / density + kSpacing;
        EXPECT_NEAR(length_mm(tree), length_mm(loose),
                    2 * joint * static_cast<double>(loose.strokes.size()));
      }
}

TEST(Concentric, BranchesAreFinishedOneAfterTheOther) {
  ParamSet params = kLoops;
  for (const char* order : {"inside_out", "outside_in"}) {
    params["order"] = word(order);
    Route route = plan(dumbbell(), 0.25, params);
    ASSERT_GE(route.strokes.size(), 5U);
    const bool inside_out = word(order) == word("inside_out");
    if (inside_out) std::reverse(route.strokes.begin(), route.strokes.end());
    // The loop round both rooms, then one room after the other, ever smaller loops.
    int changes = 0;
    for (std::size_t i = 1; i < route.strokes.size(); ++i) {
      const auto is_left = [&](std::size_t k) { return route.strokes[k].points[0].x < 10; };
      if (i > 1 && is_left(i) != is_left(i - 1)) ++changes;
      if (i == 1 || is_left(i) != is_left(i - 1)) continue;
      EXPECT_LT(length_mm({{route.strokes[i]}}), length_mm({{route.strokes[i - 1]}}));
    }
    EXPECT_EQ(changes, 1) << order;
  }
}

TEST(Concentric, ASpiralCoversAPocketInOneStroke) {
  const ParamSet spiral{{"link", word("spiral")}, {"thin", word("drop")}};
  EXPECT_EQ(plan(square(10), 1, spiral).strokes.size(), 1U);
  EXPECT_EQ(plan(square(10), 0.25, spiral).strokes.size(), 1U);
  EXPECT_EQ(plan(annulus(), 1, spiral).strokes.size(), 2U);
  EXPECT_EQ(plan(dumbbell(), 1, spiral).strokes.size(), 3U);
  for (const Polygons& polygons : {square(10), annulus(), dumbbell()}) {
    const Route route = plan(polygons, 1, {{"link", word("spiral")}});
    EXPECT_GE(test::share_under_beads(polygons, route), 0.97);
    EXPECT_LE(length_mm(route) * kSpacing, 1.15 * area_mm2(polygons));
  }
}

TEST(Concentric, DenseRegionsAreCoveredAndNotMuchTwice) {
  std::vector<Polygons> regions{annulus(), dumbbell(), test::blob()};
  for (const double side : {0.7, 1.1, 1.3, 1.7, 2.2, 3.1, 7.77}) regions.push_back(square(side));
  for (const double width : {0.3, 0.5, 0.8, 1.0, 1.2, 1.6})
    regions.push_back({{test::rectangle(0, 0, 20, width), {}}});
  for (const Polygons& region : regions) {
    const Route route = plan(region, 1);
    const Box2 box = bounding_box(region);
    const double across = std::min(box.upper.x, box.upper.y);
    EXPECT_GE(test::share_under_beads(region, route, 0.05), across < 1   ? 0.6
                                                            : across < 2 ? 0.8
                                                                         : 0.96)
        << across;
    double volume = 0;
    for (const Stroke& stroke : route.strokes)
      volume += length_mm({{stroke}}) * (stroke.width_mm - (kWidth - kSpacing));
    EXPECT_LE(volume, 1.15 * area_mm2(region)) << across;
  }
}

TEST(Concentric, SliversGetOneStrokeInTheirMiddle) {
  const Polygons sliver{{test::rectangle(0, 0, 10, 0.3), {}}};
  for (const double density : {1.0, 0.25}) {
    const Route route = plan(sliver, density);
    ASSERT_EQ(route.strokes.size(), 1U);
    EXPECT_NEAR(route.strokes[0].width_mm, 0.3, 0.012);
    for (const Point2 p : route.strokes[0].points) EXPECT_NEAR(p.y, 0.15, 0.006);
    EXPECT_TRUE(plan(sliver, density, {{"thin", word("drop")}}).strokes.empty());
  }
}

TEST(Concentric, PublishedIsLoopsAndNothingElse) {
  const ParamSet published{{"variant", word("published")},
                           {"link", word("spiral")},
                           {"order", word("inside_out")},
                           {"thin", word("fill")}};
  for (const double density : {1.0, 0.25})
    EXPECT_EQ(plan(dumbbell(), density, published), plan(dumbbell(), density, kLoops));
}

TEST(Concentric, TheSeamIsWhereItIsAskedFor) {
  ParamSet params = kLoops;
  params["seam"] = word("fixed_point");
  params["seam_x_mm"] = 10.0;
  params["seam_y_mm"] = 10.0;
  for (const Stroke& stroke : plan(square(10), 0.25, params).strokes) {
    EXPECT_GT(stroke.points[0].x, 5);
    EXPECT_GT(stroke.points[0].y, 5);
  }
  params["seam"] = word("min_x");
  for (const Stroke& stroke : plan(square(10), 0.25, params).strokes)
    for (const Point2 p : stroke.points) EXPECT_GE(p.x, stroke.points[0].x);
}

TEST(Concentric, AGapThatWouldBeHalfEmptyGetsALineInTheMiddle) {
  // The inner loop's sides are so many line distances apart; two more loops would need two of them.
  const double apart_mm = kSpacing / 0.2;
  const auto strokes_of_strip = [&](double gap_in_distances, const ParamSet& more = {}) {
    const double height = kWidth + (2 + gap_in_distances) * apart_mm;
    ParamSet params{{"link", word("none")}};
    params.insert(more.begin(), more.end());
    return plan({{test::rectangle(0, 0, 60, height), {}}}, 0.2, params).strokes;
  };
  EXPECT_EQ(strokes_of_strip(1.4).size(), 2U);
  const std::vector<Stroke> strokes = strokes_of_strip(1.8);
  ASSERT_EQ(strokes.size(), 3U);
  EXPECT_TRUE(is_loop(strokes[0]));
  EXPECT_TRUE(is_loop(strokes[1]));
  EXPECT_FALSE(is_loop(strokes[2]));
  EXPECT_EQ(strokes[2].width_mm, kWidth);
  for (const Point2 p : strokes[2].points) EXPECT_NEAR(p.y, (kWidth + 3.8 * apart_mm) / 2, 0.02);
  EXPECT_EQ(strokes_of_strip(1.8, kLoops).size(), 2U);
}

TEST(Concentric, BetweenWallsALineIsLaidWhereThatIsNearerToWhatIsDemandedThanNone) {
  const double apart_mm = kSpacing / 0.2;
  const auto lines_in_strip = [&](double width_in_distances, int walls) {
    const Polygons strip{{test::rectangle(0, 0, 60, width_in_distances * apart_mm), {}}};
    return test::plan("concentric", layer_of(strip), context_for(walls, 0.2)).strokes.size();
  };
  EXPECT_EQ(lines_in_strip(0.45, 2), 0U);
  EXPECT_EQ(lines_in_strip(0.55, 2), 1U);
  EXPECT_EQ(lines_in_strip(0.45, 0), 1U);  // else there would be nothing at all
}

}  // namespace
}  // namespace routebench
