#pragma once
/// Planning in tests: contexts whose figures can be computed by hand, and simple measures of
/// routes.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "polygons.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/edge_grid.hpp"
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
