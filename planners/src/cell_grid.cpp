#include "routebench/planning/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/line_crossings.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

constexpr double kMostCells = 1U << 30U;

/// The number of the nearest centre.
double nearest(double cells) { return std::floor(cells + 0.5); }

struct Axis {
  double first_mm;
  double pitch_mm;
  double count;
};

Axis anchored(double low, double high, double pitch_mm) {
  const double first = nearest(low / pitch_mm);
  return {first * pitch_mm, pitch_mm, nearest(high / pitch_mm) - first + 1};
}

Axis fitted(double low, double high, const PlanContext& context) {
  const double length_mm = high - low;
  if (length_mm < context.spacing_mm / 2) return {(low + high) / 2, context.spacing_mm, 1};
  const double gaps = std::max(std::round(length_mm / context.spacing_mm),
                               std::ceil(length_mm / context.line_width_mm));
  return {low, length_mm / gaps, gaps + 1};
}

CellGrid grid_over(const Axis& x, const Axis& y) {
  if (!(x.count * y.count <= kMostCells))
    throw Error(ErrorKind::kBadInput, "a region of " + std::to_string(x.count * x.pitch_mm) +
                                          " x " + std::to_string(y.count * y.pitch_mm) +
                                          " mm has too many cells of " +
                                          std::to_string(x.pitch_mm) + " mm: at most 2^30");
  return {{x.first_mm, y.first_mm},
          {x.pitch_mm, y.pitch_mm},
          static_cast<std::uint32_t>(x.count),
          static_cast<std::uint32_t>(y.count)};
}

/// Walks along one ring after the other and notes the cells.
class Drawing {
 public:
  Drawing(const CellGrid& grid, const Ring& ring) : grid_(grid), ring_(ring) {}

  std::vector<CellStep> steps() {
    for (std::uint32_t edge = 0; edge < ring_.size(); ++edge) draw(edge);
    // Where the ring closes it is still in the cell in which it began.
    if (steps_.size() > 1 && steps_.back().cell == steps_.front().cell) {
      steps_.front().enter = steps_.back().enter;
      steps_.pop_back();
    }
    return std::move(steps_);
  }

 private:
  [[nodiscard]] Point2 in_cells(Point2 p) const {
    return {(p.x - grid_.first.x) / grid_.pitch_mm.x, (p.y - grid_.first.y) / grid_.pitch_mm.y};
  }

  void draw(std::uint32_t edge) {
    const Point2 from = ring_[edge], to = ring_[edge + 1 < ring_.size() ? edge + 1 : 0];
    const Point2 a = in_cells(from), b = in_cells(to);
    visit(edge, a, from);
    const bool level = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
    const double begin = level ? a.x : a.y, run = level ? b.x - a.x : b.y - a.y;
    if (run == 0) return;
    const double sign = run > 0 ? 1 : -1;
    const double last = nearest(begin + run);
    for (double at = nearest(begin); sign * at <= sign * last; at += sign) {
      const double middle = std::clamp((at - begin) / run, 0.0, 1.0);
      const double enter = std::clamp((at - sign / 2 - begin) / run, 0.0, 1.0);
      // The longer extent is exact: rounding it again could miss a column.
      const Point2 p = lerp(a, b, middle);
      visit(edge, level ? Point2{at, p.y} : Point2{p.x, at}, snap(lerp(from, to, enter)));
    }
    visit(edge, b, to);
  }

  void visit(std::uint32_t edge, Point2 in_cells, Point2 enter) {
    const auto number = [](double cells, std::uint32_t count) {
      return static_cast<std::uint32_t>(std::clamp(nearest(cells), 0.0, count - 1.0));
    };
    const std::uint32_t cell =
        grid_.cell(number(in_cells.x, grid_.columns), number(in_cells.y, grid_.rows));
    if (steps_.empty() || steps_.back().cell != cell) steps_.push_back({cell, {edge, enter}});
  }

  const CellGrid& grid_;
  const Ring& ring_;
  std::vector<CellStep> steps_;
};

/// Spans of cells between the crossings of rings with the rows of a grid.
std::vector<CellSpan> spans_inside(const CellGrid& grid, const std::vector<Ring>& rings) {
  const std::vector<Crossing> crossings =
      cross_lines(rings, {grid.first.y, grid.pitch_mm.y, grid.rows}, CrossingSearch::kBucket);
  const EvenLines columns{grid.first.x, grid.pitch_mm.x, grid.columns};
  std::vector<CellSpan> spans;
  // Every row has an even number of crossings, so pairs never span two rows.
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const double left = crossings[i].x, right = crossings[i + 1].x;
    const std::uint32_t first = columns.first_at_or_above(left);
    std::uint32_t end = columns.first_at_or_above(right);
    if (end < grid.columns && grid.x(end) == right) ++end;
    if (first < end) spans.push_back({crossings[i].line, first, end - 1, left, right});
  }
  return spans;
}

CellGrid transposed(const CellGrid& grid) {
  return {
      {grid.first.y, grid.first.x}, {grid.pitch_mm.y, grid.pitch_mm.x}, grid.rows, grid.columns};
}

std::vector<Ring> transposed(std::vector<Ring> rings) {
  for (Ring& ring : rings)
    for (Point2& p : ring) std::swap(p.x, p.y);
  return rings;
}

}  // namespace

Point2 CellGrid::centre(std::uint32_t cell) const noexcept {
  return snap(Point2{x(column(cell)), y(row(cell))});
}

CellGrid anchored_cells(const Box2& box, double pitch_mm) {
  return grid_over(anchored(box.lower.x, box.upper.x, pitch_mm),
                   anchored(box.lower.y, box.upper.y, pitch_mm));
}

CellGrid fitted_cells(const Box2& box, const PlanContext& context) {
  return grid_over(fitted(box.lower.x, box.upper.x, context),
                   fitted(box.lower.y, box.upper.y, context));
}

std::vector<CellStep> cells_of_ring(const CellGrid& grid, const Ring& ring) {
  return Drawing(grid, ring).steps();
}

CellMap map_cells(const CellGrid& grid, const Polygon& region) {
  CellMap map{grid, rings_of({region}), {}, {}, std::vector<std::uint8_t>(grid.size(), 0)};
  for (const Ring& ring : map.rings) {
    map.steps.push_back(cells_of_ring(grid, ring));
    for (const CellStep& step : map.steps.back()) map.flags[step.cell] |= kRimCell;
  }
  map.spans = spans_inside(grid, map.rings);
  for (const CellSpan& span : map.spans)
    for (std::uint32_t column = span.first; column <= span.last; ++column)
      map.flags[grid.cell(column, span.row)] |=
          column < span.last ? kInsideCell | kEastLink : kInsideCell;
  for (const CellSpan& span : spans_inside(transposed(grid), transposed(map.rings)))
    for (std::uint32_t row = span.first; row < span.last; ++row)
      map.flags[grid.cell(span.row, row)] |= kNorthLink;
  return map;
}

}  // namespace routebench
