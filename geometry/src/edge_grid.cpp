#include "routebench/geometry/edge_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

// Crossings computed in floating point are off by less than this; nearer than this to an edge is on
// it.
constexpr double kOnEdgeMm = 4 / kGridUnitsPerMm;
constexpr double kFirstReach = 0.25;  // cells

// Both coordinates at once, in a vector of the compiler's own: std::min, std::max and std::clamp
// become branches, which nobody can foresee here.
using Pair = double __attribute__((vector_size(16)));

Pair pair_of(Point2 p) { return Pair{p.x, p.y}; }
Pair lesser(Pair a, Pair b) { return a < b ? a : b; }
Pair greater(Pair a, Pair b) { return a > b ? a : b; }

struct PairBox {
  Pair lower;
  Pair upper;

  PairBox(Point2 a, Point2 b)
      : lower(lesser(pair_of(a), pair_of(b))), upper(greater(pair_of(a), pair_of(b))) {}

  [[nodiscard]] bool is_apart_from(const PairBox& other) const {
    const auto apart = (upper < other.lower) | (lower > other.upper);
    return (apart[0] | apart[1]) != 0;
  }
  void widen(double margin_mm) {
    lower -= margin_mm;
    upper += margin_mm;
  }
};

}  // namespace

EdgeGrid::EdgeGrid(const Polygons& polygons) {
  const auto add_ring = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point2 a = ring[i], b = ring[i + 1 == ring.size() ? 0 : i + 1];
      if (a != b) edges_.push_back({a, b, 1 / squared_distance(a, b)});
    }
  };
  for (const Polygon& polygon : polygons) {
    add_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) add_ring(hole);
  }
  if (edges_.empty()) return;

  const Box2 box = bounding_box(polygons);
  lower_ = box.lower - Point2{kOnEdgeMm, kOnEdgeMm};
  upper_ = box.upper + Point2{kOnEdgeMm, kOnEdgeMm};
  const Point2 size = upper_ - lower_;
  // About one cell an edge; a long thin box gets at most as many cells along it as there are edges.
  const double count = static_cast<double>(edges_.size());
  cell_mm_ = std::max(std::sqrt(size.x * size.y / count), std::max(size.x, size.y) / count);
  column_count_ = static_cast<std::int64_t>(size.x / cell_mm_) + 1;
  row_count_ = static_cast<std::int64_t>(size.y / cell_mm_) + 1;

  // Two passes: how many items a bucket gets, then the items.
  std::vector<std::uint32_t> buckets_of;  // of all edges, one after the other
  std::vector<std::size_t> end_of;        // of each edge's
  end_of.reserve(edges_.size());
  const auto fill = [&](Buckets& buckets, std::int64_t bucket_count, auto&& for_buckets_of) {
    buckets.begin.assign(static_cast<std::size_t>(bucket_count) + 1, 0);
    buckets_of.clear();
    end_of.clear();
    for (const Edge& edge : edges_) {
      for_buckets_of(edge, [&](std::int64_t i) {
        ++buckets.begin[static_cast<std::size_t>(i) + 1];
        buckets_of.push_back(static_cast<std::uint32_t>(i));
      });
      end_of.push_back(buckets_of.size());
    }
    for (std::size_t i = 1; i < buckets.begin.size(); ++i) buckets.begin[i] += buckets.begin[i - 1];
    buckets.items.resize(buckets.begin.back());
    std::vector<std::uint32_t> next(buckets.begin.begin(), buckets.begin.end() - 1);
    std::size_t k = 0;
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      for (; k < end_of[e]; ++k) buckets.items[next[buckets_of[k]]++] = e;
  };
  fill(cells_, column_count_ * row_count_,
       [&](const Edge& edge, auto&& visit) { visit_cells(edge.a, edge.b, kOnEdgeMm, visit); });
  fill(rows_, row_count_, [&](const Edge& edge, auto&& visit) {
    const std::int64_t last_row = row(std::max(edge.a.y, edge.b.y));
    for (std::int64_t r = row(std::min(edge.a.y, edge.b.y)); r <= last_row; ++r) visit(r);
  });
}

std::int64_t EdgeGrid::column(double x) const {
  const double cell = (x - lower_.x) / cell_mm_;
  return static_cast<std::int64_t>(std::clamp(cell, 0.0, static_cast<double>(column_count_ - 1)));
}

std::int64_t EdgeGrid::row(double y) const {
  const double cell = (y - lower_.y) / cell_mm_;
  return static_cast<std::int64_t>(std::clamp(cell, 0.0, static_cast<double>(row_count_ - 1)));
}

EdgeGrid::Cells EdgeGrid::cells_of(double lower_x, double lower_y, double upper_x,
                                   double upper_y) const {
  const Pair origin = pair_of(lower_);
  const Pair last{static_cast<double>(column_count_ - 1), static_cast<double>(row_count_ - 1)};
  const auto cell = [&](Pair p) { return lesser(greater((p - origin) / cell_mm_, Pair{}), last); };
  const Pair first_cell = cell(Pair{lower_x, lower_y});
  const Pair last_cell = cell(Pair{upper_x, upper_y});
  return {.first_column = static_cast<std::int64_t>(first_cell[0]),
          .last_column = static_cast<std::int64_t>(last_cell[0]),
          .first_row = static_cast<std::int64_t>(first_cell[1]),
          .last_row = static_cast<std::int64_t>(last_cell[1])};
}

