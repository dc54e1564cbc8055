/// Walls by always going to the nearest segment that is not yet printed.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/nearest_grid.hpp"
#include "routebench/planning/ordering.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/seam.hpp"
#include "routebench/planning/walls.hpp"

namespace {

using namespace routebench;

enum class SearchKind { kGrid, kNaive };
enum class Chain { kGreedy, kLinear };
enum class Order { kInsideOut, kOutsideIn, kAny };
enum class Thin { kAuto, kDrop, kDouble };
enum class Gaps { kFill, kLeave };

/// Sides of a wall nearer to each other than this share of a spacing: both of them would be more
/// than an eighth too much material (beads 0.45 mm wide, 0.2 mm high), and one line of the part's
/// own width is still no wider than 1.6 line widths.
constexpr double kNearSides = 2.0 / 3;

struct ShellParams {
  SearchKind search = SearchKind::kGrid;
  Chain chain = Chain::kGreedy;
  SeamParams seam;
  Order order = Order::kInsideOut;
  Thin thin = Thin::kAuto;
  Gaps gaps = Gaps::kFill;
  bool small_twice = false;

  void bind(ParamBinder& bind) {
    bind("search", search, {{"grid", SearchKind::kGrid}, {"naive", SearchKind::kNaive}},
         "how the nearest segment is found: naive looks at every one each time; same route");
    bind("chain", chain, {{"greedy", Chain::kGreedy}, {"linear", Chain::kLinear}},
         "greedy goes to the nearest segment; linear takes walls by smallest x, without a search");
    seam.bind(bind);
    bind("order", order,
         {{"inside_out", Order::kInsideOut},
          {"outside_in", Order::kOutsideIn},
          {"any", Order::kAny}},
         "of an island's walls; any takes what is nearest, of any island");
    bind("thin", thin, {{"auto", Thin::kAuto}, {"drop", Thin::kDrop}, {"double", Thin::kDouble}},
         "where the two sides of a wall come nearer than two thirds of a spacing: drop the wall "
         "(gaps then lays one line), or double, there and back; auto does what lays more nearly as "
         "much as the place needs");
    bind("gaps", gaps, {{"fill", Gaps::kFill}, {"leave", Gaps::kLeave}},
         "parts and strips that are too narrow for a wall: a line of their own width along the "
         "middle, or nothing");
    bind("small_twice", small_twice,
         "lay an island's innermost wall twice round if no further one would fit");
  }
};

/// Closed walls that may be laid in any order, as a pool of segments: segment i runs from point i
/// to the next point of its ring.
class Pool {
 public:
  void add(const Ring& ring, double width_mm, bool twice_round) {
    ring_begin_.push_back(size());
    width_mm_.push_back(width_mm);
    twice_round_.push_back(twice_round);
    points_.insert(points_.end(), ring.begin(), ring.end());
    ring_of_.resize(points_.size(), static_cast<std::uint32_t>(rings() - 1));
  }

  void add(const Pool& other) {
    for (std::size_t ring = 0; ring < other.rings(); ++ring) {
      const auto begin = other.points_.begin();
      add(Ring(begin + other.ring_begin(ring), begin + other.ring_end(ring)), other.width_mm_[ring],
          other.twice_round_[ring]);
    }
  }

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size()); }
  [[nodiscard]] std::size_t rings() const { return ring_begin_.size(); }
  [[nodiscard]] const std::vector<Point2>& points() const { return points_; }
  [[nodiscard]] Point2 start(std::uint32_t segment) const { return points_[segment]; }
  [[nodiscard]] std::uint32_t ring_begin(std::size_t ring) const { return ring_begin_[ring]; }
  [[nodiscard]] std::uint32_t ring_end(std::size_t ring) const {
    return ring + 1 < rings() ? ring_begin_[ring + 1] : size();
  }
  /// Width of the wall that a segment belongs to.
  [[nodiscard]] double width_mm(std::uint32_t segment) const {
    return width_mm_[ring_of_[segment]];
  }
  /// Whether the ring that a segment belongs to is laid twice.
  [[nodiscard]] bool twice_round(std::uint32_t segment) const {
    return twice_round_[ring_of_[segment]];
  }
  [[nodiscard]] std::uint32_t next(std::uint32_t segment) const {
    const std::size_t ring = ring_of_[segment];
    return segment + 1 < ring_end(ring) ? segment + 1 : ring_begin(ring);
  }

  /// The starts of a ring's segments.
  [[nodiscard]] std::span<const Point2> ring(std::size_t ring) const {
    return {points_.data() + ring_begin(ring), points_.data() + ring_end(ring)};
  }

  /// The same of the ring that a segment belongs to.
  [[nodiscard]] std::span<const Point2> ring_with(std::uint32_t segment) const {
    return ring(ring_of_[segment]);
  }

  /// The segment with which a ring begins, for a nozzle at `from`.
  [[nodiscard]] std::uint32_t begin_of(std::size_t of, const SeamRule& seam, Point2 from) const {
    return ring_begin(of) + static_cast<std::uint32_t>(seam.begin_of(ring(of), from));
  }

 private:
  std::vector<Point2> points_;
  std::vector<std::uint32_t> ring_of_;
  std::vector<std::uint32_t> ring_begin_;
  std::vector<double> width_mm_;
  std::vector<bool> twice_round_;
};

