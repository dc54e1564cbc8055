/// @NAME@: rings inside one another. Put your own idea into plan(); the rest can stay.

#include <utility>
#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/ordering.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/walls.hpp"

namespace {

using namespace routebench;

class @CLASS@ final : public Planner {
 public:
  /// Each parameter is bound in one line: configs, --set, help and the record come from that.
  struct Params {
    double pitch = 1;
    void bind(ParamBinder& bind) {
      bind("pitch", pitch, {0.5, 2}, "line distances", "between one ring and the next");
    }
  };

  static PlannerInfo info() {
    return {"@NAME@", PlannerRole::kFill, "rings inside one another", "your name, year"};
  }

  explicit @CLASS@(const Params& params) : params_(params) {}

  /// Equal arguments must give an equal route, beads must stay inside the layer's polygons, and
  /// stop_if_asked must be called every few milliseconds. `routebench check-planner` tells.
  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);  // makes the route move with the model
    std::vector<Stroke> strokes;
    Polygons region = offset(frame.polygons(), -context.line_width_mm / 2);
    while (!region.empty()) {
      stop_if_asked(context);
      for (Ring& ring : rings_of(region)) {
        ring.push_back(ring.front());  // a loop repeats its first point
        strokes.push_back({std::move(ring), context.line_width_mm});
      }
      region = offset(region, -params_.pitch * context.line_distance_mm());
    }
    return frame.from_frame({nearest_first(std::move(strokes), frame.start(), context)});
  }

 private:
  Params params_;
};

}  // namespace

ROUTEBENCH_REGISTER(@NAME@) { registry.add<@CLASS@>(); }
