#include "routebench/planning/cell_strokes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using Polyline = std::vector<Point2>;

/// Which steps of which ring are the first to come into their cell.
class RimWalk {
 public:
  RimWalk(const CellMap& map, RimPlace place, double min_length_mm)
      : map_(map), place_(place), min_length_mm_(min_length_mm), last_visit_(map.grid.size(), 0) {}

  void walk(std::size_t ring) {
    const std::vector<CellStep>& steps = map_.steps[ring];
    const std::size_t count = steps.size();
    const std::vector<bool> laid = first_visits(steps);
    const auto gap = std::find(laid.begin(), laid.end(), false);
    if (gap == laid.end()) return add(path(ring, 0, count));
    const auto begin = static_cast<std::size_t>(gap - laid.begin());
    for (std::size_t i = begin; i < begin + count; ++i) {
      if (!laid[i % count]) continue;
      std::size_t end = i;
      while (laid[end % count]) ++end;
      Polyline points = path(ring, i, end);
      if (points.size() >= 2 && length_mm(points) >= min_length_mm_) add(std::move(points));
      i = end;
    }
  }

  std::vector<Polyline> take() { return std::move(lines_); }

 private:
  // To and fro between cells at a corner or along their border is no second visit.
  static constexpr std::size_t kBack = 3;

  std::vector<bool> first_visits(const std::vector<CellStep>& steps) {
    std::vector<bool> laid(steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      std::uint32_t& last = last_visit_[steps[i].cell];
      const std::uint32_t now = before_ + static_cast<std::uint32_t>(i) + 1;
      const bool this_ring = last > before_;
      const std::size_t since = now - last;
      laid[i] = last == 0 || (this_ring && (since <= kBack || steps.size() - since <= kBack));
      if (laid[i]) last = now;
    }
    before_ += static_cast<std::uint32_t>(steps.size());
    return laid;
  }

  /// Through the steps [from, to), which may run beyond the last one to the first again.
  [[nodiscard]] Polyline path(std::size_t ring, std::size_t from, std::size_t to) const {
    const std::vector<CellStep>& steps = map_.steps[ring];
    const std::size_t count = steps.size();
    Polyline points;
    if (place_ == RimPlace::kCentres) {
      const std::size_t end = to - from == count && count > 1 ? to + 1 : to;
      for (std::size_t i = from; i < end; ++i)
        points.push_back(map_.grid.centre(steps[i % count].cell));
      return points;
    }
    const RingPlace& enter = steps[from % count].enter;
    const RingPlace& leave = steps[to % count].enter;
    // Cells that are only touched have no length; the way round is meant for whole rings.
    if (to - from < count && to - from <= kBack && enter.point == leave.point) return points;
    return path_along(map_.rings[ring], enter, leave);
  }

  void add(Polyline points) {
    if (points.size() >= 2) lines_.push_back(std::move(points));
  }

  const CellMap& map_;
  RimPlace place_;
  double min_length_mm_;
  std::vector<std::uint32_t> last_visit_;  // of a cell: the number of the step, from 1
  std::uint32_t before_ = 0;               // steps of the rings before
  std::vector<Polyline> lines_;
};

/// A level line.
struct Run {
  std::uint32_t row;
  double left_mm;
  double right_mm;
};

/// Finds the runs of cells that are to be laid.
class RunFinder {
 public:
  RunFinder(const CellMap& map, const std::vector<bool>& use, const RowRule& rule)
      : map_(map),
        use_(use),
        rule_(rule),
        first_row_(std::llround(map.grid.first.y / map.grid.pitch_mm.y)) {}

  [[nodiscard]] std::vector<Run> find() const {
    std::vector<Run> runs;
    for (const CellSpan& span : map_.spans) {
      if (rule_.every > 1 && (first_row_ + span.row) % rule_.every != 0) continue;
      for (std::uint32_t column = span.first; column <= span.last; ++column) {
        if (!use_[map_.grid.cell(column, span.row)]) continue;
        const std::uint32_t first = column;
        while (column < span.last && use_[map_.grid.cell(column + 1, span.row)]) ++column;
        const double left = map_.grid.x(first), right = map_.grid.x(column);
        runs.push_back({span.row, left - reach(left - span.left_mm, first == span.first),
                        right + reach(span.right_mm - right, column == span.last)});
      }
    }
    return runs;
  }

 private:
  /// How far a row goes on beyond the centre of its last cell, from which the boundary lies
  /// `clear_mm` away.
  [[nodiscard]] double reach(double clear_mm, bool last_of_span) const {
    const double cell_mm = map_.grid.pitch_mm.x;
    if (rule_.ends == RowEnds::kBoundary) return last_of_span ? clear_mm : cell_mm / 2;
    // If the boundary is far away it is another part of it that ends the run, from the side.
    if (rule_.ends == RowEnds::kCentres || clear_mm > 1.5 * cell_mm) return 0;
    return std::clamp(clear_mm - rule_.rim_distance_mm, 0.0, cell_mm / 2);
  }

  const CellMap& map_;
  const std::vector<bool>& use_;
  const RowRule& rule_;
  std::int64_t first_row_;  // its number from y = 0
};