/// Every segment with which a ring of the pool may begin.
std::vector<bool> entries(const Pool& pool, const SeamRule& seam) {
  std::vector<bool> may_begin(pool.size(), seam.anywhere());
  if (seam.anywhere()) return may_begin;
  for (std::size_t ring = 0; ring < pool.rings(); ++ring)
    may_begin[pool.begin_of(ring, seam, {})] = true;
  return may_begin;
}

// The searches answer the same question: which segment comes next for a nozzle at `from`, if
// `follower` (nothing at the end of a ring) begins just there? It is the nearest of all, so it
// always wins.

/// As published: looks at every segment that is left, each time.
class NaiveSearch {
 public:
  NaiveSearch(const Pool& pool, const SeamRule& seam)
      : pool_(pool), may_begin_(entries(pool, seam)) {}

  std::optional<std::uint32_t> next(Point2 from, std::optional<std::uint32_t> follower) const {
    std::optional<std::uint32_t> best = follower;
    double best_squared = 0;
    for (std::uint32_t i = 0; i < pool_.size(); ++i) {
      if (!may_begin_[i]) continue;
      const double squared = squared_distance(pool_.start(i), from);
      if (best && squared >= best_squared) continue;
      best = i;
      best_squared = squared;
    }
    return best;
  }
  void remove(std::uint32_t segment) { may_begin_[segment] = false; }

 private:
  const Pool& pool_;
  std::vector<bool> may_begin_;
};

/// For few rings: looks at every segment that is left, but only where a ring ends.
class ScanSearch {
 public:
  static constexpr std::size_t kMostRings = 4;

  ScanSearch(const Pool& pool, const SeamRule& seam) : naive_(pool, seam) {}

  std::optional<std::uint32_t> next(Point2 from, std::optional<std::uint32_t> follower) const {
    return follower ? follower : naive_.next(from, std::nullopt);
  }
  void remove(std::uint32_t segment) { naive_.remove(segment); }

 private:
  NaiveSearch naive_;
};

class GridSearch {
 public:
  GridSearch(const Pool& pool, const SeamRule& seam) : grid_(pool.points()) {
    const std::vector<bool> may_begin = entries(pool, seam);
    for (std::uint32_t i = 0; i < pool.size(); ++i)
      if (!may_begin[i]) grid_.remove(i);
  }

  std::optional<std::uint32_t> next(Point2 from, std::optional<std::uint32_t> follower) const {
    return follower ? follower : grid_.nearest(from);
  }
  void remove(std::uint32_t segment) { grid_.remove(segment); }

 private:
  NearestGrid grid_;
};

Point2 leftmost(std::span<const Point2> points) {
  return *std::min_element(points.begin(), points.end(), less_by_x);
}

/// No search at all: rings by their smallest x.
class LinearOrder {
 public:
  LinearOrder(const Pool& pool, const SeamRule& seam) : pool_(pool), seam_(seam) {
    for (std::uint32_t ring = 0; ring < pool.rings(); ++ring)
      leftmost_.emplace_back(leftmost(pool.ring(ring)), ring);
    std::stable_sort(leftmost_.begin(), leftmost_.end(),
                     [](const auto& a, const auto& b) { return less_by_x(a.first, b.first); });
  }

  std::optional<std::uint32_t> next(Point2 from, std::optional<std::uint32_t> follower) {
    if (follower) return follower;
    if (done_ == leftmost_.size()) return std::nullopt;
    return pool_.begin_of(leftmost_[done_++].second, seam_, from);
  }
  void remove(std::uint32_t) {}

 private:
  const Pool& pool_;
  const SeamRule& seam_;
  std::vector<std::pair<Point2, std::uint32_t>> leftmost_;
  std::size_t done_ = 0;
};

