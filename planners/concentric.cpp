/// Fill by loops inside loops.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "concentric/loops.hpp"
#include "concentric/pockets.hpp"
#include "concentric/rings.hpp"
#include "concentric/tree_link.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/nearest_grid.hpp"
#include "routebench/planning/ordering.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/seam.hpp"

namespace {

using namespace routebench;
using namespace routebench::concentric;

enum class Variant { kDefault, kPublished };
enum class Order { kInsideOut, kOutsideIn };
enum class Link { kNone, kTree, kSpiral };
enum class Thin { kFill, kDrop };

struct ConcentricParams {
  Variant variant = Variant::kDefault;
  Method method = Method::kClipper;
  Order order = Order::kOutsideIn;
  Link link = Link::kTree;
  SeamParams seam;
  Thin thin = Thin::kFill;
  double min_gap = 1.0 / 3;

  void bind(ParamBinder& bind) {
    bind("variant", variant, {{"default", Variant::kDefault}, {"published", Variant::kPublished}},
         "published: loops and nothing else, that is link none, order outside_in, thin drop, "
         "whatever else is given for these");
    bind("method", method, {{"clipper", Method::kClipper}, {"skeleton", Method::kSkeleton}},
         "how loops are found: each from the one before, or all from a straight skeleton of the "
         "first");
    bind("order", order, {{"inside_out", Order::kInsideOut}, {"outside_in", Order::kOutsideIn}},
         "of the loops of a branch; a branch is finished before the next");
    bind("link", link, {{"none", Link::kNone}, {"tree", Link::kTree}, {"spiral", Link::kSpiral}},
         "tree joins loops by short steps, so that what hangs together is one stroke; spiral makes "
         "one of loops that do not fork");
    seam.bind(bind);
    bind("thin", thin, {{"fill", Thin::kFill}, {"drop", Thin::kDrop}},
         "where the two sides of a loop come nearer than a spacing, and in gaps at density 1: one "
         "line in the middle, as wide as the place; or both sides and open gaps");
    bind("min_gap", min_gap, {0.1, 1}, "line widths", "narrower gaps get no line in the middle");
  }
};

ConcentricParams resolved(ConcentricParams params) {
  if (params.variant == Variant::kDefault) return params;
  params.link = Link::kNone;
  params.order = Order::kOutsideIn;
  params.thin = Thin::kDrop;
  return params;
}

/// Hands out the roots of a forest, always the one with the vertex nearest to the nozzle.
class NearestRoot {
 public:
  explicit NearestRoot(const LoopForest& forest) {
    std::vector<Point2> points;
    begin_.resize(forest.loops.size(), 0);
    end_.resize(forest.loops.size(), 0);
    for (const std::uint32_t root : forest.roots) {
      const Ring& ring = forest.loops[root].ring;
      begin_[root] = static_cast<std::uint32_t>(points.size());
      points.insert(points.end(), ring.begin(), ring.end());
      end_[root] = static_cast<std::uint32_t>(points.size());
      owner_.resize(points.size(), root);
    }
    grid_.emplace(std::move(points));
  }

  [[nodiscard]] std::optional<std::uint32_t> nearest(Point2 nozzle) const {
    const auto point = grid_->nearest(nozzle);
    if (!point) return std::nullopt;
    return owner_[*point];
  }
  void remove(std::uint32_t root) {
    for (std::uint32_t i = begin_[root]; i < end_[root]; ++i) grid_->remove(i);
  }

 private:
  std::vector<std::uint32_t> begin_, end_;  // of a root's points in the grid
  std::vector<std::uint32_t> owner_;
  std::optional<NearestGrid> grid_;
};

/// Puts the loops of one layer in order.
class LoopOrder {
 public:
  LoopOrder(const ConcentricParams& params, const LoopForest& forest, const Polygons& area,
            Point2 start, const PlanContext& context)
      : params_(params),
        forest_(forest),
        area_(area),
        context_(context),
        seam_(params.seam),
        nozzle_(start) {}

  std::vector<Stroke> take() {
    NearestRoot roots(forest_);
    if (params_.link == Link::kTree)
      lay_linked(roots);
    else
      lay_pockets(roots);
    return std::move(strokes_);
  }

  [[nodiscard]] Point2 nozzle() const { return nozzle_; }

 private:
  [[nodiscard]] bool inside_out() const { return params_.order == Order::kInsideOut; }

