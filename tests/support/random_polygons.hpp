#pragma once
/// Polygons for tests of geometry: random, seeded, on the grid.

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::test {

/// Axis-parallel rectangle, counter-clockwise.
inline Ring rectangle(double x0, double y0, double x1, double y1) {
  return {snap(Point2{x0, y0}), snap(Point2{x1, y0}), snap(Point2{x1, y1}), snap(Point2{x0, y1})};
}

/// Star-shaped ring with `points` corners whose distances from the centre are drawn from [inner,
/// outer].
inline Ring star(std::uint64_t seed, int points, Point2 centre, double inner, double outer) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> radius(inner, outer);
  Ring ring;
  for (int i = 0; i < points; ++i) {
    const double angle = 2 * std::numbers::pi * i / points, r = radius(random);
    ring.push_back(snap(Point2{centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)}));
  }
  return ring;
}

/// Several overlapping stars made into disjoint polygons, usually with holes.
inline Polygons random_polygons(std::uint64_t seed, int stars = 6, double size_mm = 30) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0, size_mm);
  std::vector<Ring> rings;
  for (int i = 0; i < stars; ++i)
    rings.push_back(
        star(random(), 24, {place(random), place(random)}, 0.1 * size_mm, 0.3 * size_mm));
  return polygons_from_rings(rings, FillRule::kEvenOdd);
}

}  // namespace routebench::test