/// Joins runs to and fro.
class Zigzag {
 public:
  Zigzag(const CellGrid& grid, const EdgeGrid& edges, const RowRule& rule)
      : grid_(grid), edges_(edges), rule_(rule) {}

  /// Takes runs by row, and along it.
  std::vector<Polyline> join(const std::vector<Run>& runs, const PlanContext& context) {
    std::size_t below = 0, here = 0;  // where the runs of the two rows begin
    while (here < runs.size()) {
      stop_if_asked(context);
      std::size_t end = here;
      while (end < runs.size() && runs[end].row == runs[here].row) ++end;
      const bool neighbours = here > 0 && runs[below].row + rule_.every == runs[here].row;
      std::size_t candidate = neighbours ? below : here;
      for (std::size_t i = here; i < end; ++i) {
        while (candidate < here && runs[candidate].right_mm + rule_.max_link_mm < runs[i].left_mm)
          ++candidate;
        lay(runs, i, candidate, here);
      }
      below = here;
      here = end;
    }
    return lines();
  }

 private:
  struct Chain {
    Polyline points;
    bool ends_right = true;
    bool is_run = true;  // one run yet: it may be turned round
    std::size_t last_run = 0;
  };

  /// Appends a run to one of the chains [first, end) of the row below, or begins a chain.
  void lay(const std::vector<Run>& runs, std::size_t run, std::size_t first, std::size_t end) {
    const double y = grid_.y(runs[run].row);
    const std::array<Point2, 2> ends{snap(Point2{runs[run].left_mm, y}),
                                     snap(Point2{runs[run].right_mm, y})};
    for (std::size_t i = first; i < end; ++i) {
      if (runs[i].left_mm > runs[run].right_mm + rule_.max_link_mm) break;
      Chain& chain = chains_[chain_of_[i]];
      if (chain.last_run != i || !link(chain, ends)) continue;
      chain.last_run = run;
      chain_of_.push_back(chain_of_[i]);
      return;
    }
    chain_of_.push_back(chains_.size());
    chains_.push_back({{ends[0]}, true, true, run});
    if (ends[1] != ends[0]) chains_.back().points.push_back(ends[1]);
  }

  [[nodiscard]] bool link(Chain& chain, const std::array<Point2, 2>& ends) const {
    const auto can_end = [&](Point2 from, Point2 to) {
      return distance(from, to) <= rule_.max_link_mm && edges_.covers(from, to);
    };
    if (chain.is_run) {
      const Point2 left = chain.points.front(), right = chain.points.back();
      const bool left_is_nearer = distance(left, ends[0]) < distance(right, ends[1]);
      const bool turn = left_is_nearer ? can_end(left, ends[0])
                                       : !can_end(right, ends[1]) && can_end(left, ends[0]);
      if (turn) {
        std::reverse(chain.points.begin(), chain.points.end());
        chain.ends_right = false;
      }
    }
    const std::size_t side = chain.ends_right ? 1 : 0;
    if (!can_end(chain.points.back(), ends[side])) return false;
    chain.points.push_back(ends[side]);
    if (ends[1 - side] != ends[side]) chain.points.push_back(ends[1 - side]);
    chain.ends_right = !chain.ends_right;
    chain.is_run = false;
    return true;
  }

  std::vector<Polyline> lines() {
    std::vector<Polyline> all;
    for (Chain& chain : chains_) {
      if (chain.points.size() == 1) {
        const Point2 p = chain.points.front();
        const double reach_mm = grid_.pitch_mm.x / 4;
        chain.points = {snap(Point2{p.x - reach_mm, p.y}), snap(Point2{p.x + reach_mm, p.y})};
      }
      all.push_back(std::move(chain.points));
    }
    return all;
  }

  const CellGrid& grid_;
  const EdgeGrid& edges_;
  const RowRule& rule_;
  std::vector<Chain> chains_;
  std::vector<std::size_t> chain_of_;  // of a run
};

}  // namespace

std::vector<Polyline> rim_lines(const CellMap& map, RimPlace place, double min_length_mm,
                                const PlanContext& context) {
  RimWalk walk(map, place, min_length_mm);
  for (std::size_t ring = 0; ring < map.rings.size(); ++ring) {
    stop_if_asked(context);
    walk.walk(ring);
  }
  return walk.take();
}

std::vector<Polyline> row_lines(const CellMap& map, const std::vector<bool>& use,
                                const EdgeGrid& edges, const RowRule& rule,
                                const PlanContext& context) {
  return Zigzag(map.grid, edges, rule).join(RunFinder(map, use, rule).find(), context);
}

Polyline closed_line(const CellGrid& grid, const std::vector<std::uint32_t>& cells) {
  const std::size_t count = cells.size();
  const auto place = [&](std::size_t i) {
    const std::uint32_t cell = cells[i % count];
    return std::pair<std::int64_t, std::int64_t>(grid.column(cell), grid.row(cell));
  };
  Polyline points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x0, y0] = place(i + count - 1);
    const auto [x1, y1] = place(i);
    const auto [x2, y2] = place(i + 1);
    if (x1 - x0 != x2 - x1 || y1 - y0 != y2 - y1) points.push_back(grid.centre(cells[i]));
  }
  points.push_back(points.front());
  return points;
}

}  // namespace routebench
