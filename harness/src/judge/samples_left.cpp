#include "judge/samples_left.hpp"

#include <algorithm>
#include <utility>

namespace routebench::judging {

SamplesLeft::SamplesLeft(BitPlane samples) : left_(std::move(samples)), rows_(left_.grid().rows()) {
  look();
}

void SamplesLeft::look() {
  none_ = true;
  rows_removed_ = 0;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    rows_[row] = {};
    const BitPlane::Words used = left_.used(row);
    if (used.empty()) continue;
    const BitPlane::Word* words = left_.row(row);
    const BitPlane::Word* end = words + used.end;
    const auto any = [](BitPlane::Word word) { return word != 0; };
    const BitPlane::Word* first = std::find_if(words + used.first, end, any);
    if (first == end) continue;
    none_ = false;
    while (!any(*(end - 1))) --end;
    const auto step = [words](const BitPlane::Word* word) {
      return (word - words) * static_cast<std::ptrdiff_t>(BitPlane::kWordBits);
    };
    rows_[row] = {step(first), step(end)};
  }
}

bool SamplesLeft::any_near(Point2 a, Point2 b, double radius) const {
  const auto [left, right] = std::minmax(a.x, b.x);
  const auto [lower, upper] = std::minmax(a.y, b.y);
  const double end = std::min(upper + radius + 1, static_cast<double>(rows_.size()));
  for (double y = std::max(lower - radius, 0.0); y < end; y += 1) {
    const Span& span = rows_[static_cast<std::size_t>(y)];
    if (static_cast<double>(span.left) <= right + radius &&
        static_cast<double>(span.right) >= left - radius)
      return true;
  }
  return false;
}

void SamplesLeft::remove(Point2 a, Point2 b, double radius_mm) {
  if (none_) return;
  const SampleGrid& grid = left_.grid();
  const Point2 from = grid.to_steps(a);
  const Point2 to = grid.to_steps(b);
  const double radius = grid.to_steps(radius_mm);
  if (!any_near(from, to, radius)) return;
  visit_capsule_rows(from, to, radius, grid.rows(), [this](std::size_t row, Span near) {
    left_.remove(row, near.left, near.right);
    ++rows_removed_;
  });
  // To look costs about as much as these removals did.
  if (rows_removed_ > rows_.size()) look();
}

void SamplesLeft::remove(const Polygons& polygons, double radius_mm) {
  const auto remove_ring = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      remove(ring[i == 0 ? ring.size() - 1 : i - 1], ring[i], radius_mm);
  };
  if (none_) return;
  for (const Polygon& polygon : polygons) {
    remove_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) remove_ring(hole);
  }
}

}  // namespace routebench::judging
