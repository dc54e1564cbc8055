/// Fill by connected Fermat spirals: the loops of a region, two by two, become spirals that run
/// inwards and out again, and spirals are joined to one stroke.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/ring_path.hpp"
#include "routebench/planning/tour.hpp"
#include "routebench/planning/walk.hpp"
#include "routebench/planning/walls.hpp"

namespace {

using namespace routebench;

constexpr std::uint32_t kNone = UINT32_MAX;
constexpr std::size_t kPlaces =
    32;                         // of a loop from which it looks at others, or where it is opened
constexpr int kRampPoints = 4;  // of half a ramp
// In steps from one loop to the next:
constexpr double kNearest = 0.6, kFarthest = 1.35;  // what is joined lies so far apart,
constexpr double kFacing = 2.05;  // or so where the last loops of a corridor face each other
constexpr double kRamp = 2;       // half as long as a ramp

/// A ring of an inset.
struct Loop {
  Ring ring;
  Box2 box;
  std::vector<std::uint32_t> joined{};  // neighbours in its tree
};

/// The loops of one layer as trees: neighbours of neighbouring insets, and those of one inset that
/// face each other, always those first that face each other longest.
class LoopTrees {
 public:
  LoopTrees(const std::vector<Polygons>& insets, double step_mm, const PlanContext& context) {
    std::vector<std::uint32_t> first{0};  // loop of an inset
    for (const Polygons& inset : insets) {
      for (Ring& ring : rings_of(inset)) {
        const Box2 box = bounding_box({{ring, {}}});
        loops.push_back({std::move(ring), box});
      }
      first.push_back(static_cast<std::uint32_t>(loops.size()));
    }
    tree_of.resize(loops.size());
    std::iota(tree_of.begin(), tree_of.end(), 0U);
    for (std::size_t i = 1; i < insets.size(); ++i)
      join({first[i], first[i + 1]}, {first[i - 1], first[i]}, kFarthest * step_mm, context);
    for (std::size_t i = 0; i < insets.size(); ++i)
      join({first[i], first[i + 1]}, {first[i], first[i + 1]}, kFacing * step_mm, context);
    for (std::uint32_t i = 0; i < loops.size(); ++i) tree_of[i] = find(i);
  }

  std::vector<Loop> loops;
  std::vector<std::uint32_t> tree_of;  // of a loop

 private:
  using Range = std::pair<std::uint32_t, std::uint32_t>;
  struct Pair {
    std::uint32_t a, b;
    std::size_t places;
  };

  std::uint32_t find(std::uint32_t i) {
    while (tree_of[i] != i) i = tree_of[i] = tree_of[tree_of[i]];
    return i;
  }

  [[nodiscard]] bool may_meet(const Box2& a, const Box2& b, double mm) const {
    return a.lower.x <= b.upper.x + mm && b.lower.x <= a.upper.x + mm &&
           a.lower.y <= b.upper.y + mm && b.lower.y <= a.upper.y + mm;
  }

  /// Joins loops of one range to loops of another one that are near from some of their places.
  void join(Range from, Range to, double limit_mm, const PlanContext& context) {
    std::vector<Pair> pairs;
    for (std::uint32_t a = from.first; a < from.second; ++a) {
      stop_if_asked(context);
      const std::vector<RingPlace> places = spread_places(loops[a].ring, kPlaces);
      for (std::uint32_t b = to.first; b < to.second; ++b) {
        if (find(a) == find(b) || !may_meet(loops[a].box, loops[b].box, limit_mm)) continue;
        const auto near = std::count_if(places.begin(), places.end(), [&](const RingPlace& place) {
          return nearest_place(loops[b].ring, place.point).distance_mm <= limit_mm;
        });
        if (near > 0) pairs.push_back({a, b, static_cast<std::size_t>(near)});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.places > b.places; });
    for (const Pair& pair : pairs) {
      const std::uint32_t a = find(pair.a), b = find(pair.b);
      if (a == b) continue;
      tree_of[a] = b;
      loops[pair.a].joined.push_back(pair.b);
      loops[pair.b].joined.push_back(pair.a);
    }
  }
};

/// Loops that become one spiral, each from its opening once round. The openings lie side by side.
struct Pocket {
  RingPlace place;  // where the first loop is opened
  std::vector<std::uint32_t> loops{};
  std::vector<Walk> walks{};
  std::vector<double> half_mm{};  // of a loop's opening

  /// A place in the opening of a loop, from -1 to 1.
  [[nodiscard]] Point2 at(std::size_t k, double t) const {
    return walks[k].at(t < 0 ? walks[k].length_mm() + t * half_mm[k] : t * half_mm[k]);
  }
  /// On the ramp that leaves loop k at -1, crosses the next one at 0 and joins the one after at 1.
  [[nodiscard]] Point2 ramp(std::size_t k, double t) const {
    return t <= 0 ? lerp(at(k, t), at(k + 1, t), t + 1) : lerp(at(k + 1, t), at(k + 2, t), t);
  }
};

/// Makes strokes of trees of loops.
class Spirals {
 public:
  Spirals(const LoopTrees& trees, const Polygons& area, double step_mm, const PlanContext& context)
      : loops_(trees.loops),
        area_(area),
        step_mm_(step_mm),
        context_(context),
        before_(loops_.size(), kNone),
        below_(loops_.size(), 1) {}