template <typename Visit>
void EdgeGrid::visit_cells(Point2 a, Point2 b, double margin_mm, Visit&& visit) const {
  if (a.y > b.y) std::swap(a, b);
  const double left = std::min(a.x, b.x);
  const double right = std::max(a.x, b.x);
  if (b.y + margin_mm < lower_.y || a.y - margin_mm > upper_.y || right + margin_mm < lower_.x ||
      left - margin_mm > upper_.x)
    return;
  // Rounding in the shares stays far below the margin; cells outside the box hold nothing.
  const double slack = margin_mm + kOnEdgeMm;
  const Cells cells = cells_of(left - slack, a.y - margin_mm, right + slack, b.y + margin_mm);
  const auto visit_row = [&](std::int64_t r, std::int64_t first_column, std::int64_t last_column) {
    for (std::int64_t c = first_column; c <= last_column; ++c) visit(r * column_count_ + c);
  };
  if (cells.first_row == cells.last_row || cells.first_column == cells.last_column) {
    for (std::int64_t r = cells.first_row; r <= cells.last_row; ++r)
      visit_row(r, cells.first_column, cells.last_column);
    return;
  }
  for (std::int64_t r = cells.first_row; r <= cells.last_row; ++r) {
    // The part of the segment that lies in this row, widened by the margin.
    const double bottom = lower_.y + static_cast<double>(r) * cell_mm_ - margin_mm;
    const double top = bottom + cell_mm_ + 2 * margin_mm;
    double x0 = a.x, x1 = b.x;
    if (b.y > a.y) {
      x0 = a.x + std::clamp((bottom - a.y) / (b.y - a.y), 0.0, 1.0) * (b.x - a.x);
      x1 = a.x + std::clamp((top - a.y) / (b.y - a.y), 0.0, 1.0) * (b.x - a.x);
    }
    const double low_x = std::min(x0, x1) - slack;
    const double high_x = std::max(x0, x1) + slack;
    if (high_x < lower_.x || low_x > upper_.x) continue;
    visit_row(r, column(low_x), column(high_x));
  }
}

