#include "routebench/geometry/region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "polygons.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using test::random_polygons;
using test::rectangle;

constexpr std::uint64_t kSeeds = 12;
// Booleans round crossings to the grid: areas differ by about perimeter x grid step.
constexpr double kAreaTolerance = 1e-3;

bool on_grid(const Polygons& polygons) {
  const auto good = [](const Ring& ring) {
    return std::all_of(ring.begin(), ring.end(), [](Point2 p) { return snap(p) == p; });
  };
  return std::all_of(polygons.begin(), polygons.end(), [&](const Polygon& polygon) {
    return good(polygon.outer) && std::all_of(polygon.holes.begin(), polygon.holes.end(), good);
  });
}

TEST(Region, MeasuresOfASquareWithAHole) {
  const Polygons ring =
      polygons_from_rings({rectangle(0, 0, 10, 10), rectangle(2, 2, 4, 5)}, FillRule::kEvenOdd);
  ASSERT_EQ(ring.size(), 1u);
  ASSERT_EQ(ring[0].holes.size(), 1u);
  EXPECT_DOUBLE_EQ(area_mm2(ring), 94);
  EXPECT_DOUBLE_EQ(perimeter_mm(ring), 50);
  EXPECT_GT(signed_area_mm2(ring[0].outer), 0);
  EXPECT_LT(signed_area_mm2(ring[0].holes[0]), 0);
}

TEST(Region, FillRulesCountWindingsAsNamed) {
  const Ring inner = rectangle(2, 2, 4, 4), outer = rectangle(0, 0, 10, 10);
  EXPECT_DOUBLE_EQ(area_mm2(polygons_from_rings({outer, inner}, FillRule::kEvenOdd)), 96);
  EXPECT_DOUBLE_EQ(area_mm2(polygons_from_rings({outer, inner}, FillRule::kNonZero)), 100);
  const Ring clockwise(inner.rbegin(), inner.rend());
  EXPECT_DOUBLE_EQ(area_mm2(polygons_from_rings({outer, clockwise}, FillRule::kNonZero)), 96);
  EXPECT_DOUBLE_EQ(area_mm2(polygons_from_rings({clockwise}, FillRule::kNonZero)), 4);
  EXPECT_DOUBLE_EQ(area_mm2(polygons_from_rings({clockwise}, FillRule::kPositive)), 0);
}

TEST(Region, BarsVanishWhenTheirSidesMeetWhicheverWayTheyLie) {
  constexpr double kWidth = 0.8, kLength = 12;
  for (int degrees = 0; degrees < 180; degrees += 7) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * std::numbers::pi / 180;
    const Point2 along{std::cos(angle), std::sin(angle)}, across{-along.y, along.x};
    Polygon bar;
    for (const auto& [x, y] :
         {std::pair{0.0, 0.0}, {kLength, 0.0}, {kLength, kWidth}, {0.0, kWidth}})
      bar.outer.push_back(snap(x * along + y * across));
    // Beside a block that stays.
    const Polygons both{bar, {rectangle(20, 20, 30, 30), {}}};
    const double just_mm = kWidth / 2 - 0.02;
    const double left_mm2 = 2 * 0.02 * (kLength - 2 * just_mm);
    EXPECT_NEAR(area_mm2(offset({bar}, -just_mm)), left_mm2, 1e-3);
    EXPECT_TRUE(offset({bar}, -kWidth / 2 - 1e-4).empty());
    EXPECT_NEAR(area_mm2(offset(both, -kWidth / 2 - 1e-4)), (10 - kWidth) * (10 - kWidth), 1e-2);
  }
}

TEST(Region, IslandInAHoleIsItsOwnPolygon) {
  const Polygons nested = polygons_from_rings(
      {rectangle(0, 0, 10, 10), rectangle(1, 1, 9, 9), rectangle(2, 2, 8, 8)}, FillRule::kEvenOdd);
  ASSERT_EQ(nested.size(), 2u);
  EXPECT_DOUBLE_EQ(area_mm2(nested), 100 - 64 + 36);
}

TEST(Region, ResultDoesNotDependOnHowRingsAreGiven) {
  std::mt19937_64 random(1);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    std::vector<Ring> rings;
    for (int i = 0; i < 6; ++i)
      rings.push_back(test::star(seed * 10 + static_cast<std::uint64_t>(i), 16,
                                 {2.0 * i, 1.5 * (i % 3)}, 1, 5));
    const Polygons expected = polygons_from_rings(rings, FillRule::kNonZero);
    std::shuffle(rings.begin(), rings.end(), random);
    for (Ring& ring : rings)
      std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(random() % 16),
                  ring.end());
    EXPECT_EQ(polygons_from_rings(rings, FillRule::kNonZero), expected);
  }
}

TEST(Region, InclusionAndExclusion) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Polygons a = random_polygons(seed), b = random_polygons(seed + 100);
    const double common = area_mm2(intersect(a, b));
    EXPECT_NEAR(area_mm2(unite(a, b)), area_mm2(a) + area_mm2(b) - common, kAreaTolerance);
    EXPECT_NEAR(area_mm2(subtract(a, b)), area_mm2(a) - common, kAreaTolerance);
    EXPECT_NEAR(area_mm2(intersect(subtract(a, b), b)), 0, kAreaTolerance);
    EXPECT_TRUE(on_grid(unite(a, b)) && on_grid(intersect(a, b)) && on_grid(subtract(a, b)));
  }
}

