#include "tree_link.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/walk.hpp"

namespace routebench::concentric {
namespace {

// Loops of neighbouring insets lie a step apart, two loops that face each other up to two.
constexpr double kFarthestSteps = 2.05;
// A joint may be so much longer than the shortest one of its loops.
constexpr double kLongerJoint = 1.3;
constexpr std::size_t kPlaces = 24;  // of a loop at which a joint is tried
// Smallest share of an opening that remains between openings.
constexpr double kBetween = 0.5;

struct Pair {
  double distance_mm;
  std::uint32_t a, b;
};

std::uint32_t find(std::vector<std::uint32_t>& leader, std::uint32_t i) {
  while (leader[i] != i) i = leader[i] = leader[leader[i]];
  return i;
}

}  // namespace

TreeLinker::TreeLinker(const LoopForest& forest, const EdgeGrid& area, double step_mm,
                       double gap_mm, const PlanContext& context)
    : forest_(forest),
      area_(area),
      step_mm_(step_mm),
      gap_mm_(gap_mm),
      context_(context),
      joined_(forest.loops.size()),
      group_(forest.loops.size()) {
  std::iota(group_.begin(), group_.end(), 0U);
  for (std::uint32_t i = 0; i < forest.loops.size(); ++i) {
    const std::uint32_t parent = forest.loops[i].parent;
    if (parent == kNoLoop) continue;
    joined_[parent].push_back(i);
    joined_[i].push_back(parent);
    group_[find(group_, i)] = find(group_, parent);
  }
  bridge_trees();
  for (std::uint32_t i = 0; i < group_.size(); ++i) group_[i] = find(group_, i);
}

void TreeLinker::bridge_trees() {
  const std::vector<Loop>& loops = forest_.loops;
  std::vector<Box2> boxes;
  for (const Loop& loop : loops) boxes.push_back(bounding_box(loop.ring));
  const double limit_mm = kFarthestSteps * step_mm_;
  std::vector<Pair> pairs;
  const auto consider = [&](std::uint32_t a, std::uint32_t b) {
    if (find(group_, a) == find(group_, b)) return;
    if (boxes[a].lower.x > boxes[b].upper.x + limit_mm ||
        boxes[b].lower.x > boxes[a].upper.x + limit_mm ||
        boxes[a].lower.y > boxes[b].upper.y + limit_mm ||
        boxes[b].lower.y > boxes[a].upper.y + limit_mm)
      return;
    const double mm = std::min(distance_of(loops[a].ring, loops[b].ring),
                               distance_of(loops[b].ring, loops[a].ring));
    if (mm <= limit_mm) pairs.push_back({mm, a, b});
  };
  // Loops of one region lie side by side.
  for (std::uint32_t begin = 0, end = 0; begin < loops.size(); begin = end) {
    stop_if_asked(context_);
    while (end < loops.size() && loops[end].region == loops[begin].region) ++end;
    for (std::uint32_t a = begin; a < end; ++a)
      for (std::uint32_t b = a + 1; b < end; ++b) consider(a, b);
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance_mm < b.distance_mm; });
  for (const Pair& pair : pairs) {
    const std::uint32_t a = find(group_, pair.a), b = find(group_, pair.b);
    if (a == b) continue;
    group_[a] = b;
    joined_[pair.a].push_back(pair.b);
    joined_[pair.b].push_back(pair.a);
  }
}

/// Lays the loops of one group.
class TreeLinker::Tracer {
 public:
  explicit Tracer(const TreeLinker& linker)
      : linker_(linker), below_(linker.joined_.size(), 0), before_(below_.size(), kNoLoop) {}

  std::vector<std::vector<Point2>> trace(std::uint32_t root, std::size_t start) {
    count_below(root);
    const Ring& ring = ring_of(root);
    lay_chain(root, {static_cast<std::uint32_t>(start), ring[start]});
    while (!loose_.empty()) {
      const std::uint32_t loop = loose_.back();
      loose_.pop_back();
      lay_chain(loop, nearest_place(ring_of(loop), strokes_.back().back()).place);
    }
    return std::move(strokes_);
  }

