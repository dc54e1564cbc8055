#include "routebench/planning/nearest_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "routebench/geometry/vec.hpp"

namespace routebench {

NearestGrid::NearestGrid(std::vector<Point2> points)
    : points_(std::move(points)), slot_(points_.size(), 0), left_(points_.size()) {
  build();
}

void NearestGrid::build() {
  built_with_ = left_;
  if (left_ == 0) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  lower_ = {kInfinity, kInfinity};
  upper_ = {-kInfinity, -kInfinity};
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (!has(i)) continue;
    lower_ = {std::min(lower_.x, points_[i].x), std::min(lower_.y, points_[i].y)};
    upper_ = {std::max(upper_.x, points_[i].x), std::max(upper_.y, points_[i].y)};
  }
  // About one cell a point; a box that is nearly a line has no more cells along it than points.
  const Point2 size = upper_ - lower_;
  const double count = static_cast<double>(left_);
  cell_mm_ = std::max(std::sqrt(size.x * size.y / count), std::max(size.x, size.y) / count);
  if (!(cell_mm_ > 0)) cell_mm_ = 1;
  columns_ = static_cast<std::int64_t>(size.x / cell_mm_) + 1;
  rows_ = static_cast<std::int64_t>(size.y / cell_mm_) + 1;

  cell_begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (std::uint32_t i = 0; i < points_.size(); ++i)
    if (has(i)) ++cell_begin_[cell_of(points_[i]) + 1];
  for (std::size_t c = 1; c < cell_begin_.size(); ++c) cell_begin_[c] += cell_begin_[c - 1];
  cell_end_.assign(cell_begin_.begin(), cell_begin_.end() - 1);
  items_.resize(left_);
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (!has(i)) continue;
    slot_[i] = cell_end_[cell_of(points_[i])]++;
    items_[slot_[i]] = i;
  }
}

std::int64_t NearestGrid::column(double x) const {
  return std::min(static_cast<std::int64_t>((x - lower_.x) / cell_mm_), columns_ - 1);
}

std::int64_t NearestGrid::row(double y) const {
  return std::min(static_cast<std::int64_t>((y - lower_.y) / cell_mm_), rows_ - 1);
}

std::size_t NearestGrid::cell_of(Point2 p) const {
  return static_cast<std::size_t>(row(p.y) * columns_ + column(p.x));
}

void NearestGrid::look_into(std::int64_t column, std::int64_t row, Point2 from, Best& best) const {
  const std::size_t cell = static_cast<std::size_t>(row * columns_ + column);
  for (std::uint32_t slot = cell_begin_[cell]; slot < cell_end_[cell]; ++slot) {
    const std::uint32_t point = items_[slot];
    const double squared = squared_distance(points_[point], from);
    if (squared < best.squared_mm || (squared == best.squared_mm && point < best.point))
      best = {squared, point};
  }
}

std::optional<std::uint32_t> NearestGrid::nearest(Point2 from) const {
  if (left_ == 0) return std::nullopt;
  // A start outside of the box is moved to its border: to every point of the box it is then farther
  // by at least what it was moved (Pythagoras with an obtuse angle).
  const Point2 at{std::clamp(from.x, lower_.x, upper_.x), std::clamp(from.y, lower_.y, upper_.y)};
  const double outside = squared_distance(from, at);
  const std::int64_t c = column(at.x), r = row(at.y);
  Best best{std::numeric_limits<double>::infinity(), kTaken};
  const std::int64_t last_shell = std::max({c, r, columns_ - 1 - c, rows_ - 1 - r});
  for (std::int64_t shell = 0; shell <= last_shell; ++shell) {
    // Points in this shell of cells or beyond are no nearer than the cells in between are wide. A
    // little less, as a point next to a cell's border may have been rounded over it.
    const double reach = std::max(0.0, static_cast<double>(shell - 1) - 1e-6) * cell_mm_;
    if (outside + reach * reach > best.squared_mm) break;
    const std::int64_t left = std::max<std::int64_t>(c - shell, 0);
    const std::int64_t right = std::min(c + shell, columns_ - 1);
    for (std::int64_t y = std::max<std::int64_t>(r - shell, 0); y <= std::min(r + shell, rows_ - 1);
         ++y) {
      if (y == r - shell || y == r + shell) {
        for (std::int64_t x = left; x <= right; ++x) look_into(x, y, from, best);
      } else {
        if (c - shell >= 0) look_into(c - shell, y, from, best);
        if (c + shell < columns_) look_into(c + shell, y, from, best);
      }
    }
  }
  return best.point;
}

void NearestGrid::remove(std::uint32_t point) {
  if (!has(point)) return;
  // The last point of the cell takes its place.
  const std::uint32_t slot = slot_[point];
  const std::uint32_t last = --cell_end_[cell_of(points_[point])];
  items_[slot] = items_[last];
  slot_[items_[slot]] = slot;
  slot_[point] = kTaken;
  --left_;
  if (left_ > 0 && 4 * left_ <= built_with_) build();
}

}  // namespace routebench
