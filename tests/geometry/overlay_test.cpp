/// Laws of Booleans, fill rules and offsets on rings that meet in every possible way.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "random_polygons.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

constexpr double kMiddleX = 0.4871, kMiddleY = 0.3197;  // of a cell: on none of the lattice's lines
constexpr int kSide = 7;

/// Rings with corners on a small lattice: edges lie on each other, corners on edges, rings cross
/// themselves, turn back and repeat.
std::vector<Ring> lattice_rings(std::mt19937_64& random, int count) {
  std::uniform_int_distribution<int> place(0, kSide), corners(3, 9);
  std::vector<Ring> rings;
  for (int i = 0; i < count; ++i) {
    Ring ring;
    for (int n = corners(random); n > 0; --n)
      ring.push_back({1.0 * place(random), 1.0 * place(random)});
    rings.push_back(std::move(ring));
  }
  return rings;
}

/// How often rings run round a point, by the definition.
int winding(const std::vector<Ring>& rings, Point2 p) {
  int sum = 0;
  for (const Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[(i + 1) % ring.size()];
      if (a.y <= p.y && b.y > p.y && cross(b - a, p - a) > 0) ++sum;
      if (b.y <= p.y && a.y > p.y && cross(b - a, p - a) < 0) --sum;
    }
  return sum;
}

std::vector<Ring> rings_of(const Polygons& polygons) {
  std::vector<Ring> rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

bool holds(const Polygons& polygons, Point2 p) { return winding(rings_of(polygons), p) != 0; }

/// Calls visit(point) for places between all lines of the lattice.
template <typename Visit>
void for_each_place(Visit&& visit) {
  for (double x = -1; x <= kSide + 1; x += 0.5)
    for (double y = -1; y <= kSide + 1; y += 0.5) visit(Point2{x + kMiddleX / 3, y + kMiddleY / 3});
}

/// Of polygons: rings run the right way round and no place is in two of them.
void expect_sound(const Polygons& polygons) {
  for (const Polygon& polygon : polygons) {
    EXPECT_GT(signed_area_mm2(polygon.outer), 0);
    for (const Ring& hole : polygon.holes) EXPECT_LT(signed_area_mm2(hole), 0);
  }
  const std::vector<Ring> rings = rings_of(polygons);
  for_each_place([&](Point2 p) {
    const int count = winding(rings, p);
    EXPECT_TRUE(count == 0 || count == 1) << count << " times round " << p.x << ", " << p.y;
    const auto in = std::count_if(polygons.begin(), polygons.end(),
                                  [&](const Polygon& polygon) { return holds({polygon}, p); });
    EXPECT_EQ(in, count);
  });
}

/// No two edges cross or lie on each other. Edges may be off by what rounding moves.
void expect_edges_meet_in_points_only(const Polygons& polygons) {
  struct Segment {
    Point2 a, b;
  };
  std::vector<Segment> edges;
  for (const Ring& ring : rings_of(polygons))
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
  const auto side = [](const Segment& s, Point2 p) {
    const double z = cross(s.b - s.a, p - s.a);  // exact on the grid at this size
    return z > 0 ? 1 : z < 0 ? -1 : 0;
  };
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Segment &s = edges[i], &t = edges[k];
      EXPECT_FALSE(side(s, t.a) * side(s, t.b) < 0 && side(t, s.a) * side(t, s.b) < 0);
      const bool parallel = side(s, t.a) == 0 && side(s, t.b) == 0;
      const auto inside = [&](Point2 p) { return dot(p - s.a, p - s.b) < 0; };
      EXPECT_FALSE(parallel && (inside(t.a) || inside(t.b) || inside(0.5 * (t.a + t.b))));
    }
}

double difference_mm2(const Polygons& a, const Polygons& b) {
  return area_mm2(subtract(a, b)) + area_mm2(subtract(b, a));
}

Polygons moved(Polygons polygons, Point2 by) {
  for (Polygon& polygon : polygons) {
    for (Point2& p : polygon.outer) p = p + by;
    for (Ring& hole : polygon.holes)
      for (Point2& p : hole) p = p + by;
  }
  return polygons;
}