  /// Lays lines that run from the outside in.
  void lay_all(std::vector<std::vector<Point2>> lines) {
    if (inside_out()) {
      std::reverse(lines.begin(), lines.end());
      for (std::vector<Point2>& line : lines) std::reverse(line.begin(), line.end());
    }
    for (std::vector<Point2>& line : lines) {
      if (line.size() < 2) continue;
      nozzle_ = line.back();
      strokes_.push_back({std::move(line), context_.line_width_mm});
    }
  }

  [[nodiscard]] std::size_t seam_of(std::uint32_t loop) const {
    return seam_.begin_of(forest_.loops[loop].ring, nozzle_);
  }

  void lay_linked(NearestRoot& roots) {
    const TreeLinker linker(forest_, area_, context_.line_distance_mm(), context_.spacing_mm,
                            context_);
    std::vector<std::vector<std::uint32_t>> groups(forest_.loops.size());
    for (const std::uint32_t root : forest_.roots) groups[linker.group_of(root)].push_back(root);
    while (const auto root = roots.nearest(nozzle_)) {
      for (const std::uint32_t other : groups[linker.group_of(*root)]) roots.remove(other);
      lay_all(linker.strokes_from(*root, seam_of(*root)));
    }
  }

  void lay_pockets(NearestRoot& roots) {
    const PocketForest pockets = pocket_forest(forest_, params_.link == Link::kSpiral);
    std::vector<std::uint32_t> pocket_of(forest_.loops.size(), 0);
    for (const std::uint32_t pocket : pockets.roots)
      pocket_of[pockets.pockets[pocket].loops.front()] = pocket;
    while (const auto root = roots.nearest(nozzle_)) {
      roots.remove(*root);
      lay_branch(pockets, pocket_of[*root]);
    }
  }

  void lay_pocket(const Pocket& pocket) {
    stop_if_asked(context_);
    lay_all(spirals(forest_, pocket, seam_of(pocket.loops.front()), context_.line_distance_mm(),
                    context_.density >= 1, area_));
  }

  /// A pocket and all inside it.
  void lay_branch(const PocketForest& pockets, std::uint32_t number) {
    const Pocket& pocket = pockets.pockets[number];
    if (!inside_out()) lay_pocket(pocket);
    std::vector<std::uint32_t> left = pocket.children;
    while (!left.empty()) {
      const auto nearest = std::min_element(left.begin(), left.end(), [&](auto a, auto b) {
        return distance_to(pockets.pockets[a]) < distance_to(pockets.pockets[b]);
      });
      const std::uint32_t child = *nearest;
      left.erase(nearest);
      lay_branch(pockets, child);
    }
    if (inside_out()) lay_pocket(pocket);
  }

  [[nodiscard]] double distance_to(const Pocket& pocket) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Point2 p : forest_.loops[pocket.loops.front()].ring)
      least = std::min(least, squared_distance(p, nozzle_));
    return least;
  }

  const ConcentricParams& params_;
  const LoopForest& forest_;
  EdgeGrid area_;
  const PlanContext& context_;
  SeamRule seam_;
  Point2 nozzle_;
  std::vector<Stroke> strokes_;
};

class Concentric final : public Planner {
 public:
  using Params = ConcentricParams;

  static PlannerInfo info() {
    return {"concentric",
            PlannerRole::kFill,
            "loops inside loops, joined to one stroke or not",
            "K. De Keyser, 2016",
            {},
            1};
  }

  explicit Concentric(const Params& params) : params_(resolved(params)) {
    make_ready(params_.method);
  }

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    const Rings rings = rings_in(
        frame.polygons(),
        {params_.method, params_.thin == Thin::kFill, params_.min_gap * context.line_width_mm},
        context);
    Route route;
    Point2 nozzle = frame.start();
    if (!rings.insets.empty()) {
      const LoopForest forest = loop_forest(rings.insets, context.line_distance_mm(), context);
      LoopOrder order(params_, forest, rings.insets.front(), nozzle, context);
      route.strokes = order.take();
      nozzle = order.nozzle();
    }
    std::vector<Stroke> lines = nearest_first(rings.centre_lines, nozzle, context);
    std::move(lines.begin(), lines.end(), std::back_inserter(route.strokes));
    return frame.from_frame(std::move(route));
  }

 private:
  ConcentricParams params_;
};

}  // namespace

ROUTEBENCH_REGISTER(concentric) { registry.add<Concentric>(); }