  /// Strokes over all loops of the tree of `root`, the first of which begins near `start`.
  std::vector<std::vector<Point2>> strokes_from(std::uint32_t root, Point2 start) {
    std::vector<std::uint32_t> order{root};
    for (std::size_t i = 0; i < order.size(); ++i)
      for (const std::uint32_t next : loops_[order[i]].joined)
        if (next != before_[order[i]]) {
          before_[next] = order[i];
          order.push_back(next);
        }
    for (std::size_t i = order.size() - 1; i > 0; --i)
      below_[before_[order[i]]] += below_[order[i]];

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

  [[nodiscard]] double opening_mm(const Walk& walk) const {
    return std::min(context_.spacing_mm, walk.length_mm() / 8);
  }

  void append_loop(std::uint32_t loop, const RingPlace& place, bool forward, Pocket& pocket) const {
    pocket.loops.push_back(loop);
    pocket.walks.emplace_back(loops_[loop].ring, place, forward);
    pocket.half_mm.push_back(std::min(kRamp * step_mm_, pocket.walks.back().length_mm() / 6));
  }

  /// The loops behind a loop, those with most loops behind them first.
  [[nodiscard]] std::vector<std::uint32_t> behind(std::uint32_t loop) const {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t other : loops_[loop].joined)
      if (other != before_[loop]) next.push_back(other);
    std::stable_sort(next.begin(), next.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return below_[a] > below_[b]; });
    return next;
  }

  /// Takes a loop into a pocket if it runs beside the pocket's last one all along the opening.
  bool extend(Pocket& pocket, std::uint32_t next) const {
    const std::size_t k = pocket.loops.size() - 1;
    const Walk& last = pocket.walks[k];
    const NearPlace near = nearest_place(loops_[next].ring, last.points().front());
    const auto is_beside = [&](double mm) {
      return mm >= kNearest * step_mm_ && mm <= kFarthest * step_mm_;
    };
    if (!is_beside(near.distance_mm)) return false;
    for (const bool forward : {true, false}) {
      Pocket longer = pocket;
      append_loop(next, near.place, forward, longer);
      bool good = true;
      for (int i = -2; good && i <= 2; ++i) {
        const Point2 a = longer.at(k, i / 2.0), b = longer.at(k + 1, i / 2.0);
        good = is_beside(distance(a, b)) && area_.covers(a, b);
      }
      for (int i = -kRampPoints; good && k > 0 && i < kRampPoints; ++i)
        good = area_.covers(longer.ramp(k - 1, static_cast<double>(i) / kRampPoints),
                            longer.ramp(k - 1, (i + 1.0) / kRampPoints));
      if (!good) continue;
      pocket = std::move(longer);
      return true;
    }
    return false;
  }

  /// The pocket of most loops that begins with a loop, opened at one of some places; of equally
  /// deep ones the first.
  [[nodiscard]] Pocket deepest(std::uint32_t loop, const std::vector<RingPlace>& places) const {
    Pocket best{places.front()};
    for (const RingPlace& place : places) {
      stop_if_asked(context_);
      Pocket pocket{place};
      append_loop(loop, place, true, pocket);
      bool more = true;
      while (more) {
        const std::vector<std::uint32_t> next = behind(pocket.loops.back());
        more = std::any_of(next.begin(), next.end(),
                           [&](std::uint32_t other) { return extend(pocket, other); });
        if (!more && next.empty()) return pocket;
      }
      if (pocket.loops.size() > best.loops.size()) best = std::move(pocket);
    }
    return best;
  }

  /// From the opening of a pocket's first loop inwards and out again to where that began.
  std::vector<Point2> spiral(const Pocket& pocket) {
    const std::size_t count = pocket.loops.size();
    if (count == 1) return round(pocket, 0, opening_mm(pocket.walks[0]), 0, {});
    std::vector<Point2> in = round(pocket, 0, opening_mm(pocket.walks[0]), pocket.half_mm[0], {});
    std::vector<Point2> out;
    for (int i = 0; i <= kRampPoints; ++i) {
      const double t = static_cast<double>(i) / kRampPoints;
      go_to(lerp(pocket.at(0, t), pocket.at(1, t), t), out);
    }
    out = round(pocket, 1, pocket.half_mm[1], pocket.half_mm[1], std::move(out));
    for (std::size_t k = 0; k + 2 < count; ++k) {
      std::vector<Point2>& arm = k % 2 == 0 ? in : out;
      add_ramp(pocket, k, kRampPoints, arm);
      const double half_mm = pocket.half_mm[k + 2];
      arm = round(pocket, k + 2, half_mm, half_mm, std::move(arm));
    }
    // In the middle one arm crosses the last loop's opening, the other one comes to meet it.
    std::vector<Point2>& shorter = count % 2 == 0 ? in : out;
    std::vector<Point2>& longer = count % 2 == 0 ? out : in;
    add_ramp(pocket, count - 2, 0, shorter);
    const Walk& last = pocket.walks.back();
    last.append(last.length_mm() - pocket.half_mm.back(),
                last.length_mm() - pocket.half_mm.back() / 2, longer);
    std::for_each(out.rbegin(), out.rend(), [&](Point2 p) { go_to(p, in); });
    return in;
  }

