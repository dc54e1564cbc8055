#include "pockets.hpp"

#include <algorithm>
#include <cmath>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/walk.hpp"

namespace routebench::concentric {
namespace {

// The round of the first loop lies beside the spiral's first turn. Beginning that turn so far
// inside, and ending the last one as far from the last loop, lays less twice.
constexpr double kHeadStart = 0.4;
// A foot is sought so many steps ahead of what the inner loop has gone.
constexpr double kLookAheadSteps = 6;
// Farther from its foot a point is not beside the loop.
constexpr double kFarthestSteps = 1.5;

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
/// `first`) of the way from the outer loop to the inner one. Empty if the inner loop strays from
/// the outer one.
std::vector<Point2> turn(const Walk& outer, const Walk& inner, double first, double last,
                         double step_mm) {
  std::vector<Point2> stroke;
  bool strays = false;
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
    strays |= squared_distance(foot.point, p) > kFarthestSteps * kFarthestSteps * step_mm * step_mm;
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
  if (strays) stroke.clear();
  return stroke;
}

bool stays_inside(const EdgeGrid& area, const std::vector<Point2>& line) {
  for (std::size_t i = 1; i < line.size(); ++i)
    if (!area.covers(line[i - 1], line[i])) return false;
  return true;
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

std::vector<std::vector<Point2>> spirals(const LoopForest& forest, const Pocket& pocket,
                                         std::size_t start, double step_mm, bool dense,
                                         const EdgeGrid& area) {
  std::vector<std::vector<Point2>> strokes(1);
  const auto ring_of = [&](std::size_t i) -> const Ring& {
    return forest.loops[pocket.loops[i]].ring;
  };
  // Dense, a pocket's first and last loop are laid whole; sparse, the spiral begins on the first.
  const auto lay_whole = [&](std::size_t i, const RingPlace& from) {
    const Walk walk(ring_of(i), from, true);
    walk.append(0, walk.length_mm(), strokes.back());
  };
  RingPlace at{static_cast<std::uint32_t>(start), ring_of(0)[start]};
  if (dense || pocket.loops.size() == 1) lay_whole(0, at);
  bool is_first = true;
  for (std::size_t i = 1; i < pocket.loops.size(); ++i) {
    const RingPlace next = nearest_place(ring_of(i), at.point).place;
    const Walk inner(ring_of(i), next, true);
    // The turn begins beside the inner walk's first point.
    const Walk outer(ring_of(i - 1), nearest_place(ring_of(i - 1), next.point).place, true);
    const bool is_last = i + 1 == pocket.loops.size();
    std::vector<Point2> line = turn(outer, inner, is_first && dense ? kHeadStart : 0,
                                    is_last && dense ? 1 - kHeadStart : 1, step_mm);
    if (!line.empty() && !strokes.back().empty()) line.insert(line.begin(), strokes.back().back());
    const bool is_good = !line.empty() && stays_inside(area, line);
    if (is_good) {
      for (const Point2 p : line) go_to(p, strokes.back());
      if (is_last) lay_whole(i, next);
    } else {
      if (!is_first || strokes.back().empty()) lay_whole(i - 1, at);
      strokes.emplace_back();
      if (dense || is_last) lay_whole(i, next);
    }
    is_first = !is_good;
    at = next;
  }
  return strokes;
}

}  // namespace routebench::concentric