TEST(Overlay, FillRulesHoldByDefinition) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 150; ++round) {
    const std::vector<Ring> rings = lattice_rings(random, 1 + round % 5);
    const Polygons non_zero = polygons_from_rings(rings, FillRule::kNonZero);
    const Polygons odd = polygons_from_rings(rings, FillRule::kEvenOdd);
    const Polygons positive = polygons_from_rings(rings, FillRule::kPositive);
    for_each_place([&](Point2 p) {
      const int count = winding(rings, p);
      EXPECT_EQ(holds(non_zero, p), count != 0) << "round " << round;
      EXPECT_EQ(holds(odd, p), count % 2 != 0) << "round " << round;
      EXPECT_EQ(holds(positive, p), count > 0) << "round " << round;
    });
    for (const Polygons& polygons : {non_zero, odd, positive}) {
      expect_sound(polygons);
      expect_edges_meet_in_points_only(polygons);
    }
  }
}

TEST(Overlay, BooleansHoldByDefinition) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 150; ++round) {
    const Polygons a = polygons_from_rings(lattice_rings(random, 3), FillRule::kEvenOdd);
    const Polygons b = polygons_from_rings(lattice_rings(random, 3), FillRule::kEvenOdd);
    const Polygons either = unite(a, b), both = intersect(a, b), only = subtract(a, b);
    for_each_place([&](Point2 p) {
      const bool in_a = holds(a, p), in_b = holds(b, p);
      EXPECT_EQ(holds(either, p), in_a || in_b) << "round " << round;
      EXPECT_EQ(holds(both, p), in_a && in_b) << "round " << round;
      EXPECT_EQ(holds(only, p), in_a && !in_b) << "round " << round;
    });
    for (const Polygons& polygons : {either, both, only}) {
      expect_sound(polygons);
      expect_edges_meet_in_points_only(polygons);
    }
    EXPECT_EQ(unite(a, a), a);
    EXPECT_EQ(intersect(a, a), a);
    EXPECT_TRUE(subtract(a, a).empty());
  }
}

TEST(Overlay, NoPointLiesOnTheLineBetweenItsNeighbours) {
  const Ring divided = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  EXPECT_EQ(polygons_from_rings({divided}, FillRule::kNonZero),
            (Polygons{{test::rectangle(0, 0, 2, 2), {}}}));
}

TEST(Overlay, HolesMayTouchWhatIsAroundThem) {
  const Ring outer = test::rectangle(0, 0, 6, 6);
  const Ring corner_on_wall = {{0, 3}, {2, 4}, {2, 2}}, corner_on_hole = {{2, 2}, {4, 3}, {4, 1}};
  const Polygons ring =
      polygons_from_rings({outer, corner_on_wall, corner_on_hole}, FillRule::kEvenOdd);
  ASSERT_EQ(ring.size(), 1u);
  EXPECT_EQ(ring[0].holes.size(), 2u);
  EXPECT_DOUBLE_EQ(area_mm2(ring), 36 - 2 - 2);
  // Two squares that meet in a corner are two polygons.
  EXPECT_EQ(polygons_from_rings({test::rectangle(0, 0, 1, 1), test::rectangle(1, 1, 2, 2)},
                                FillRule::kNonZero)
                .size(),
            2u);
}