std::vector<std::uint32_t> EdgeGrid::edges_near(Point2 a, Point2 b, double margin_mm) const {
  std::vector<std::uint32_t> found;
  if (edges_.empty()) return found;
  std::size_t cells_with_edges = 0;
  visit_cells(a, b, margin_mm, [&](std::int64_t cell) {
    const auto c = static_cast<std::size_t>(cell);
    if (cells_.begin[c] == cells_.begin[c + 1]) return;
    ++cells_with_edges;
    found.insert(found.end(), cells_.items.begin() + cells_.begin[c],
                 cells_.items.begin() + cells_.begin[c + 1]);
  });
  if (cells_with_edges <= 1) return found;  // a cell's are in order
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool EdgeGrid::contains(Point2 p) const {
  if (edges_.empty() || p.x < lower_.x || p.x > upper_.x || p.y < lower_.y || p.y > upper_.y)
    return false;
  // Even-odd along the ray to the right; half-open, so that a vertex on the ray counts once.
  bool inside = false;
  const auto r = static_cast<std::size_t>(row(p.y));
  for (std::uint32_t i = rows_.begin[r]; i < rows_.begin[r + 1]; ++i) {
    const Edge& edge = edges_[rows_.items[i]];
    if ((edge.a.y > p.y) == (edge.b.y > p.y)) continue;
    const double side = cross(edge.b - edge.a, p - edge.a);
    if ((side > 0) == (edge.b.y > edge.a.y)) inside = !inside;
  }
  return inside || distance_to_edge_mm(p, kOnEdgeMm).has_value();
}

std::vector<double> EdgeGrid::crossings(Point2 a, Point2 b) const {
  std::vector<double> shares;
  const double length = distance(a, b);
  if (length == 0) return shares;
  const Point2 direction = (1 / length) * (b - a);
  const auto add = [&](double along_mm) {
    if (along_mm >= -kOnEdgeMm && along_mm <= length + kOnEdgeMm)
      shares.push_back(std::clamp(along_mm / length, 0.0, 1.0));
  };
  for (const std::uint32_t e : edges_near(a, b, kOnEdgeMm)) {
    const Edge& edge = edges_[e];
    const double side_a = cross(direction, edge.a - a);
    const double side_b = cross(direction, edge.b - a);
    if (std::abs(side_a) <= kOnEdgeMm) add(dot(direction, edge.a - a));
    if (std::abs(side_b) <= kOnEdgeMm) add(dot(direction, edge.b - a));
    if ((side_a > kOnEdgeMm && side_b < -kOnEdgeMm) || (side_a < -kOnEdgeMm && side_b > kOnEdgeMm))
      add(dot(direction, lerp(edge.a, edge.b, side_a / (side_a - side_b)) - a));
  }
  std::sort(shares.begin(), shares.end());
  const auto same = [&](double s, double t) { return (t - s) * length <= kOnEdgeMm; };
  shares.erase(std::unique(shares.begin(), shares.end(), same), shares.end());
  return shares;
}

bool EdgeGrid::meets(Point2 a, Point2 b) const {
  if (edges_.empty()) return false;
  PairBox box(a, b);
  box.widen(kOnEdgeMm);
  // Whether both points lie on one side of line pq, further from it than what is on it.
  const auto on_one_side = [](Point2 p, Point2 q, Point2 first, Point2 second) {
    const Point2 way = q - p;
    const double on_line = kOnEdgeMm * 2 * std::max(std::abs(way.x), std::abs(way.y));
    const double side = cross(way, first - p);
    const double other = cross(way, second - p);
    return (side > on_line && other > on_line) || (side < -on_line && other < -on_line);
  };
  const auto any_meets = [&](std::int64_t first_cell, std::int64_t last_cell) {
    // The items of cells that follow each other do so, too.
    const std::uint32_t* const items = cells_.items.data();
    const std::uint32_t end = cells_.begin[static_cast<std::size_t>(last_cell) + 1];
    for (std::uint32_t i = cells_.begin[static_cast<std::size_t>(first_cell)]; i < end; ++i) {
      const Edge& edge = edges_[items[i]];
      if (!PairBox(edge.a, edge.b).is_apart_from(box) && !on_one_side(a, b, edge.a, edge.b) &&
          !on_one_side(edge.a, edge.b, a, b))
        return true;
    }
    return false;
  };
  // Most segments are short: all cells of their box are looked at sooner than those on the way are
  // found.
  constexpr std::int64_t kFewCells = 2;
  const Cells cells = cells_of(box.lower[0], box.lower[1], box.upper[0], box.upper[1]);
  bool met = false;
  if (cells.last_row - cells.first_row < kFewCells &&
      cells.last_column - cells.first_column < kFewCells) {
    for (std::int64_t r = cells.first_row; r <= cells.last_row && !met; ++r)
      met =
          any_meets(r * column_count_ + cells.first_column, r * column_count_ + cells.last_column);
  } else {
    visit_cells(a, b, kOnEdgeMm, [&](std::int64_t cell) { met = met || any_meets(cell, cell); });
  }
  return met;
}

double EdgeGrid::outside_length_mm(Point2 a, Point2 b) const {
  std::vector<double> shares = crossings(a, b);
  const double length = distance(a, b);
  if (shares.empty()) return length <= kOnEdgeMm || contains(lerp(a, b, 0.5)) ? 0 : length;
  shares.insert(shares.begin(), 0.0);
  shares.push_back(1.0);
  double outside = 0;
  for (std::size_t i = 1; i < shares.size(); ++i) {
    const double piece = (shares[i] - shares[i - 1]) * length;
    if (piece > kOnEdgeMm && !contains(lerp(a, b, (shares[i - 1] + shares[i]) / 2)))
      outside += piece;
  }
  return outside;
}

bool EdgeGrid::covers(Point2 a, Point2 b) const {
  return contains(a) && contains(b) && outside_length_mm(a, b) <= kOnEdgeMm;
}

std::optional<double> EdgeGrid::distance_to_edge_mm(Point2 p, double limit_mm) const {
  if (edges_.empty()) return std::nullopt;
  const Edge* nearest = nullptr;
  double nearest_squared = std::numeric_limits<double>::infinity();
  // Widening boxes around p: most questions end in the first.
  for (double reach = std::min(limit_mm, kFirstReach * cell_mm_);;
       reach = std::min(limit_mm, 2 * reach)) {
    // An edge in several cells is looked at more than once, which costs less than to sort them.
    const Cells cells = cells_of(p.x - reach, p.y - reach, p.x + reach, p.y + reach);
    for (std::int64_t r = cells.first_row; r <= cells.last_row; ++r) {
      // The cells of a row follow each other.
      const auto first = static_cast<std::size_t>(r * column_count_ + cells.first_column);
      const auto end = static_cast<std::size_t>(r * column_count_ + cells.last_column + 1);
      for (std::uint32_t i = cells_.begin[first]; i < cells_.begin[end]; ++i) {
        const Edge& edge = edges_[cells_.items[i]];
        const Point2 way = edge.b - edge.a, at = p - edge.a;
        double share = dot(at, way) * edge.per_squared_length;
        share = share > 0 ? share : 0;  // std::clamp becomes branches
        share = share < 1 ? share : 1;
        const Point2 off = at - share * way;
        const double squared = dot(off, off);
        if (squared >= nearest_squared) continue;
        nearest_squared = squared;
        nearest = &edge;
      }
    }
    if (nearest_squared <= reach * reach || reach >= limit_mm) break;
  }
  if (nearest == nullptr) return std::nullopt;
  const double nearest_mm = distance(p, nearest_on_segment(p, nearest->a, nearest->b));
  return nearest_mm <= limit_mm ? std::optional(nearest_mm) : std::nullopt;
}

}  // namespace routebench
