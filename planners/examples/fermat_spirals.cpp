/// Fill by connected Fermat spirals: the loops of a region, two by two, become spirals that run
/// inwards and out again, and spirals are joined to one stroke.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/loop_trees.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/ring_path.hpp"
#include "routebench/planning/tour.hpp"
#include "routebench/planning/walk.hpp"
#include "routebench/planning/walls.hpp"

namespace {

using namespace routebench;

constexpr std::size_t kPlaces = 32;  // of a loop at which it may be opened
constexpr int kRampPoints = 4;       // of half a ramp
// In steps from one loop to the next:
constexpr double kNearest = 0.6, kFarthest = 1.35;  // what is joined lies so far apart,
constexpr double kFacing = 2.05;  // or so where the last loops of a corridor face each other
constexpr double kRamp = 2;       // half as long as a ramp

/// Loops that become one spiral, each from its opening once round. The openings lie side by side.
struct Pocket {
  std::size_t place = 0;  // at which the first loop is opened, of those to choose from
  std::vector<std::uint32_t> loops;
  std::vector<Walk> walks;
  std::vector<double> half_mm;  // of a loop's opening

  /// A place in the opening of a loop, from -1 to 1.
  [[nodiscard]] Point2 at(std::size_t k, double t) const {
    return walks[k].at(t < 0 ? walks[k].length_mm() + t * half_mm[k] : t * half_mm[k]);
  }
  /// Point i of the ramp to loop k, from -kRampPoints on the loop two before, over 0 on the one
  /// before, to kRampPoints.
  [[nodiscard]] Point2 ramp_to(std::size_t k, int i) const {
    const double t = static_cast<double>(i) / kRampPoints;
    return i <= 0 ? lerp(at(k < 2 ? 0 : k - 2, t), at(k - 1, t), t + 1)
                  : lerp(at(k - 1, t), at(k, t), t);
  }
};

/// Makes strokes of trees of loops.
class Spirals {
 public:
  Spirals(const std::vector<InsetLoop>& loops, const Polygons& area, double step_mm,
          const PlanContext& context)
      : loops_(loops), area_(area), step_mm_(step_mm), context_(context) {}

  /// Strokes over all loops of the tree of `root`, the first of which begins near `start`.
  std::vector<std::vector<Point2>> strokes_from(std::uint32_t root, Point2 start) {
    std::vector<std::vector<Point2>> strokes;
    loose_ = {root};
    while (!loose_.empty()) {
      const std::uint32_t loop = loose_.back();
      loose_.pop_back();
      std::vector<RingPlace> places = spread_places(loops_[loop].ring, kPlaces);
      const Point2 from = strokes.empty() ? start : strokes.back().back();
      std::stable_sort(places.begin(), places.end(), [&](const RingPlace& a, const RingPlace& b) {
        return squared_distance(a.point, from) < squared_distance(b.point, from);
      });
      strokes.push_back(spiral(deepest(loop, places)));
    }
    return strokes;
  }

 private:
  /// A stretch of a walk that is left open for another pocket.
  struct Detour {
    double from_mm, to_mm;
    std::vector<Point2> path;
  };

  /// Where a pocket may be opened, and which lengths of a walk its first and last point are beside.
  struct Opening {
    RingPlace place;
    double first_mm, last_mm;
    double far_mm;  // to the walk
  };

  [[nodiscard]] double opening_mm(const Walk& walk) const {
    return std::min(context_.spacing_mm, walk.length_mm() / 8);
  }

  void append_loop(std::uint32_t loop, const RingPlace& place, bool forward, Pocket& pocket) const {
    pocket.loops.push_back(loop);
    pocket.walks.emplace_back(loops_[loop].ring, place, forward);
    pocket.half_mm.push_back(std::min(kRamp * step_mm_, pocket.walks.back().length_mm() / 6));
  }

