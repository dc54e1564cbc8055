#include "judge/beside.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "judge/cell_rows.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::judging {
namespace {

constexpr double kMaxCells = 1048576;  // 2^20
constexpr double kSurelyMm = 1e-6;     // far above what arithmetic loses

struct Segment {
  Point2 a;
  Point2 b;
};

/// Centre lines by the cells of a grid along the axes in which they begin.
class CentreLines {
 public:
  CentreLines(const std::vector<Run>& runs, const Box2& box, double reach_mm)
      : reach_mm_(std::max(reach_mm - kSurelyMm, 0.0)), lower_(box.lower) {
    visit_beads(runs, [this](Point2 a, Point2 b, double) { lines_.push_back({a, b}); });
    const Point2 size = box.upper - box.lower;
    const double cell_mm = std::max({4 * reach_mm, std::sqrt(size.x * size.y / kMaxCells),
                                     std::max(size.x, size.y) / kMaxCells});
    cells_a_mm_ = 1 / cell_mm;
    columns_ = static_cast<std::size_t>(size.x * cells_a_mm_) + 1;
    rows_ = static_cast<std::size_t>(size.y * cells_a_mm_) + 1;
    begin_.assign(columns_ * rows_ + 1, 0);
    std::vector<std::uint32_t> cells;
    cells.reserve(lines_.size());
    for (const Segment& line : lines_) {
      cells.push_back(static_cast<std::uint32_t>(row(line.a.y) * columns_ + column(line.a.x)));
      ++begin_[cells.back() + 1];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    in_cells_.resize(lines_.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t line = 0; line < cells.size(); ++line) in_cells_[next[cells[line]]++] = line;
  }

  [[nodiscard]] std::size_t size() const noexcept { return lines_.size(); }

  /// Whether segment ab lies in reach of one line. Beads are convex: its ends say it.
  [[nodiscard]] bool reaches(std::size_t line, Point2 a, Point2 b) const {
    return reaches(lines_[line], a) && reaches(lines_[line], b);
  }

  /// A line that reaches segment ab, among those that begin or end near a.
  [[nodiscard]] std::optional<std::size_t> find(Point2 a, Point2 b) const {
    const std::size_t last_row = row(a.y + reach_mm_);
    const std::size_t last_column = column(a.x + reach_mm_);
    for (std::size_t r = row(a.y - reach_mm_); r <= last_row; ++r)
      for (std::size_t c = column(a.x - reach_mm_); c <= last_column; ++c)
        for (std::uint32_t i = begin_[r * columns_ + c]; i < begin_[r * columns_ + c + 1]; ++i) {
          const std::size_t line = in_cells_[i];
          if (reaches(line, a, b)) return line;
          // The one before it ends where it begins.
          if (line > 0 && reaches(line - 1, a, b)) return line - 1;
        }
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool reaches(const Segment& line, Point2 p) const {
    const Point2 run = line.b - line.a;
    const Point2 way = p - line.a;
    const double along = dot(way, run);
    const double square = reach_mm_ * reach_mm_;
    if (along <= 0) return dot(way, way) <= square;
    const double length2 = dot(run, run);
    if (along >= length2) return squared_distance(p, line.b) <= square;
    const double aside = cross(run, way);
    return aside * aside <= square * length2;
  }

  [[nodiscard]] std::size_t column(double x) const {
    return nearest_cell((x - lower_.x) * cells_a_mm_, columns_);
  }
  [[nodiscard]] std::size_t row(double y) const {
    return nearest_cell((y - lower_.y) * cells_a_mm_, rows_);
  }

  double reach_mm_;
  Point2 lower_;
  double cells_a_mm_ = 1;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<Segment> lines_;           // in the order of the route
  std::vector<std::uint32_t> in_cells_;  // cell by cell
  std::vector<std::uint32_t> begin_;     // of cell c: in_cells_[begin_[c] .. begin_[c + 1])
};

/// Goes along the boundary and the beads.
class Walk {
 public:
  explicit Walk(const CentreLines& lines, double reach_mm)
      : lines_(lines), shortest_mm_(reach_mm / 8) {}

  /// Whether the walk gets along segment ab. Takes what is not beside one bead in halves.
  [[nodiscard]] bool goes(Point2 a, Point2 b) {
    for (const std::size_t line : {beside_, beside_ + 1, beside_ - 1})
      if (line < lines_.size() && lines_.reaches(line, a, b)) {
        beside_ = line;
        return true;
      }
    if (squared_distance(a, b) > shortest_mm_ * shortest_mm_) {
      const Point2 middle = lerp(a, b, 0.5);
      return goes(a, middle) && goes(middle, b);
    }
    const std::optional<std::size_t> found = lines_.find(a, b);
    if (found) beside_ = *found;
    return found.has_value();
  }

 private:
  const CentreLines& lines_;
  double shortest_mm_;
  std::size_t beside_ = 0;  // the line that reached what lies behind
};

}  // namespace

bool is_surely_reached(const Polygons& polygons, const std::vector<Run>& runs, double reach_mm) {
  const CentreLines lines(runs, bounding_box(polygons), reach_mm);
  Walk walk(lines, reach_mm);
  const auto goes_round = [&walk](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (!walk.goes(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1])) return false;
    return true;
  };
  return std::all_of(polygons.begin(), polygons.end(), [&](const Polygon& polygon) {
    return goes_round(polygon.outer) &&
           std::all_of(polygon.holes.begin(), polygon.holes.end(), goes_round);
  });
}

}  // namespace routebench::judging
