/// Fill by Euler circuits: each connected part of a region in one closed stroke.

#include <utility>
#include <vector>

#include "eulerian/entries.hpp"
#include "eulerian/lattice.hpp"
#include "eulerian/tree_coverage.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

enum class Prefer { kStraight, kFirst };

struct EulerianParams {
  Prefer prefer = Prefer::kStraight;

  void bind(ParamBinder& bind) {
    bind("prefer", prefer, {{"straight", Prefer::kStraight}, {"first", Prefer::kFirst}}, "");
  }
};

class Eulerian final : public Planner {
 public:
  using Params = EulerianParams;

  static PlannerInfo info() {
    return {"eulerian", PlannerRole::kFill, "one closed stroke over each connected part",
            "S. Lei, 2015"};
  }

  explicit Eulerian(const Params& params) : params_(params) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    std::vector<Stroke> strokes;
    for (const Polygon& region : offset(frame.polygons(), -context.line_width_mm / 2)) {
      stop_if_asked(context);
      lay_tree(region, layer.index, context, strokes);
    }
    return frame.from_frame(
        {eulerian::nearest_entry_first(std::move(strokes), frame.start(), context)});
  }

 private:
  void lay_tree(const Polygon& region, int layer_index, const PlanContext& context,
                std::vector<Stroke>& strokes) const {
    const eulerian::Lattice lattice(
        region, {context.line_distance_mm(), context.line_width_mm / context.density,
                 context.line_width_mm / 2, context.density >= 1});
    const eulerian::TreeOrder order = params_.prefer == Prefer::kFirst ? eulerian::TreeOrder::kFirst
                                      : layer_index % 2 == 0           ? eulerian::TreeOrder::kRows
                                                             : eulerian::TreeOrder::kColumns;
    eulerian::TreeStrokes tree = eulerian::cover_by_tree(lattice, order, context);
    const auto lay = [&](std::vector<Point2> points) {
      strokes.push_back({std::move(points), context.line_width_mm});
    };
    if (tree.loops.empty() && tree.lines.empty() && context.density >= 1) {
      std::vector<Point2> outline = region.outer;
      outline.push_back(outline.front());
      lay(std::move(outline));
      return;
    }
    for (std::vector<Point2>& loop : tree.loops) lay(std::move(loop));
    for (std::vector<Point2>& line : tree.lines) lay(std::move(line));
  }

  EulerianParams params_;
};

}  // namespace

ROUTEBENCH_REGISTER(eulerian) { registry.add<Eulerian>(); }