  /// Takes a loop into a pocket if it runs beside the pocket's last one all along the opening.
  bool extend(Pocket& pocket, std::uint32_t next) const {
    const std::size_t k = pocket.loops.size() - 1;
    const NearPlace near = nearest_place(loops_[next].ring, pocket.at(k, 0));
    const auto is_beside = [&](double mm) {
      return mm >= kNearest * step_mm_ && mm <= kFarthest * step_mm_;
    };
    if (!is_beside(near.distance_mm)) return false;
    for (const bool forward : {true, false}) {
      append_loop(next, near.place, forward, pocket);
      bool good = true;
      for (int i = -2; good && i <= 2; ++i) {
        const Point2 a = pocket.at(k, i / 2.0), b = pocket.at(k + 1, i / 2.0);
        good = is_beside(distance(a, b)) && area_.covers(a, b);
      }
      for (int i = k == 0 ? 0 : -kRampPoints; good && i < kRampPoints; ++i)
        good = area_.covers(pocket.ramp_to(k + 1, i), pocket.ramp_to(k + 1, i + 1));
      if (good) return true;
      pocket.loops.pop_back();
      pocket.walks.pop_back();
      pocket.half_mm.pop_back();
    }
    return false;
  }

  /// The pocket of most loops that begins with a loop, opened at one of some places; of equally
  /// deep ones the first.
  [[nodiscard]] Pocket deepest(std::uint32_t loop, const std::vector<RingPlace>& places) const {
    Pocket best;
    for (std::size_t i = 0; i < places.size(); ++i) {
      stop_if_asked(context_);
      Pocket pocket;
      pocket.place = i;
      append_loop(loop, places[i], true, pocket);
      while (std::ranges::any_of(loops_[pocket.loops.back()].children,
                                 [&](std::uint32_t child) { return extend(pocket, child); })) {
      }
      if (loops_[pocket.loops.back()].children.empty()) return pocket;
      if (pocket.loops.size() > best.loops.size()) best = std::move(pocket);
    }
    return best;
  }

  /// From the opening of a pocket's first loop inwards and out again to where that began.
  std::vector<Point2> spiral(const Pocket& pocket) {
    const std::size_t count = pocket.loops.size();
    std::vector<Point2> in =
        round(pocket, 0, opening_mm(pocket.walks[0]), count == 1 ? 0 : pocket.half_mm[0], {});
    if (count == 1) return in;
    std::vector<Point2> out;
    for (std::size_t k = 1; k < count; ++k) {
      std::vector<Point2>& arm = k % 2 == 0 ? in : out;
      add_ramp(pocket, k, k == 1 ? 0 : -kRampPoints, kRampPoints, arm);
      arm = round(pocket, k, pocket.half_mm[k], pocket.half_mm[k], std::move(arm));
    }
    // In the middle one arm crosses the last loop's opening, the other one comes to meet it.
    std::vector<Point2>& shorter = count % 2 == 0 ? in : out;
    std::vector<Point2>& longer = count % 2 == 0 ? out : in;
    add_ramp(pocket, count, -kRampPoints, 0, shorter);
    const Walk& last = pocket.walks.back();
    last.append(last.length_mm() - pocket.half_mm.back(), last.length_mm(), longer);
    std::for_each(out.rbegin(), out.rend(), [&](Point2 p) { go_to(p, in); });
    return in;
  }

  static void add_ramp(const Pocket& pocket, std::size_t k, int from, int to,
                       std::vector<Point2>& path) {
    for (int i = from; i <= to; ++i) go_to(pocket.ramp_to(k, i), path);
  }

  /// Along a loop of a pocket, but for its opening, with detours over all that hangs on it.
  std::vector<Point2> round(const Pocket& pocket, std::size_t k, double from_mm,
                            double before_end_mm, std::vector<Point2> path) {
    const Walk& walk = pocket.walks[k];
    const double end_mm = walk.length_mm() - before_end_mm;
    std::vector<Detour> detours;
    for (const std::uint32_t next : loops_[pocket.loops[k]].children)
      if ((k + 1 == pocket.loops.size() || next != pocket.loops[k + 1]) &&
          !add_detour(walk, next, from_mm, end_mm, detours))
        loose_.push_back(next);
    std::sort(detours.begin(), detours.end(),
              [](const Detour& a, const Detour& b) { return a.from_mm < b.from_mm; });
    for (const Detour& detour : detours) {
      walk.append(from_mm, detour.from_mm, path);
      for (const Point2 p : detour.path) go_to(p, path);
      from_mm = detour.to_mm;
    }
    walk.append(from_mm, end_mm, path);
    return path;
  }

