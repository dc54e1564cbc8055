#pragma once
/// Layers on which planners fail: degenerate, thin, touching, many.

#include <cmath>
#include <numbers>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "random_polygons.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::test {

struct NastyLayer {
  std::string name;
  Layer layer;
};

inline void PrintTo(const NastyLayer& layer, std::ostream* out) { *out << layer.name; }

/// The same ring, the other way round: a hole.
inline Ring reversed(Ring ring) { return {ring.rbegin(), ring.rend()}; }

/// Regular polygon, counter-clockwise.
inline Ring circle(Point2 centre, double radius_mm, int corners) {
  return star(0, corners, centre, radius_mm, std::nextafter(radius_mm, 2 * radius_mm));
}

/// Teeth 1 mm wide and 10 mm long, 1 mm apart.
inline Polygons comb(int teeth) {
  Ring ring{{0, 0}, {2.0 * teeth, 0}};
  for (int tooth = teeth - 1; tooth >= 0; --tooth) {
    const double left = 2.0 * tooth;
    ring.insert(ring.end(), {{left + 2, 2}, {left + 1, 2}, {left + 1, 12}, {left, 12}});
  }
  return {{ring, {}}};
}

inline Polygons thousand_islands() {
  Polygons islands;
  for (int i = 0; i < 1000; ++i) {
    const double x = 2.0 * (i % 40), y = 2.0 * (i / 40);
    islands.push_back({rectangle(x, y, x + 1.2, y + 1.2), {}});
  }
  return islands;
}

/// A wavy outline with a wavy hole, as a scanned figure has.
inline Polygons blob() {
  const auto wave = [](double radius, double phase) {
    Ring ring;
    for (int i = 0; i < 300; ++i) {
      const double t = 2 * std::numbers::pi * i / 300;
      const double r = radius * (1 + 0.2 * std::sin(3 * t + phase) + 0.05 * std::sin(17 * t));
      ring.push_back(snap(Point2{20 + r * std::cos(t), 20 + r * std::sin(t)}));
    }
    return ring;
  };
  return {{wave(15, 0), {reversed(wave(6, 1))}}};
}

/// Layers with their lower corner near the origin. Valid in the sense of types.hpp, but for
/// repeated points in one of them.
inline std::vector<NastyLayer> nasty_layers() {
  std::vector<NastyLayer> layers;
  const auto add = [&](std::string name, Polygons polygons) {
    Layer layer;
    layer.index = static_cast<int>(layers.size());
    layer.z_mm = 0.1 + 0.2 * layer.index;
    layer.height_mm = 0.2;
    layer.polygons = std::move(polygons);
    layers.push_back({std::move(name), std::move(layer)});
  };
  const Ring square = rectangle(0, 0, 10, 10);
  add("empty", {});
  add("speck", {{rectangle(0, 0, 0.05, 0.05), {}}});
  add("thinner_than_a_line", {{rectangle(0, 0, 20, 0.3), {}}});
  add("just_a_line_wide", {{rectangle(0, 0, 20, 0.46), {}}});
  add("square", {{square, {}}});
  add("ring", {{circle({10, 10}, 10, 64), {reversed(circle({10, 10}, 6, 64))}}});
  add("comb", comb(8));
  add("dumbbell", {{{{0, 0},
                     {5, 0},
                     {5, 2.25},
                     {9, 2.25},
                     {9, 0},
                     {14, 0},
                     {14, 5},
                     {9, 5},
                     {9, 2.75},
                     {5, 2.75},
                     {5, 5},
                     {0, 5}},
                    {}}});
  add("two_islands", {{square, {}}, {rectangle(12, 3, 17, 8), {}}});
  add("island_in_a_hole", {{rectangle(0, 0, 14, 14), {reversed(rectangle(2, 2, 12, 12))}},
                           {rectangle(5, 5, 9, 9), {}}});
  add("hole_touches_wall", {{square, {{{10, 5}, {5, 3}, {5, 7}}}}});
  add("touching_points", {{rectangle(0, 0, 5, 5), {}}, {rectangle(5, 5, 10, 10), {}}});
  add("repeated_points",
      {{{{0, 0}, {0, 0}, {5, 0}, {10, 0}, {10, 10}, {10, 10}, {10, 10}, {0, 10}, {0, 5}, {0, 5}},
        {}}});
  add("thousand_gon", {{circle({15, 15}, 15, 1000), {}}});
  add("needle", {{{{0, 0}, {40, 0.3}, {0, 0.6}}, {}}});
  add("saw", {{star(7, 90, {12, 12}, 8, 12), {}}});
  add("thousand_islands", thousand_islands());
  add("blob", blob());
  return layers;
}

}  // namespace routebench::test
