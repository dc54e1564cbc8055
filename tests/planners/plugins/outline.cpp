/// The least planner that does something: every outer ring as one closed stroke. Its centre line is
/// on the wall, so it is no planner to print with.

#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

class Outline final : public Planner {
 public:
  struct Params {
    bool holes = false;
    void bind(ParamBinder& bind) { bind("holes", holes, "lay the holes too"); }
  };

  static PlannerInfo info() {
    return {"outline", PlannerRole::kShell, "outer rings as they are", ""};
  }

  explicit Outline(const Params& params) : params_(params) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    Route route;
    for (const Polygon& polygon : layer.polygons) {
      stop_if_asked(context);
      add(route, polygon.outer, context);
      if (!params_.holes) continue;
      for (const Ring& hole : polygon.holes) add(route, hole, context);
    }
    return route;
  }

 private:
  static void add(Route& route, const Ring& ring, const PlanContext& context) {
    Stroke stroke{ring, context.line_width_mm};
    stroke.points.push_back(ring.front());
    route.strokes.push_back(std::move(stroke));
  }

  Params params_;
};

}  // namespace

ROUTEBENCH_REGISTER(outline) { registry.add<Outline>(); }
