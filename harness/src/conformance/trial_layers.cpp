#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "routebench/geometry/grid.hpp"
#include "routebench/harness/conformance.hpp"

namespace routebench {
namespace {

Ring rectangle(double x0, double y0, double x1, double y1) {
  return {snap(Point2{x0, y0}), snap(Point2{x1, y0}), snap(Point2{x1, y1}), snap(Point2{x0, y1})};
}

Ring reversed(const Ring& ring) { return {ring.rbegin(), ring.rend()}; }

/// A ring whose distance from its centre is a function of the angle.
template <typename Radius>
Ring round_ring(Point2 centre, int corners, Radius radius_mm) {
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, r = radius_mm(i, angle);
    ring.push_back(snap(Point2{centre.x + r * std::cos(angle), centre.y + r * std::sin(angle)}));
  }
  return ring;
}

Ring circle(Point2 centre, double radius_mm, int corners) {
  return round_ring(centre, corners, [radius_mm](int, double) { return radius_mm; });
}

/// Teeth of irregular length all round.
Ring saw() {
  return round_ring({12, 12}, 90, [](int i, double) { return 8 + 4.0 * ((37 * i) % 90) / 90; });
}

/// Teeth 1 mm wide and 10 mm long, 1 mm apart.
Polygons comb(int teeth) {
  Ring ring{{0, 0}, {2.0 * teeth, 0}};
  for (int tooth = teeth - 1; tooth >= 0; --tooth) {
    const double left = 2.0 * tooth;
    ring.insert(ring.end(), {{left + 2, 2}, {left + 1, 2}, {left + 1, 12}, {left, 12}});
  }
  return {{ring, {}}};
}

Polygons thousand_islands() {
  Polygons islands;
  for (int i = 0; i < 1000; ++i) {
    const double x = 2.0 * (i % 40), y = 2.0 * (i / 40);
    islands.push_back({rectangle(x, y, x + 1.2, y + 1.2), {}});
  }
  return islands;
}

/// A wavy outline with a wavy hole, as a scanned figure has.
Polygons blob() {
  const auto wave = [](double radius, double phase) {
    return round_ring({20, 20}, 300, [=](int, double t) {
      return radius * (1 + 0.2 * std::sin(3 * t + phase) + 0.05 * std::sin(17 * t));
    });
  };
  return {{wave(15, 0), {reversed(wave(6, 1))}}};
}

/// Two squares joined by a bridge as wide as a line.
Polygons dumbbell() {
  return {{{{0, 0},
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
           {}}};
}

}  // namespace

std::vector<TrialLayer> trial_layers() {
  std::vector<TrialLayer> layers;
  const auto add = [&](std::string name, Polygons polygons, bool roomy = false) {
    Layer layer;
    layer.index = static_cast<int>(layers.size());
    layer.z_mm = 0.1 + 0.2 * layer.index;
    layer.height_mm = 0.2;
    layer.polygons = std::move(polygons);
    layers.push_back({std::move(name), std::move(layer), roomy});
  };
  constexpr bool kRoomy = true;
  const Ring square = rectangle(0, 0, 10, 10);
  add("empty", {});
  add("speck", {{rectangle(0, 0, 0.05, 0.05), {}}});
  add("thinner_than_a_line", {{rectangle(0, 0, 20, 0.3), {}}});
  add("just_a_line_wide", {{rectangle(0, 0, 20, 0.46), {}}});
  add("square", {{square, {}}}, kRoomy);
  add("ring", {{circle({10, 10}, 10, 64), {reversed(circle({10, 10}, 5, 64))}}}, kRoomy);
  add("comb", comb(8));
  add("dumbbell", dumbbell());
  add("two_islands", {{square, {}}, {rectangle(12, 3, 17, 8), {}}}, kRoomy);
  add("island_in_a_hole", {{rectangle(0, 0, 14, 14), {reversed(rectangle(2, 2, 12, 12))}},
                           {rectangle(5, 5, 9, 9), {}}});
  add("hole_touches_wall", {{square, {{{10, 5}, {5, 3}, {5, 7}}}}});
  add("touching_points", {{rectangle(0, 0, 5, 5), {}}, {rectangle(5, 5, 10, 10), {}}});
  add("repeated_points",
      {{{{0, 0}, {0, 0}, {5, 0}, {10, 0}, {10, 10}, {10, 10}, {10, 10}, {0, 10}, {0, 5}, {0, 5}},
        {}}});
  add("thousand_gon", {{circle({15, 15}, 15, 1000), {}}}, kRoomy);
  add("needle", {{{{0, 0}, {40, 0.3}, {0, 0.6}}, {}}});
  add("saw", {{saw(), {}}});
  add("thousand_islands", thousand_islands());
  add("blob", blob(), kRoomy);
  return layers;
}

}  // namespace routebench
