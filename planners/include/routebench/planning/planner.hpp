#pragma once
/// What a planner is: one const call from a layer to a route.

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Material laid along a polyline without a stop. A closed loop repeats its first point.
struct Stroke {
  std::vector<Point2> points;  ///< at least two; consecutive points differ
  double width_mm = 0;
  friend bool operator==(const Stroke&, const Stroke&) = default;
};

/// The strokes of a layer in the order in which they are laid. The gap between two strokes is
/// travel; it is never stored.
struct Route {
  std::vector<Stroke> strokes;
  friend bool operator==(const Route&, const Route&) = default;
};

/// What the task demands of every planner alike.
struct PlanContext {
  Point2 start;   ///< where the nozzle is when the route begins
  Point2 origin;  ///< lower corner of the model: patterns are anchored here, so that they meet from
                  ///< layer to layer
  double line_width_mm = 0.45;
  double spacing_mm = 0.4;  ///< between the centres of neighbouring lines at density 1
  double density = 1;       ///< share of the area to be filled, (0, 1]
  int perimeters = 2;       ///< walls to lay (shell planners)
  std::uint64_t seed = 1;   ///< for planners that draw lots
  std::stop_token stop;     ///< asked between units of work; see stop_if_asked

  /// Between the centres of neighbouring lines at `density`.
  [[nodiscard]] double line_distance_mm() const noexcept { return spacing_mm / density; }
};

/// Throws Error{kStopped} if the caller wants no more of it. Call it at least once every few
/// milliseconds.
void stop_if_asked(const PlanContext& context);

/// A route planner. Constructed from validated parameters; plan() neither changes it nor anything
/// else.
class Planner {
 public:
  virtual ~Planner();

  /// Plans the route of one layer (or of one region of a layer).
  ///
  /// Takes   a layer whose polygons are valid (see types.hpp); it may have none. A shell planner
  /// gets what is to be
  ///         walled; a fill planner gets what the walls leave.
  /// Returns strokes whose beads stay inside the polygons; empty for an empty layer. Equal
  /// arguments give an equal
  ///         route, on any thread, in any order. Coordinates lie on the grid.
  /// Throws  Error{kStopped} when asked to stop.
  [[nodiscard]] virtual Route plan(const Layer& layer, const PlanContext& context) const = 0;
};

}  // namespace routebench