 private:
  struct Excursion {
    double at_mm;
    std::uint32_t loop;
  };

  [[nodiscard]] const Ring& ring_of(std::uint32_t loop) const {
    return linker_.forest_.loops[loop].ring;
  }

  /// Counts the loops that are reached from `root` over each loop, itself included.
  void count_below(std::uint32_t root) {
    std::vector<std::uint32_t> order{root};
    for (std::size_t i = 0; i < order.size(); ++i)
      for (const std::uint32_t next : linker_.joined_[order[i]])
        if (next != before_[order[i]]) {
          before_[next] = order[i];
          order.push_back(next);
        }
    for (auto loop = order.rbegin(); loop != order.rend(); ++loop) {
      ++below_[*loop];
      if (before_[*loop] != kNoLoop) below_[before_[*loop]] += below_[*loop];
    }
  }

  [[nodiscard]] double opening_mm(double length_mm) const {
    return std::min(linker_.gap_mm_, length_mm / 4);
  }

  /// The loops behind a loop, those with most loops behind them first.
  [[nodiscard]] std::vector<std::uint32_t> behind(std::uint32_t loop) const {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t other : linker_.joined_[loop])
      if (other != before_[loop]) next.push_back(other);
    std::stable_sort(next.begin(), next.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return below_[a] > below_[b]; });
    return next;
  }

  /// A stroke that begins at a place of a loop and does not come back.
  void lay_chain(std::uint32_t loop, RingPlace start) {
    std::vector<Point2> stroke;
    bool forward = true;
    while (true) {
      stop_if_asked(linker_.context_);
      const Walk walk(ring_of(loop), start, forward);
      const bool is_alone = linker_.joined_[loop].empty();
      const double end_mm = walk.length_mm() - (is_alone ? 0 : opening_mm(walk.length_mm()));
      std::vector<std::uint32_t> next = behind(loop);
      std::optional<RingPlace> step;
      std::uint32_t last = kNoLoop;
      for (const std::uint32_t other : next) {
        step = step_to(walk.at(end_mm), loop, other);
        if (!step) continue;
        last = other;
        std::erase(next, other);
        break;
      }
      lay_round(walk, end_mm, next, stroke);
      if (last == kNoLoop) break;
      forward = goes_along(walk.at(end_mm), walk.at(end_mm - linker_.gap_mm_ / 2), last, *step);
      loop = last;
      start = *step;
    }
    strokes_.push_back(std::move(stroke));
  }

  /// The place of `other` to which a short step leads from the point p of `loop`.
  [[nodiscard]] std::optional<RingPlace> step_to(Point2 p, std::uint32_t loop,
                                                 std::uint32_t other) const {
    const NearPlace near = nearest_place(ring_of(other), p);
    const double usual_mm = std::max(linker_.step_mm_, distance_of(ring_of(other), ring_of(loop)));
    if (near.distance_mm > kLongerJoint * usual_mm || !linker_.area_.covers(p, near.place.point))
      return std::nullopt;
    return near.place;
  }

  /// True if going on from a place in the ring's direction is no turning back, for one who came
  /// from `before` to `p` and steps over.
  [[nodiscard]] bool goes_along(Point2 p, Point2 before, std::uint32_t loop,
                                const RingPlace& place) const {
    const Ring& ring = ring_of(loop);
    const Point2 along = ring[place.edge + 1 < ring.size() ? place.edge + 1 : 0] - ring[place.edge];
    return dot(p - before, along) >= 0;
  }

  /// Goes along a walk to end_mm, with an excursion to each of the given loops.
  void lay_round(const Walk& walk, double end_mm, const std::vector<std::uint32_t>& next,
                 std::vector<Point2>& stroke) {
    std::vector<Excursion> excursions;
    for (const std::uint32_t loop : next)
      if (const auto at_mm = place_for(walk, end_mm, loop, excursions))
        excursions.push_back({*at_mm, loop});
      else
        loose_.push_back(loop);
    std::sort(excursions.begin(), excursions.end(),
              [](const Excursion& a, const Excursion& b) { return a.at_mm < b.at_mm; });
    const double half_mm = opening_mm(walk.length_mm()) / 2;
    double done_mm = 0;
    for (const Excursion& excursion : excursions) {
      walk.append(done_mm, excursion.at_mm - half_mm, stroke);
      done_mm = excursion.at_mm + half_mm;
      lay_there_and_back(excursion.loop, walk.at(excursion.at_mm - half_mm), walk.at(done_mm),
                         stroke);
    }
    walk.append(done_mm, end_mm, stroke);
  }

  /// Where a walk is left for a loop and taken up again: there the loop is near, and there is no
  /// other opening.
  [[nodiscard]] std::optional<double> place_for(const Walk& walk, double end_mm, std::uint32_t loop,
                                                const std::vector<Excursion>& taken) const {
    const double gap_mm = opening_mm(walk.length_mm());
    const double apart_mm = (1 + kBetween) * gap_mm;
    const Ring& ring = ring_of(loop);
    std::vector<Walk::Near> places;
    for (const RingPlace& place : spread_places(ring, kPlaces))
      places.push_back(walk.nearest(place.point));
    std::stable_sort(places.begin(), places.end(), [](const Walk::Near& a, const Walk::Near& b) {
      return a.distance_mm < b.distance_mm;
    });
    const double limit_mm = kLongerJoint * std::max(places.front().distance_mm, linker_.step_mm_);
    for (const Walk::Near& place : places) {
      if (place.distance_mm > limit_mm) break;
      if (place.along_mm < apart_mm || place.along_mm > end_mm - apart_mm) continue;
      const auto collides = [&](const Excursion& other) {
        return std::abs(other.at_mm - place.along_mm) < apart_mm;
      };
      if (std::any_of(taken.begin(), taken.end(), collides)) continue;
      const auto is_good = [&](double mm) {
        const Point2 p = walk.at(mm);
        const NearPlace near = nearest_place(ring, p);
        return near.distance_mm <= limit_mm && linker_.area_.covers(p, near.place.point);
      };
      if (is_good(place.along_mm - gap_mm / 2) && is_good(place.along_mm + gap_mm / 2))
        return place.along_mm;
    }
    return std::nullopt;
  }

  /// From a point beside a loop round it, and over all loops behind it, to another point beside it.
  void lay_there_and_back(std::uint32_t loop, Point2 from, Point2 to, std::vector<Point2>& stroke) {
    stop_if_asked(linker_.context_);
    const RingPlace begin = nearest_place(ring_of(loop), from).place;
    const Point2 end = nearest_place(ring_of(loop), to).place.point;
    Walk walk(ring_of(loop), begin, true);
    double end_mm = walk.nearest(end).along_mm;
    if (end_mm < walk.length_mm() / 2) {
      walk = Walk(ring_of(loop), begin, false);
      end_mm = walk.length_mm() - end_mm;
    }
    end_mm = std::min(end_mm, walk.length_mm() - opening_mm(walk.length_mm()));
    lay_round(walk, end_mm, behind(loop), stroke);
  }

  const TreeLinker& linker_;
  std::vector<std::uint32_t> below_;
  std::vector<std::uint32_t> before_;  // the loop from which a loop is reached
  std::vector<std::uint32_t> loose_;
  std::vector<std::vector<Point2>> strokes_;
};

std::vector<std::vector<Point2>> TreeLinker::strokes_from(std::uint32_t root,
                                                          std::size_t start) const {
  return Tracer(*this).trace(root, start);
}

}  // namespace routebench::concentric
