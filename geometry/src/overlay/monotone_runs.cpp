#include "overlay/monotone_runs.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "overlay/edge_cells.hpp"

namespace routebench::overlay {
namespace {

constexpr std::size_t kStepsPerEdge = 12;

/// So many are cut sooner.
constexpr std::uint32_t kFewEdges = 512;

/// Edges [begin, end) of one ring, all in one quadrant. Edge i runs from point i to the next one.
struct Run {
  std::uint32_t begin;
  std::uint32_t end;
  std::uint32_t ring;
  GridBox box;
};

/// Whether an edge goes the way that a run goes so far, which it may help to decide: along an axis
/// a run may rest.
bool goes_on(GridPoint a, GridPoint b, int& x_way, int& y_way) {
  const auto agrees = [](std::int32_t from, std::int32_t to, int& way) {
    const int step = from < to ? 1 : from > to ? -1 : 0;
    if (step == 0 || step == way) return true;
    if (way != 0) return false;
    way = step;
    return true;
  };
  int x = x_way, y = y_way;
  if (!agrees(a.x, b.x, x) || !agrees(a.y, b.y, y)) return false;
  x_way = x;
  y_way = y;
  return true;
}

bool turns_back(GridPoint a, GridPoint b, GridPoint c) {
  const std::int64_t x = b.x, y = b.y;
  return turn(a, b, c) == 0 && (a.x - x) * (c.x - x) + (a.y - y) * (c.y - y) > 0;
}

class Search {
 public:
  explicit Search(const GridRings& rings)
      : rings_(rings),
        points_(rings.points()),
        runs_(rings.memory()),
        steps_left_(kStepsPerEdge * points_.size()) {}

  bool find_none() {
    make_runs();
    std::sort(runs_.begin(), runs_.end(), [](const Run& a, const Run& b) {
      return a.box.lower.x != b.box.lower.x ? a.box.lower.x < b.box.lower.x : a.begin < b.begin;
    });
    for (std::size_t i = 0; i < runs_.size(); ++i)
      for (std::size_t k = i + 1; k < runs_.size(); ++k) {
        const Run &a = runs_[i], &b = runs_[k];
        if (b.box.lower.x > a.box.upper.x) break;
        if (!take_step()) return false;
        if (b.box.lower.y <= a.box.upper.y && a.box.lower.y <= b.box.upper.y && may_meet(a, b))
          return false;
      }
    return true;
  }

 private:
  void make_runs() {
    for (std::uint32_t ring = 0; ring < rings_.rings(); ++ring) {
      const std::uint32_t begin = rings_.begin(ring), end = rings_.end(ring);
      for (std::uint32_t i = begin; i < end;) {
        Run run{i, i, ring, {}};
        int x_way = 0, y_way = 0;
        while (i < end && goes_on(points_[i], points_[next(i, ring)], x_way, y_way)) ++i;
        run.end = i;
        run.box = box_between(run.begin, run.end, ring);
        runs_.push_back(run);
      }
    }
  }

  [[nodiscard]] std::uint32_t next(std::uint32_t point, std::uint32_t ring) const {
    return point + 1 < rings_.end(ring) ? point + 1 : rings_.begin(ring);
  }

  /// Of edges [begin, end) of one run.
  [[nodiscard]] GridBox box_between(std::uint32_t begin, std::uint32_t end,
                                    std::uint32_t ring) const {
    const GridPoint a = points_[begin], b = points_[next(end - 1, ring)];
    return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
  }

  bool take_step() { return steps_left_ > 0 && --steps_left_ > 0; }

  /// Takes runs, or parts of runs, whose boxes overlap.
  bool may_meet(const Run& a, const Run& b) {
    if (!take_step()) return true;
    const std::uint32_t a_edges = a.end - a.begin, b_edges = b.end - b.begin;
    if (a_edges == 1 && b_edges == 1) return edges_meet(a, b);
    const bool halve_a = a_edges >= b_edges;
    const Run &halved = halve_a ? a : b, &other = halve_a ? b : a;
    const std::uint32_t middle = halved.begin + (halved.end - halved.begin) / 2;
    for (const auto& [begin, end] : {std::pair{halved.begin, middle}, {middle, halved.end}}) {
      const Run half{begin, end, halved.ring, box_between(begin, end, halved.ring)};
      if (half.box.meets(other.box) && may_meet(half, other)) return true;
    }
    return false;
  }

  /// Neighbours have a point in common, and meet beyond it only where the ring turns back.
  [[nodiscard]] bool edges_meet(const Run& a, const Run& b) const {
    const Edge e{points_[a.begin], points_[next(a.begin, a.ring)]};
    const Edge f{points_[b.begin], points_[next(b.begin, b.ring)]};
    if (a.ring == b.ring) {
      if (next(a.begin, a.ring) == b.begin) return turns_back(e.from, e.to, f.to);
      if (next(b.begin, b.ring) == a.begin) return turns_back(f.from, f.to, e.to);
    }
    return overlay::edges_meet(e, f);
  }

  const GridRings& rings_;
  const std::pmr::vector<GridPoint>& points_;
  std::pmr::vector<Run> runs_;
  std::size_t steps_left_;
};

}  // namespace

bool meet_nowhere(const GridRings& rings) {
  return rings.size() > kFewEdges && Search(rings).find_none();
}

}  // namespace routebench::overlay