TEST(Region, NothingIsNeutral) {
  const Polygons a = random_polygons(3);
  EXPECT_EQ(subtract(a, {}), a);
  EXPECT_TRUE(intersect(a, {}).empty());
  EXPECT_TRUE(intersect({}, a).empty());
  EXPECT_TRUE(subtract({}, a).empty());
  EXPECT_NEAR(area_mm2(unite(a, {})), area_mm2(a), kAreaTolerance);
  EXPECT_TRUE(offset({}, 1).empty());
  EXPECT_LT(bounding_box(Polygons{}).upper.x, bounding_box(Polygons{}).lower.x);
}

TEST(Region, OffsetOfASquareIsASquare) {
  const Polygons square = {{rectangle(0, 0, 10, 10), {}}};
  EXPECT_NEAR(area_mm2(offset(square, -1)), 64, 1e-4);
  EXPECT_NEAR(area_mm2(offset(square, 1)), 144, 1e-4);
  EXPECT_NEAR(area_mm2(offset(square, 1, Join::kRound)), 100 + 40 + std::numbers::pi, 0.02);
  EXPECT_TRUE(offset(square, -5.001).empty());
  EXPECT_EQ(offset(square, 0), square);
}

TEST(Region, OffsetIsMonotoneAndKeepsItsDistance) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Polygons a = random_polygons(seed);
    const Polygons shrunk = offset(a, -0.5), grown = offset(a, 0.5, Join::kRound);
    EXPECT_NEAR(area_mm2(subtract(shrunk, a)), 0, kAreaTolerance);
    EXPECT_NEAR(area_mm2(subtract(a, grown)), 0, kAreaTolerance);
    // Every corner of the shrunk ring is at least the distance away from the outline, up to
    // cleaning.
    for (const Polygon& inner : shrunk)
      for (const Point2 p : inner.outer)
        for (const Polygon& polygon : a)
          for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
            const Point2 q = nearest_on_segment(p, polygon.outer[i],
                                                polygon.outer[(i + 1) % polygon.outer.size()]);
            EXPECT_GE(distance(p, q), 0.5 - 0.006);
          }
  }
}

TEST(Region, OffsetsOfFineCurvesAreAsRoundAsOthers) {
  for (const double radius : {2.0, 5.0, 15.0})
    for (const int points : {50, 400, 1000, 4000}) {
      const Polygons inner = offset({{test::circle({0, 0}, radius, points), {}}}, -0.25);
      ASSERT_EQ(inner.size(), 1U);
      // No point of a chord is farther from the circle than its middle.
      const Ring& ring = inner[0].outer;
      const double sagitta = radius * (1 - std::cos(std::numbers::pi / points));
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point2 middle = lerp(ring[i], ring[(i + 1) % ring.size()], 0.5);
        EXPECT_NEAR(distance(middle, {0, 0}), radius - 0.25, sagitta + 0.006)
            << radius << " mm, " << points << " points";
      }
    }
}

TEST(Region, RepeatedOffsetsLoseNothing) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Polygons a = random_polygons(seed);
    Polygons step_by_step = a;
    for (int i = 0; i < 8; ++i) step_by_step = offset(step_by_step, -0.1, Join::kRound);
    EXPECT_NEAR(area_mm2(step_by_step), area_mm2(offset(a, -0.8, Join::kRound)),
                0.004 * area_mm2(a));
  }
}

TEST(Region, RingsOfABoundaryMoveAsThePolygonsDo) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Polygons polygons = random_polygons(seed);
    std::vector<Ring> rings;
    for (const Polygon& polygon : polygons) {
      rings.insert(rings.begin(), polygon.holes.begin(), polygon.holes.end());
      rings.push_back(polygon.outer);
    }
    for (const double mm : {-0.6, -0.1, 0.3})
      EXPECT_EQ(offset_boundary(rings, std::vector<double>(rings.size(), mm)), offset(polygons, mm))
          << seed << ", " << mm;
  }
}

TEST(Region, EachRingMovesByItsOwnDistance) {
  const auto moved = [](Point2 at, double outer_mm, double inner_mm) {
    const Ring outer = rectangle(at.x, at.y, at.x + 10, at.y + 10);
    const Ring inner = test::reversed(rectangle(at.x + 3, at.y + 3, at.x + 7, at.y + 7));
    return offset_boundary({inner, outer}, {inner_mm, outer_mm});
  };
  // The second place is beyond what overlays take.
  for (const Point2 at : {Point2{0, 0}, Point2{2000, -3000}}) {
    EXPECT_NEAR(area_mm2(moved(at, -1, -0.25)), 64 - 4.5 * 4.5, 1e-3);
    EXPECT_NEAR(area_mm2(moved(at, 0.5, 1)), 121 - 4, 1e-3);
    EXPECT_NEAR(area_mm2(moved(at, -0.5, -2.75)), 0, 1e-3);  // the hole has grown over it
    EXPECT_EQ(moved(at, -1, -0.25).size(), 1U);
  }
  EXPECT_TRUE(offset_boundary({}, {}).empty());
}

TEST(Region, ThinPartsGoAndThickPartsStay) {
  // A 10 mm square with a 0.3 mm wide hair and a 2 mm wide arm.
  const Polygons shape = polygons_from_rings(
      {rectangle(0, 0, 10, 10), rectangle(10, 5, 20, 5.3), rectangle(0, -5, 2, 0.0)},
      FillRule::kNonZero);
  EXPECT_NEAR(area_mm2(without_thin_parts(shape, 0.45)), 110, 0.1);
  EXPECT_NEAR(area_mm2(without_thin_parts(shape, 0.25)), 113, 0.1);
  const Polygons strip = {{rectangle(0, 0, 10, 0.45), {}}};
  EXPECT_NEAR(area_mm2(without_thin_parts(strip, 0.45)), 4.5, 1e-3);
}

}  // namespace
}  // namespace routebench
