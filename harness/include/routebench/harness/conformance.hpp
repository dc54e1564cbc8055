#pragma once
/// Whether a planner keeps what planner.hpp promises, shown on layers where planners fail.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/params.hpp"
#include "routebench/planning/planner.hpp"
#include "routebench/planning/registry.hpp"

namespace routebench {

/// A layer to try planners on.
struct TrialLayer {
  std::string name;
  Layer layer;
  bool roomy = false;  ///< nowhere too narrow for a few lines: a planner should do its task there
};

/// Degenerate, thin, touching and many polygons, and a few that ask for nothing special. Lower
/// corners lie near the origin; all are valid in the sense of types.hpp, but for repeated points in
/// one of them.
[[nodiscard]] std::vector<TrialLayer> trial_layers();

/// How a planner broke a promise.
struct Breach {
  std::string params;     ///< "angle_deg=45 link=none", or "defaults"
  std::string complaint;  ///< what was seen
  Route route;            ///< where it can be seen, if it can
};

/// One promise.
struct ConformanceCheck {
  std::string name;     ///< "inside"
  std::string promise;  ///< "centre lines stay inside the polygons"
  /// The first breach found on a layer; nothing if there is none. What the planner throws passes.
  std::function<std::optional<Breach>(const Registry& registry, const std::string& planner,
                                      const TrialLayer& layer)>
      breach;
};

/// All promises. Those of defaults alone are looked at with default parameters, the others at the
/// corners of the parameters' ranges too.
[[nodiscard]] const std::vector<ConformanceCheck>& conformance_checks();

}  // namespace routebench