  static void add_ramp(const Pocket& pocket, std::size_t k, int end, std::vector<Point2>& path) {
    for (int i = -kRampPoints; i <= end; ++i)
      go_to(pocket.ramp(k, static_cast<double>(i) / kRampPoints), path);
  }

  /// Along a loop of a pocket, but for its opening, with detours over all that hangs on it.
  std::vector<Point2> round(const Pocket& pocket, std::size_t k, double from_mm,
                            double before_end_mm, std::vector<Point2> path) {
    const Walk& walk = pocket.walks[k];
    const double end_mm = walk.length_mm() - before_end_mm;
    std::vector<Detour> detours;
    for (const std::uint32_t next : behind(pocket.loops[k]))
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
  /// from other detours; false if there is no place for it.
  bool add_detour(const Walk& walk, std::uint32_t loop, double begin_mm, double end_mm,
                  std::vector<Detour>& detours) {
    std::vector<RingPlace> places = spread_places(loops_[loop].ring, 2 * kPlaces);
    double nearest_mm = kFacing * step_mm_;
    for (const RingPlace& place : places)
      nearest_mm = std::min(nearest_mm, walk.nearest(place.point).distance_mm);
    const double limit_mm = std::max(kFarthest * step_mm_, nearest_mm);
    // The stretch of the walk beside a pocket that is opened at a place.
    const auto stretch_at =
        [&](const RingPlace& place) -> std::optional<std::pair<double, double>> {
      const Walk other(loops_[loop].ring, place, true);
      const Point2 first = other.at(opening_mm(other));
      const Walk::Near a = walk.nearest(first), b = walk.nearest(place.point);
      const double wide_mm = std::abs(b.along_mm - a.along_mm);
      const auto is_free = [&](double from_mm, double to_mm) {
        return std::max(a.along_mm, b.along_mm) < from_mm ||
               std::min(a.along_mm, b.along_mm) > to_mm;
      };
      const bool good = std::max(a.distance_mm, b.distance_mm) <= limit_mm &&
                        wide_mm > opening_mm(walk) / 4 && wide_mm < 3 * opening_mm(walk) &&
                        is_free(-1, begin_mm) && is_free(end_mm, walk.length_mm() + 1) &&
                        std::all_of(detours.begin(), detours.end(),
                                    [&](const Detour& d) { return is_free(d.from_mm, d.to_mm); }) &&
                        area_.covers(first, walk.at(a.along_mm)) &&
                        area_.covers(place.point, walk.at(b.along_mm));
      return good ? std::optional(std::pair{a.along_mm, b.along_mm}) : std::nullopt;
    };
    std::erase_if(places, [&](const RingPlace& place) { return !stretch_at(place); });
    if (places.empty()) return false;
    const Pocket pocket = deepest(loop, places);
    const auto [a, b] = *stretch_at(pocket.place);
    Detour& detour = detours.emplace_back(Detour{std::min(a, b), std::max(a, b), spiral(pocket)});
    if (b < a) std::reverse(detour.path.begin(), detour.path.end());
    return true;
  }

  const std::vector<Loop>& loops_;
  EdgeGrid area_;
  double step_mm_;
  const PlanContext& context_;
  std::vector<std::uint32_t> before_;  // the loop from which a loop is reached
  std::vector<std::size_t> below_;     // loops reached over a loop, itself included
  std::vector<std::uint32_t> loose_;   // loops with which a stroke has to begin
};

class FermatSpirals final : public Planner {
 public:
  struct Params {
    bool thin = true;
    void bind(ParamBinder& bind) {
      bind(
          "thin", thin,
          "at density 1: where loops are too near or leave a gap, a line of the place's own width");
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
    const LoopTrees trees(insets, step_mm, context);
    Spirals spirals(trees, offset(frame.polygons(), -half_mm), step_mm, context);
    std::vector<Stroke> strokes;
    std::vector<bool> done(trees.loops.size(), false);  // of a tree, by its number
    for (std::uint32_t loop = 0; loop < trees.loops.size(); ++loop) {
      if (done[trees.tree_of[loop]]) continue;
      done[trees.tree_of[loop]] = true;
      for (std::vector<Point2>& line : spirals.strokes_from(loop, frame.start()))
        strokes.push_back({std::move(line), context.line_width_mm});
    }
    if (fill_thin)
      for (Stroke& stroke :
           gap_lines(frame.polygons(), insets, static_cast<int>(insets.size()) + 1, context))
        strokes.push_back(std::move(stroke));
    return frame.from_frame({in_short_order(std::move(strokes), frame.start(), context)});
  }

 private:
  Params params_;
};

}  // namespace

ROUTEBENCH_REGISTER(fermat_spirals) { registry.add<FermatSpirals>(); }