void go_round_again(Stroke& stroke) {
  const std::size_t once = stroke.points.size();
  stroke.points.reserve(2 * once - 1);
  for (std::size_t i = 1; i < once; ++i) stroke.points.push_back(stroke.points[i]);
}

/// Lays every segment of the pool; those that join make a stroke.
template <typename Search>
void walk(const Pool& pool, Search search, const PlanContext& context, Point2& nozzle,
          Route& route) {
  std::vector<bool> laid(pool.size(), false);
  std::optional<std::uint32_t> follower;
  while (const auto segment = search.next(nozzle, follower)) {
    stop_if_asked(context);
    if (segment != follower) {
      route.strokes.push_back({{}, pool.width_mm(*segment)});
      route.strokes.back().points.reserve(pool.ring_with(*segment).size() + 1);
      route.strokes.back().points.push_back(pool.start(*segment));
    }
    laid[*segment] = true;
    search.remove(*segment);
    const std::uint32_t next = pool.next(*segment);
    nozzle = pool.start(next);
    route.strokes.back().points.push_back(nozzle);
    follower = laid[next] ? std::nullopt : std::optional(next);
    if (!follower && pool.twice_round(next)) go_round_again(route.strokes.back());
  }
}

struct Island {
  std::vector<Pool> pools;   ///< in the order in which they are laid, none of them empty
  std::vector<Stroke> gaps;  ///< what is laid where no wall fits

  /// Where it may be begun. Not empty, as islands with nothing to lay are none.
  [[nodiscard]] std::vector<Point2> entries() const {
    if (!pools.empty()) return pools.front().points();
    std::vector<Point2> ends;
    for (const Stroke& stroke : gaps)
      ends.insert(ends.end(), {stroke.points.front(), stroke.points.back()});
    return ends;
  }
};

/// Always the island with the nearest entry.
class NearestIsland {
 public:
  explicit NearestIsland(const std::vector<Island>& islands) {
    std::vector<Point2> points;
    for (std::size_t i = 0; i < islands.size(); ++i) {
      const std::vector<Point2> starts = islands[i].entries();
      first_.push_back(static_cast<std::uint32_t>(points.size()));
      points.insert(points.end(), starts.begin(), starts.end());
      owner_.resize(points.size(), i);
    }
    first_.push_back(static_cast<std::uint32_t>(points.size()));
    grid_.emplace(std::move(points));
  }

  std::optional<std::size_t> next(Point2 nozzle) {
    const auto nearest = grid_->nearest(nozzle);
    if (!nearest) return std::nullopt;
    const std::size_t island = owner_[*nearest];
    for (std::uint32_t i = first_[island]; i < first_[island + 1]; ++i) grid_->remove(i);
    return island;
  }

 private:
  std::vector<std::uint32_t> first_;  // of an island's points in the grid; one more at the end
  std::vector<std::size_t> owner_;    // island of a point in the grid
  std::optional<NearestGrid> grid_;
};

Point2 leftmost(const Island& island) {
  const std::vector<Point2> points = island.entries();
  return leftmost(std::span<const Point2>(points));
}

class GreedyShell final : public Planner {
 public:
  using Params = ShellParams;

  static PlannerInfo info() {
    return {"greedy_shell",
            PlannerRole::kShell,
            "walls, always going to the nearest segment that is not yet printed",
            "K. De Keyser, 2016",
            {},
            1};
  }

