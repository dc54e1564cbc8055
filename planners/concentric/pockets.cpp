#include "pockets.hpp"

#include <algorithm>
#include <cmath>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "walk.hpp"

namespace routebench::concentric {
namespace {

// The round of the first loop lies beside the spiral's first turn. Beginning that turn so far
// inside, and ending the last one as far from the last loop, lays less twice.
constexpr double kHeadStart = 0.4;
// A foot is sought so many steps ahead of what the inner loop has gone.
constexpr double kLookAheadSteps = 6;

/// Whether a loop goes on as its only child, in the same direction.
bool goes_on(const LoopForest& forest, const Loop& loop) {
  if (loop.children.size() != 1) return false;
  const Ring& child = forest.loops[loop.children.front()].ring;
  return (signed_area_mm2(loop.ring) > 0) == (signed_area_mm2(child) > 0);
}

/// The foot of a point on a walk, sought from a given edge on up to `limit_mm` of its length.
struct Foot {
  std::size_t edge;  // ends at this point
  Point2 point;
};
Foot foot_ahead(const Walk& walk, const Foot& from, double limit_mm, Point2 p) {
  Foot best{from.edge, nearest_on_segment(p, from.point, walk.points()[from.edge])};
  double least = squared_distance(p, best.point);
  for (std::size_t edge = from.edge + 1;
       edge < walk.points().size() && walk.along_mm(edge - 1) <= limit_mm; ++edge) {
    const Point2 foot = nearest_on_segment(p, walk.points()[edge - 1], walk.points()[edge]);
    if (squared_distance(p, foot) >= least) continue;
    least = squared_distance(p, foot);
    best = {edge, foot};
  }
  return best;
}

/// One turn between two loops: at share t of the inner walk the stroke lies `first` + t (`last` -
/// `first`) of the way from the outer loop to the inner one.
void turn(const Walk& outer, const Walk& inner, double first, double last, double step_mm,
          std::vector<Point2>& stroke) {
  Foot foot{1, outer.points().front()};
  const auto visit = [&](double along_mm, Point2 p) {
    const double t = first + (last - first) * along_mm / inner.length_mm();
    const double ahead_mm = outer.along_mm(foot.edge - 1) +
                            distance(outer.points()[foot.edge - 1], foot.point) +
                            kLookAheadSteps * step_mm;
    const Foot next = foot_ahead(outer, foot, ahead_mm, p);
    // A convex corner of the outer loop is the foot of no point.
    for (std::size_t i = foot.edge; i < next.edge; ++i)
      go_to(lerp(outer.points()[i], p, t), stroke);
    foot = next;
    go_to(lerp(foot.point, p, t), stroke);
  };
  for (std::size_t i = 1; i < inner.points().size(); ++i) {
    const Point2 a = inner.points()[i - 1], b = inner.points()[i];
    const int pieces = static_cast<int>(distance(a, b) / (2 * step_mm)) + 1;
    for (int k = i == 1 ? 0 : 1; k <= pieces; ++k) {
      const double share = static_cast<double>(k) / pieces;
      visit(inner.along_mm(i - 1) + share * distance(a, b), lerp(a, b, share));
    }
  }
}

}  // namespace

PocketForest pocket_forest(const LoopForest& forest, bool chains) {
  PocketForest all;
  std::vector<std::uint32_t> pocket_of(forest.loops.size());
  for (std::uint32_t i = 0; i < forest.loops.size(); ++i) {
    const Loop& loop = forest.loops[i];
    if (chains && loop.parent != kNoLoop && goes_on(forest, forest.loops[loop.parent])) {
      pocket_of[i] = pocket_of[loop.parent];
      all.pockets[pocket_of[i]].loops.push_back(i);
      continue;
    }
    pocket_of[i] = static_cast<std::uint32_t>(all.pockets.size());
    (loop.parent == kNoLoop ? all.roots : all.pockets[pocket_of[loop.parent]].children)
        .push_back(pocket_of[i]);
    all.pockets.push_back({{i}, {}});
  }
  return all;
}

std::vector<Point2> spiral(const LoopForest& forest, const Pocket& pocket, std::size_t start,
                           double step_mm) {
  std::vector<Point2> stroke;
  const Ring& first = forest.loops[pocket.loops.front()].ring;
  Walk outer(first, {static_cast<std::uint32_t>(start), first[start]}, true);
  outer.append(0, outer.length_mm(), stroke);
  for (std::size_t i = 1; i < pocket.loops.size(); ++i) {
    const Ring& ring = forest.loops[pocket.loops[i]].ring;
    Walk inner(ring, nearest_place(ring, outer.points().front()).place, true);
    // The turn begins beside the inner walk's first point.
    const NearPlace beside =
        nearest_place(forest.loops[pocket.loops[i - 1]].ring, inner.points().front());
    const Walk around(forest.loops[pocket.loops[i - 1]].ring, beside.place, true);
    turn(around, inner, i == 1 ? kHeadStart : 0, i + 1 == pocket.loops.size() ? 1 - kHeadStart : 1,
         step_mm, stroke);
    outer = inner;
  }
  if (pocket.loops.size() > 1) outer.append(0, outer.length_mm(), stroke);
  return stroke;
}

}  // namespace routebench::concentric
