#pragma once
/// Planning in tests: contexts whose figures can be computed by hand, and simple measures of
/// routes.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "polygons.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/conformance.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/ring_path.hpp"

namespace routebench::test {

inline constexpr double kWidth = 0.5;
inline constexpr double kSpacing = 0.4375;  // a multiple of 1/16, so that sums are exact

inline PlanContext context_for(int perimeters, double density) {
  PlanContext context;
  context.line_width_mm = kWidth;
  context.spacing_mm = kSpacing;
  context.perimeters = perimeters;
  context.density = density;
  return context;
}

inline Layer layer_of(Polygons polygons, int index = 0) {
  Layer layer;
  layer.index = index;
  layer.polygons = std::move(polygons);
  return layer;
}

inline Route plan(const std::string& planner, const Layer& layer, const PlanContext& context,
                  const ParamSet& params = {}) {
  Registry registry;
  register_builtin_planners(registry);
  return registry.at(planner).make(params)->plan(layer, context);
}

/// A choice as a parameter's value.
inline ParamValue word(const char* text) { return std::string(text); }

inline double length_mm(const Route& route) {
  double sum = 0;
  for (const Stroke& stroke : route.strokes) sum += routebench::length_mm(stroke.points);
  return sum;
}

/// A wavy outline with a wavy hole, as a scanned figure has.
inline Polygons blob() {
  for (TrialLayer& trial : routebench::trial_layers())
    if (trial.name == "blob") return std::move(trial.layer.polygons);
  throw std::logic_error("there is no trial layer of that name");
}

/// Layers on which two ways of planning are compared.
inline std::vector<Layer> trial_layers() {
  std::vector<Layer> layers;
  for (TrialLayer& trial : routebench::trial_layers())
    if (trial.name != "thousand_islands") layers.push_back(std::move(trial.layer));
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    layers.push_back(layer_of(random_polygons(seed), static_cast<int>(seed)));
  return layers;
}

/// An ellipse round a centre, its first axis at an angle.
inline Polygons ellipse(Point2 centre, double long_mm, double wide_mm, double angle_rad) {
  const Point2 along{std::cos(angle_rad), std::sin(angle_rad)}, up{-along.y, along.x};
  Ring ring = circle({0, 0}, 1, 60);
  for (Point2& p : ring) p = snap(centre + (long_mm / 2 * p.x) * along + (wide_mm / 2 * p.y) * up);
  return {{ring, {}}};
}

/// Area of the largest straight bead inside a convex polygon: all pairs of points of a lattice are
/// tried as its ends, and the best pair is moved about as long as that helps. The distance to a
/// convex boundary is concave, so a bead that fits at both ends fits between them.
inline double largest_bead_mm2(const Polygons& convex, double widest_mm) {
  const EdgeGrid edges(convex);
  const Box2 box = bounding_box(convex);
  const auto width_at = [&](Point2 p) {
    if (!edges.contains(p)) return 0.0;
    return 2 * edges.distance_to_edge_mm(p, widest_mm / 2).value_or(widest_mm / 2);
  };
  const auto area = [](Point2 a, double width_a, Point2 b, double width_b) {
    const double width_mm = std::min(width_a, width_b);
    return width_mm * (distance(a, b) + std::numbers::pi / 4 * width_mm);
  };
  constexpr int kSide = 32;
  std::vector<std::pair<Point2, double>> places;
  for (int i = 0; i <= kSide; ++i)
    for (int k = 0; k <= kSide; ++k) {
      const Point2 p{std::lerp(box.lower.x, box.upper.x, 1.0 * i / kSide),
                     std::lerp(box.lower.y, box.upper.y, 1.0 * k / kSide)};
      if (const double width_mm = width_at(p); width_mm > 0) places.emplace_back(p, width_mm);
    }
  double largest = 0;
  std::array<Point2, 2> ends;
  for (const auto& [a, width_a] : places)
    for (const auto& [b, width_b] : places)
      if (const double mm2 = area(a, width_a, b, width_b); mm2 > largest) {
        largest = mm2;
        ends = {a, b};
      }
  std::mt19937_64 random(1);
  std::normal_distribution<double> step;
  double reach_mm = distance(box.lower, box.upper) / kSide;
  for (int i = 0; i < 4000; ++i, reach_mm *= 0.998) {
    std::array<Point2, 2> moved = ends;
    for (Point2& p : moved) p = p + reach_mm * Point2{step(random), step(random)};
    const double mm2 = area(moved[0], width_at(moved[0]), moved[1], width_at(moved[1]));
    if (mm2 <= largest) continue;
    largest = mm2;
    ends = moved;
  }
  return largest;
}

/// Share of the polygons' area that lies under beads, by looking at the points of a turned lattice.
inline double share_under_beads(const Polygons& polygons, const Route& route,
                                double pitch_mm = 0.11) {
  const EdgeGrid edges(polygons);
  const Box2 box = bounding_box(polygons);
  const Point2 centre = lerp(box.lower, box.upper, 0.5);
  const int half = static_cast<int>(distance(box.lower, box.upper) / 2 / pitch_mm) + 1;
  const int side = 2 * half + 1;
  const Point2 across{std::cos(0.3), std::sin(0.3)}, up{-across.y, across.x};
  const auto place = [&](int i, int k) {
    return centre +
           pitch_mm * (static_cast<double>(i - half) * across + static_cast<double>(k - half) * up);
  };
  const auto index = [&](double mm) {
    return std::clamp(static_cast<int>(std::floor(mm / pitch_mm)) + half, 0, side - 1);
  };
  std::vector<bool> covered(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), false);
  const auto at = [&](int i, int k) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(side) +
           static_cast<std::size_t>(k);
  };
  for (const Stroke& stroke : route.strokes)
    for (std::size_t s = 1; s < stroke.points.size(); ++s) {
      const Point2 a = stroke.points[s - 1], b = stroke.points[s];
      const double r = stroke.width_mm / 2;
      const double ax = dot(a - centre, across), bx = dot(b - centre, across);
      const double ay = dot(a - centre, up), by = dot(b - centre, up);
      const int right = index(std::max(ax, bx) + r) + 1, top = index(std::max(ay, by) + r) + 1;
      for (int i = index(std::min(ax, bx) - r); i < std::min(right + 1, side); ++i)
        for (int k = index(std::min(ay, by) - r); k < std::min(top + 1, side); ++k) {
          const Point2 p = place(i, k);
          if (squared_distance(p, nearest_on_segment(p, a, b)) <= r * r) covered[at(i, k)] = true;
        }
    }
  std::size_t inside = 0, reached = 0;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k) {
      if (!edges.contains(place(i, k))) continue;
      ++inside;
      if (covered[at(i, k)]) ++reached;
    }
  return static_cast<double>(reached) / static_cast<double>(inside);
}

}  // namespace routebench::test
