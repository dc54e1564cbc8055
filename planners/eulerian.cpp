/// Fill by Euler circuits: each connected part of a region in one closed stroke.

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "eulerian/cell_graph.hpp"
#include "eulerian/entries.hpp"
#include "eulerian/lattice.hpp"
#include "eulerian/trails.hpp"
#include "eulerian/tree_coverage.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/walls.hpp"

namespace {

using namespace routebench;
using eulerian::Jump;
using eulerian::Pairing;

enum class Variant { kDefault, kPublished };
enum class Graph { kTree, kMixed, kGrid };
enum class Cells { kUniform, kQuadtree };
enum class Thin { kFill, kDrop };
enum class Prefer { kStraight, kFirst };

struct EulerianParams {
  Variant variant = Variant::kDefault;
  Graph graph = Graph::kTree;
  Cells cells = Cells::kUniform;
  Pairing pairing = Pairing::kMatching;
  Jump jump = Jump::kTravel;
  double max_jump = 3;
  Prefer prefer = Prefer::kStraight;
  Thin thin = Thin::kFill;

  void bind(ParamBinder& bind) {
    bind("variant", variant, {{"default", Variant::kDefault}, {"published", Variant::kPublished}},
         "published stands for cells = quadtree, pairing = greedy, jump = extrude, prefer = first, "
         "whatever these say, with cells of a line's width over all that the outline touches, at "
         "any density: lays twice what is demanded, and leaves the region");
    bind("graph", graph, {{"tree", Graph::kTree}, {"mixed", Graph::kMixed}, {"grid", Graph::kGrid}},
         "tree leads the stroke round a spanning tree, once over everything; grid walks every edge "
         "between neighbouring cells, which leaves holes at density 1; mixed: tree where it is "
         "dense");
    bind("cells", cells, {{"uniform", Cells::kUniform}, {"quadtree", Cells::kQuadtree}},
         "quadtree, always a grid, has small cells at the outline only: dense rim, sparse centre");
    bind("pairing", pairing, {{"greedy", Pairing::kGreedy}, {"matching", Pairing::kMatching}},
         "how odd nodes of a grid are joined: each to its nearest, or with the least sum");
    bind("jump", jump,
         {{"travel", Jump::kTravel}, {"reroute", Jump::kReroute}, {"extrude", Jump::kExtrude}},
         "how a grid's circuit gets from one odd node to the other: by travel; extruding on the "
         "shortest way inside; extruding straight, as published: also across hollows");
    bind("max_jump", max_jump, {0, 1000}, "line distances", "longest jump that is rerouted");
    bind("prefer", prefer, {{"straight", Prefer::kStraight}, {"first", Prefer::kFirst}},
         "run straight on where that can be, or take the first edge that is free");
    bind("thin", thin, {{"fill", Thin::kFill}, {"drop", Thin::kDrop}},
         "at density 1, parts narrower than a line: one of their own width along the middle, or "
         "nothing");
  }
};

/// The parameters for which a published variant stands.
EulerianParams resolved(EulerianParams params) {
  if (params.variant == Variant::kPublished) {
    params.cells = Cells::kQuadtree;
    params.pairing = Pairing::kGreedy;
    params.jump = Jump::kExtrude;
    params.prefer = Prefer::kFirst;
  }
  return params;
}

class Eulerian final : public Planner {
 public:
  using Params = EulerianParams;

  static PlannerInfo info() {
    return {"eulerian",
            PlannerRole::kFill,
            "Euler circuits: each connected part in one closed stroke",
            "S. Lei, 2015",
            {{"jump", "extrude"}, {"variant", "published"}},
            2};
  }

  explicit Eulerian(const Params& params) : params_(resolved(params)) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    stop_if_asked(context);
    const Frame frame(layer, context);
    std::vector<Stroke> strokes;
    const auto lay = [&](std::vector<std::vector<Point2>> polylines) {
      for (std::vector<Point2>& points : polylines)
        strokes.push_back({std::move(points), context.line_width_mm});
    };
    if (params_.variant == Variant::kPublished) {
      lay(walk(eulerian::leaf_graph(frame.polygons(), context.line_width_mm,
                                    eulerian::LeafRule::kShape, context),
               frame.polygons(), context));
    } else {
      const Polygons regions = offset(frame.polygons(), -context.line_width_mm / 2);
      for (const Polygon& region : regions) {
        stop_if_asked(context);
        if (takes_tree(context))
          lay(round_tree(region, layer.index, context));
        else
          lay(over_grid(region, context));
      }
      if (params_.thin == Thin::kFill && context.density >= 1)
        for (Stroke& stroke :
             gap_lines(frame.polygons(), {regions}, 1, context.line_width_mm, context))
          strokes.push_back(std::move(stroke));
    }
    return frame.from_frame(
        {eulerian::nearest_entry_first(std::move(strokes), frame.start(), context)});
  }

 private:
  using Polylines = std::vector<std::vector<Point2>>;

  [[nodiscard]] bool takes_tree(const PlanContext& context) const {
    if (params_.cells == Cells::kQuadtree || params_.graph == Graph::kGrid) return false;
    return params_.graph == Graph::kTree || context.density >= 1;
  }

  [[nodiscard]] Polylines round_tree(const Polygon& region, int layer_index,
                                     const PlanContext& context) const {
    using eulerian::TreeOrder;
    const bool dense = context.density >= 1;
    const eulerian::Lattice lattice(
        region, {context.line_distance_mm(), context.line_width_mm / context.density,
                 context.line_width_mm / 2, dense});
    const TreeOrder order = params_.prefer == Prefer::kFirst ? TreeOrder::kFirst
                            : layer_index % 2 == 0           ? TreeOrder::kRows
                                                             : TreeOrder::kColumns;
    auto [all, lines] = eulerian::cover_by_tree(lattice, order, context);
    std::move(lines.begin(), lines.end(), std::back_inserter(all));
    if (all.empty() && dense) {
      // Too small for two nodes: once round.
      all.push_back(region.outer);
      all.back().push_back(region.outer.front());
    }
    return all;
  }

  [[nodiscard]] Polylines over_grid(const Polygon& region, const PlanContext& context) const {
    // Two directions share the density.
    const double pitch_mm = 2 * context.line_distance_mm();
    if (params_.cells == Cells::kQuadtree)
      return walk(eulerian::leaf_graph({region}, pitch_mm, eulerian::LeafRule::kInside, context),
                  {region}, context);
    return walk(eulerian::square_graph(region, pitch_mm, context.line_width_mm), {region}, context);
  }

  [[nodiscard]] Polylines walk(const eulerian::PlacedGraph& graph, const Polygons& region,
                               const PlanContext& context) const {
    return eulerian::walk_trails(
        graph, region,
        {params_.pairing, params_.jump, params_.prefer == Prefer::kStraight,
         params_.max_jump * context.line_distance_mm()},
        context);
  }

  EulerianParams params_;
};

}  // namespace

ROUTEBENCH_REGISTER(eulerian) { registry.add<Eulerian>(); }