  /// Adds a detour over the pocket that begins with a loop, between two lengths of a walk and away
  /// from other detours, where the step over is short; false if there is no place for it.
  bool add_detour(const Walk& walk, std::uint32_t loop, double begin_mm, double end_mm,
                  std::vector<Detour>& detours) {
    std::vector<Opening> openings;
    for (const RingPlace& place : spread_places(loops_[loop].ring, 2 * kPlaces)) {
      const Walk other(loops_[loop].ring, place, true);
      const Point2 first = other.at(opening_mm(other));
      const Walk::Near a = walk.nearest(first), b = walk.nearest(place.point);
      const auto [from_mm, to_mm] = std::minmax(a.along_mm, b.along_mm);
      const double far_mm = std::max(a.distance_mm, b.distance_mm);
      const double wide_mm = to_mm - from_mm;
      if (far_mm <= kFacing * step_mm_ && from_mm >= begin_mm && to_mm <= end_mm &&
          wide_mm > opening_mm(walk) / 4 && wide_mm < 3 * opening_mm(walk) &&
          std::none_of(detours.begin(), detours.end(),
                       [from = from_mm, to = to_mm](const Detour& detour) {
                         return from <= detour.to_mm && to >= detour.from_mm;
                       }) &&
          area_.covers(first, walk.at(a.along_mm)) &&
          area_.covers(place.point, walk.at(b.along_mm)))
        openings.push_back({place, a.along_mm, b.along_mm, far_mm});
    }
    if (openings.empty()) return false;
    std::stable_sort(openings.begin(), openings.end(),
                     [](const Opening& a, const Opening& b) { return a.far_mm < b.far_mm; });
    std::vector<RingPlace> places;
    for (const Opening& opening : openings) places.push_back(opening.place);
    const Pocket pocket = deepest(loop, places);
    const auto [a, b] = std::pair{openings[pocket.place].first_mm, openings[pocket.place].last_mm};
    Detour detour{std::min(a, b), std::max(a, b), spiral(pocket)};
    if (b < a) std::reverse(detour.path.begin(), detour.path.end());
    detours.push_back(std::move(detour));
    return true;
  }

  const std::vector<InsetLoop>& loops_;
  EdgeGrid area_;
  double step_mm_;
  const PlanContext& context_;
  std::vector<std::uint32_t> loose_;  // loops with which a stroke has to begin
};

class FermatSpirals final : public Planner {
 public:
  struct Params {
    bool thin = true;
    double min_line = 2;
    void bind(ParamBinder& bind) {
      bind(
          "thin", thin,
          "at density 1: where loops are too near or leave a gap, a line of the place's own width");
      bind("min_line", min_line, {0.5, 100}, "line widths", "shorter lines in gaps are left out");
    }
  };

  static PlannerInfo info() {
    return {"fermat_spirals", PlannerRole::kFill,
            "spirals that run inwards and out again, joined to one stroke",
            "H. Zhao et al., Connected Fermat Spirals for Layered Fabrication, 2016"};
  }

  explicit FermatSpirals(const Params& params) : params_(params) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    const double step_mm = context.line_distance_mm(), half_mm = context.line_width_mm / 2;
    const bool fill_thin = params_.thin && context.density >= 1;
    // Where sparse, half a distance inside: then the loops together are as long as is demanded.
    double inset_mm = std::max(half_mm, context.density < 1 ? step_mm / 2 : 0);
    std::vector<Polygons> insets;
    while (true) {
      stop_if_asked(context);
      Polygons inner = offset(insets.empty() ? frame.polygons() : insets.back(), -inset_mm);
      if (fill_thin) inner = without_thin_parts(inner, context.spacing_mm / 2);
      if (inner.empty()) break;
      insets.push_back(std::move(inner));
      inset_mm = step_mm;
    }
    const std::vector<InsetLoop> loops = loop_trees(insets, step_mm, context);
    Spirals spirals(loops, offset(frame.polygons(), -half_mm), step_mm, context);
    std::vector<Stroke> strokes;
    for (std::uint32_t loop = 0; loop < loops.size(); ++loop)
      if (loops[loop].is_root)
        for (std::vector<Point2>& line : spirals.strokes_from(loop, frame.start()))
          strokes.push_back({std::move(line), context.line_width_mm});
    if (fill_thin)
      for (Stroke& stroke : gap_lines(frame.polygons(), insets, static_cast<int>(insets.size()) + 1,
                                      context.line_width_mm, context))
        if (length_mm(stroke.points) >= params_.min_line * context.line_width_mm)
          strokes.push_back(std::move(stroke));
    return frame.from_frame({in_short_order(std::move(strokes), frame.start(), context)});
  }

 private:
  Params params_;
};

}  // namespace

ROUTEBENCH_REGISTER(fermat_spirals) { registry.add<FermatSpirals>(); }