/// Copies of one ring whose corners are moved by a few units: sides nearly coincide, as those of
/// neighbouring layers do, and cross at angles so small that what rounding a crossing moves may
/// meet the next side.
std::vector<Ring> nearly_equal_rings(int sides, int copies, int units) {
  std::mt19937_64 random(7);
  std::uniform_int_distribution<int> by(-units, units);
  std::vector<Ring> rings;
  for (int copy = 0; copy < copies; ++copy) {
    Ring ring;
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides + 0.3;
      const Point2 move{by(random) / kGridUnitsPerMm, by(random) / kGridUnitsPerMm};
      ring.push_back(snap(30.0 * Point2{std::cos(angle), std::sin(angle)}) + move);
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

std::size_t crossings(const std::vector<Ring>& rings) {
  std::vector<std::pair<Point2, Point2>> edges;
  for (const Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      edges.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
  const auto apart = [](const auto& s, Point2 p, Point2 q) {
    return cross(s.second - s.first, p - s.first) * cross(s.second - s.first, q - s.first) <= 0;
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (apart(edges[i], edges[k].first, edges[k].second) &&
          apart(edges[k], edges[i].first, edges[i].second))
        ++count;
  return count;
}

TEST(Overlay, SidesThatNearlyCoincideAreCutNoOftenerThanTheyCross) {
  for (const int sides : {4, 12})
    for (const int copies : {3, 6, 12})
      for (const int units : {1, 8, 64}) {
        const std::vector<Ring> rings = nearly_equal_rings(sides, copies, units);
        for (const FillRule rule : {FillRule::kNonZero, FillRule::kEvenOdd}) {
          const Polygons polygons = polygons_from_rings(rings, rule);
          std::vector<Point2> corners;
          for (const Ring& ring : rings_of(polygons))
            corners.insert(corners.end(), ring.begin(), ring.end());
          const auto less = [](Point2 a, Point2 b) {
            return std::pair(a.x, a.y) < std::pair(b.x, b.y);
          };
          std::sort(corners.begin(), corners.end(), less);
          corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
          EXPECT_LE(corners.size(), static_cast<std::size_t>(sides * copies) + crossings(rings));
          expect_edges_meet_in_points_only(polygons);
          const bool is_filled = rule == FillRule::kNonZero || copies % 2 != 0;
          const double moved_mm2 = perimeter_mm(rings[0]) * 4 * (units + 1) / kGridUnitsPerMm;
          EXPECT_NEAR(area_mm2(polygons), is_filled ? signed_area_mm2(rings[0]) : 0, moved_mm2);
        }
      }
}

// How edges that meet are sought depends on how many there are: by a look at the boxes of all, by
// one at boxes of boxes first, by cells.
TEST(Overlay, DoesNotDependOnWhatElseThereIs) {
  for (const int sides : {3, 100, 700, 2000}) {
    SCOPED_TRACE("beside a disc of " + std::to_string(sides) + " sides");
    const Ring disc = test::star(1, sides, {200, 100}, 50, 50);
    const auto beside = [](Polygons polygons, const Polygons& other) {
      polygons.insert(polygons.end(), other.begin(), other.end());
      return polygons;
    };
    const Polygons far = polygons_from_rings({disc}, FillRule::kNonZero);
    std::mt19937_64 random(3);
    for (int round = 0; round < 40; ++round) {
      const std::vector<Ring> rings = lattice_rings(random, 1 + round % 5);
      std::vector<Ring> more = rings;
      more.push_back(disc);
      for (const FillRule rule : {FillRule::kNonZero, FillRule::kEvenOdd, FillRule::kPositive})
        EXPECT_EQ(polygons_from_rings(more, rule), beside(polygons_from_rings(rings, rule), far));
      const Polygons a = polygons_from_rings(rings, FillRule::kEvenOdd);
      const Polygons b = polygons_from_rings(lattice_rings(random, 3), FillRule::kEvenOdd);
      const Polygons far_a = beside(a, far), far_b = beside(b, far);
      EXPECT_EQ(unite(far_a, b), beside(unite(a, b), far));
      EXPECT_EQ(intersect(far_a, far_b), beside(intersect(a, b), far));
      EXPECT_EQ(subtract(far_a, b), beside(subtract(a, b), far));
      for (const double distance : {-0.9, -0.4, -0.1, 0.1, 0.4, 0.9})
        EXPECT_EQ(offset(far_a, distance), beside(offset(a, distance), offset(far, distance)))
            << "round " << round << ", by " << distance;
    }
    for (const int copies : {3, 6, 12}) {
      const std::vector<Ring> rings = nearly_equal_rings(12, copies, 8);
      std::vector<Ring> more = rings;
      more.push_back(disc);
      EXPECT_EQ(polygons_from_rings(more, FillRule::kEvenOdd),
                beside(polygons_from_rings(rings, FillRule::kEvenOdd), far));
    }
  }
}

// A few hundred sides may cross each other at tens of thousands of places.
TEST(Overlay, CombsThatCrossMakeAllTheirSquares) {
  const auto comb = [](int teeth, bool turned) {
    Ring ring = {{-1, -1}};
    for (int i = 0; i < teeth; ++i) {
      const double x = 2 * i;
      ring.insert(ring.end(), {{x, -1}, {x, 0}, {x, 1000}, {x + 1, 1000}, {x + 1, 0}, {x + 1, -1}});
    }
    const double end = 2 * teeth;
    ring.insert(ring.end(), {{end, -1}, {end, -2}, {-1, -2}});
    if (turned) {
      for (Point2& p : ring) p = {p.y, p.x};
      std::reverse(ring.begin(), ring.end());
    }
    return polygons_from_rings({ring}, FillRule::kNonZero);
  };
  for (const int teeth : {1, 5, 20, 60}) {
    const Polygons upright = comb(teeth, false), level = comb(teeth, true);
    const Polygons both = intersect(upright, level);
    const auto squares = std::count_if(both.begin(), both.end(), [](const Polygon& polygon) {
      return polygon == Polygon{test::rectangle(polygon.outer[0].x, polygon.outer[0].y,
                                                polygon.outer[0].x + 1, polygon.outer[0].y + 1),
                                {}};
    });
    EXPECT_EQ(squares, teeth * teeth);
    EXPECT_EQ(both.size(), static_cast<std::size_t>(teeth * teeth));
    EXPECT_DOUBLE_EQ(area_mm2(unite(upright, level)) + area_mm2(both),
                     area_mm2(upright) + area_mm2(level));
  }
}

// Beyond a metre from the origin another library takes over: both must agree. Up to there
// differences of coordinates need all of 32 bits.
TEST(Overlay, DoesNotDependOnThePlace) {
  const std::vector<Point2> places = {{980, -1010}, {1200, -1300}};
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Point2 far = places[seed % places.size()];
    const Polygons a = test::random_polygons(seed), b = test::random_polygons(seed + 50);
    const Polygons far_a = moved(a, far), far_b = moved(b, far);
    EXPECT_LT(difference_mm2(moved(unite(a, b), far), unite(far_a, far_b)), 1e-3);
    EXPECT_LT(difference_mm2(moved(intersect(a, b), far), intersect(far_a, far_b)), 1e-3);
    EXPECT_LT(difference_mm2(moved(subtract(a, b), far), subtract(far_a, far_b)), 1e-3);
    for (const double distance : {-2.0, -0.4, -0.05, 0.05, 0.4, 2.0}) {
      const Polygons near = offset(a, distance);
      // Both may be cleaned of 5 um, twice.
      EXPECT_LT(difference_mm2(moved(near, far), offset(far_a, distance)),
                0.01 * perimeter_mm(near) + 1e-3)
          << "seed " << seed << ", by " << distance;
    }
  }
}

// Sides shorter than the distance make loops at most corners; some are taken out before anything is
// cut. So are they where little is left, and where most of a ring is such a loop.
TEST(Overlay, OffsetsOfRoughOutlinesDoNotDependOnThePlace) {
  const Point2 far{1200, -1300};
  const auto expect_equal = [&](const Polygons& polygons, double distance) {
    const Polygons near = offset(polygons, distance),
                   there = offset(moved(polygons, far), distance);
    EXPECT_LT(difference_mm2(moved(near, far), there), 0.01 * perimeter_mm(near) + 1e-3)
        << "by " << distance;
  };
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const double rough = 0.1 * static_cast<double>(seed);
    const Polygons rim =
        polygons_from_rings({test::star(seed, 300, {10, 10}, 9 - rough, 9 + rough),
                             test::star(seed + 20, 200, {10, 10}, 5 - rough, 5 + rough)},
                            FillRule::kEvenOdd);
    const Polygons flower = polygons_from_rings(
        {test::star(seed, 24, {10, 10}, 9, 10), test::star(seed + 40, 12, {10, 10}, 1, 8)},
        FillRule::kEvenOdd);
    const Polygons sliver =
        polygons_from_rings({test::star(seed, 9, {10, 10}, 0.2, 5)}, FillRule::kNonZero);
    for (const Polygons& polygons : {rim, flower, sliver})
      for (const double distance : {-1.7, -0.9, -0.4, -0.1, 0.1, 0.4, 0.9, 1.7})
        expect_equal(polygons, distance);
  }
}

TEST(Overlay, TakesPartsAsLargeAsItsGrid) {
  // Edges from end to end: products of two differences need all of 64 bits.
  constexpr double kEnd = 1023.9;
  const Polygons diamond = {{{{0, -kEnd}, {kEnd, 0}, {0, kEnd}, {-kEnd, 0}}, {}}};
  const Polygons square = {{test::rectangle(-kEnd, -kEnd, kEnd, kEnd), {}}};
  const Polygons band = {
      {{{-kEnd, -kEnd}, {-kEnd + 1, -kEnd}, {kEnd, kEnd}, {kEnd - 1, kEnd}}, {}}};
  const double all = 4 * kEnd * kEnd;
  EXPECT_NEAR(area_mm2(intersect(square, diamond)), all / 2, 1e-6 * all);
  EXPECT_NEAR(area_mm2(subtract(square, diamond)), all / 2, 1e-6 * all);
  EXPECT_NEAR(area_mm2(unite(diamond, band)) + area_mm2(intersect(diamond, band)),
              area_mm2(diamond) + area_mm2(band), 1e-6 * all);
  const double step = 2, inner = 2 * (kEnd - step);
  EXPECT_NEAR(area_mm2(offset(square, -step)), inner * inner, 1e-6 * all);
}

TEST(Overlay, OffsetsOfFineCurvesKeepTheirDistance) {
  // Where cleaning asks of each point only whether it is near the line between its neighbours, one
  // after the other goes and the boundary creeps inwards by as much as one likes.
  constexpr double kCleanMm = 0.012;
  for (const double radius : {5.0, 256.0})
    for (const int points : {1000, 10000, 100000})
      for (const double step : {-0.5, -0.1, 0.1, 0.5}) {
        Ring ring;
        for (int i = 0; i < points; ++i) {
          const double angle = 2 * std::numbers::pi * i / points;
          ring.push_back(snap(radius * Point2{std::cos(angle), std::sin(angle)}));
        }
        const Polygons disc = polygons_from_rings({ring}, FillRule::kNonZero);
        const Polygons moved = offset(disc, step);
        ASSERT_EQ(moved.size(), 1u);
        const double chord = std::pow(std::numbers::pi / points, 2) * radius;  // twice its height
        for (const Point2 p : moved[0].outer)
          EXPECT_NEAR(distance(p, {0, 0}), radius + step, kCleanMm + chord)
              << radius << ", " << points;
        EXPECT_NEAR(area_mm2(moved), std::numbers::pi * std::pow(radius + step, 2),
                    2 * std::numbers::pi * radius * (kCleanMm + chord));
      }
}

TEST(Overlay, OffsetsKeepTheirDistance) {
  constexpr double kCleanMm = 0.012;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Polygons a = test::random_polygons(seed);
    const std::vector<Ring> rings = rings_of(a);
    const auto distance_to_edge = [&](Point2 p) {
      double nearest = 1e9;
      for (const Ring& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i)
          nearest = std::min(
              nearest, distance(p, nearest_on_segment(p, ring[i], ring[(i + 1) % ring.size()])));
      return nearest;
    };
    for (const double step : {0.2, 0.8}) {
      const Polygons shrunk = offset(a, -step), grown = offset(a, step);
      expect_edges_meet_in_points_only(shrunk);
      expect_edges_meet_in_points_only(grown);
      for (double x = -4; x < 34; x += 0.77)
        for (double y = -4; y < 34; y += 0.83) {
          const Point2 p{x, y};
          const double to_edge = distance_to_edge(p);
          if (holds(a, p)) {
            if (to_edge < step - kCleanMm) {
              EXPECT_FALSE(holds(shrunk, p));
            }
            // Corners that point inwards keep a mitre, at most twice as far.
            if (to_edge > 2 * step + kCleanMm) {
              EXPECT_TRUE(holds(shrunk, p));
            }
            EXPECT_TRUE(holds(grown, p) || to_edge < kCleanMm);
          } else {
            EXPECT_FALSE(holds(shrunk, p) && to_edge > kCleanMm);
            if (to_edge < step - kCleanMm) {
              EXPECT_TRUE(holds(grown, p));
            }
            if (to_edge > 2 * step + kCleanMm) {
              EXPECT_FALSE(holds(grown, p));
            }
          }
        }
    }
  }
}

}  // namespace
}  // namespace routebench