  explicit GreedyShell(const Params& params) : params_(params), seam_(params.seam) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    std::vector<Island> islands = islands_of(frame.polygons(), context);
    Route route;
    Point2 nozzle = frame.start();
    const auto lay_all = [&](const Island& island) {
      for (const Pool& pool : island.pools) lay(pool, context, nozzle, route);
      if (island.gaps.empty()) return;
      for (Stroke& stroke : nearest_first(island.gaps, nozzle, context))
        route.strokes.push_back(std::move(stroke));
      nozzle = route.strokes.back().points.back();
    };
    if (islands.size() == 1) {
      lay_all(islands.front());
    } else if (params_.chain == Chain::kLinear) {
      std::stable_sort(islands.begin(), islands.end(), [](const Island& a, const Island& b) {
        return less_by_x(leftmost(a), leftmost(b));
      });
      for (const Island& island : islands) lay_all(island);
    } else {
      NearestIsland order(islands);
      while (const auto island = order.next(nozzle)) lay_all(islands[*island]);
    }
    return frame.from_frame(std::move(route));
  }

 private:
  [[nodiscard]] std::vector<Island> islands_of(const Polygons& polygons,
                                               const PlanContext& context) const {
    std::vector<Island> islands;
    for (const Polygon& polygon : polygons) {
      Island island = walls_of(polygon, context);
      if (!island.pools.empty() || !island.gaps.empty()) islands.push_back(std::move(island));
    }
    if (params_.order != Order::kAny || islands.empty()) return islands;
    Pool all;
    Island whole;
    for (const Island& island : islands) {
      for (const Pool& pool : island.pools) all.add(pool);
      whole.gaps.insert(whole.gaps.end(), island.gaps.begin(), island.gaps.end());
    }
    if (all.size() > 0) whole.pools.push_back(std::move(all));
    return {std::move(whole)};
  }

  [[nodiscard]] Island walls_of(const Polygon& polygon, const PlanContext& context) const {
    const Polygons outline{polygon};
    std::vector<Polygons> regions = wall_regions(polygon, context);
    Island island;
    for (std::size_t wall = 0; wall < regions.size(); ++wall) {
      const bool innermost = wall + 1 == regions.size();
      const bool twice =
          params_.small_twice && innermost && offset(regions[wall], -context.spacing_mm).empty();
      const bool is_first = wall == 0;
      const Polygons& before = is_first ? outline : regions[wall - 1];
      regions[wall] = where_walled(std::move(regions[wall]), before, is_first, context);
      Pool pool;
      const bool another = std::cmp_less(wall + 1, context.perimeters);
      for (const Polygon& part : regions[wall]) add_wall(part, another, twice, context, pool);
      if (pool.size() > 0) island.pools.push_back(std::move(pool));
    }
    if (params_.order == Order::kInsideOut) std::reverse(island.pools.begin(), island.pools.end());
    if (params_.gaps == Gaps::kFill)
      island.gaps = gap_lines(outline, regions, context.perimeters, widest_mm(context), context);
    return island;
  }

  /// A wall's region without what is too narrow for the wall.
  [[nodiscard]] Polygons where_walled(Polygons region, const Polygons& before, bool is_first,
                                      const PlanContext& context) const {
    const double near_mm = kNearSides * context.spacing_mm;
    if (params_.thin == Thin::kDrop) return without_thin_parts(region, near_mm);
    // Where gaps are left, a line would not take the wall's place.
    if (params_.thin == Thin::kDouble || params_.gaps == Gaps::kLeave) return region;
    const double place_mm = is_first ? context.line_width_mm : context.spacing_mm;
    return without_scraps(without_strips(std::move(region), place_mm / 2, near_mm, context), before,
                          place_mm / 2, near_mm, context);
  }

  /// Adds the wall round one part of its region. Where another one is asked for inside it and there
  /// is not even room for a line, it is made wider.
  void add_wall(const Polygon& part, bool another, bool twice, const PlanContext& context,
                Pool& pool) const {
    const double left_mm =
        another && params_.gaps == Gaps::kFill ? left_inside_mm(part, context) : 0;
    const auto add = [&](const Polygon& centre) {
      pool.add(centre.outer, context.line_width_mm + left_mm / 2, twice);
      for (const Ring& hole : centre.holes)
        pool.add(hole, context.line_width_mm + left_mm / 2, twice);
    };
    if (left_mm == 0) return add(part);
    for (const Polygon& centre : offset({part}, -left_mm / 4)) add(centre);
  }

  /// The widest place that no wall is laid in.
  [[nodiscard]] double widest_mm(const PlanContext& context) const {
    return context.line_width_mm +
           (params_.thin != Thin::kDouble ? kNearSides * context.spacing_mm : 0);
  }

  void lay(const Pool& pool, const PlanContext& context, Point2& nozzle, Route& route) const {
    if (params_.chain == Chain::kLinear)
      walk(pool, LinearOrder(pool, seam_), context, nozzle, route);
    else if (params_.search == SearchKind::kNaive)
      walk(pool, NaiveSearch(pool, seam_), context, nozzle, route);
    else if (pool.rings() <= ScanSearch::kMostRings)
      walk(pool, ScanSearch(pool, seam_), context, nozzle, route);
    else
      walk(pool, GridSearch(pool, seam_), context, nozzle, route);
  }

  ShellParams params_;
  SeamRule seam_;
};

}  // namespace

ROUTEBENCH_REGISTER(greedy_shell) { registry.add<GreedyShell>(); }
