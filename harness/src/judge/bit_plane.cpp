#include "judge/bit_plane.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "judge/rounding.hpp"

namespace routebench::judging {
namespace {

/// Words of planes that are gone, all 0 again: clearing what a plane has used is cheaper than new
/// memory for the box of each layer.
std::vector<std::vector<BitPlane::Word>>& cleared_words() {
  thread_local std::vector<std::vector<BitPlane::Word>> words;
  return words;
}

}  // namespace

BitPlane::BitPlane(const SampleGrid& grid)
    : grid_(&grid),
      used_((grid.columns() + kWordBits - 1) / kWordBits, Rows{.first = grid.rows(), .end = 0}) {
  std::vector<std::vector<Word>>& cleared = cleared_words();
  if (!cleared.empty()) {
    words_ = std::move(cleared.back());
    cleared.pop_back();
  }
  const std::size_t size = strips() * grid.rows() + StripWords::kRoom;
  if (words_.size() < size) words_.resize(size);
}

BitPlane::~BitPlane() {
  if (words_.empty()) return;  // moved away
  for (std::size_t strip = 0; strip < strips(); ++strip)
    if (const Rows used = used_[strip]; used.first < used.end)
      std::fill_n(words_.data() + place(strip, used.first), used.end - used.first, Word{0});
  cleared_words().push_back(std::move(words_));
}

BitPlane::BitPlane(const SampleGrid& grid, const Polygons& polygons) : BitPlane(grid) {
  if (used_.empty() || polygons.empty()) return;
  const auto flip_right_of_ring = [&](const Ring& ring) {
    if (ring.empty()) return;
    Point2 previous = grid_->to_steps(ring.back());
    for (const Point2 p : ring) {
      const Point2 next = grid_->to_steps(p);
      flip_right_of(previous, next);
      previous = next;
    }
  };
  for (const Polygon& polygon : polygons) {
    flip_right_of_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) flip_right_of_ring(hole);
  }
  fill_between_flips();
}

/// Flips the rows that an edge crosses from there onwards: what is flipped an odd number of times
/// in all is inside. A flip changes its own word; the words after it follow at the end.
void BitPlane::flip_right_of(Point2 a, Point2 b) {
  if (a.y > b.y) std::swap(a, b);
  // Rows with a.y <= row < b.y: half open, so that a vertex on a row counts once.
  const std::int64_t first = std::max<std::int64_t>(rounded_up(a.y), 0);
  const std::int64_t end = std::min(rounded_up(b.y), static_cast<std::int64_t>(grid_->rows()));
  if (first >= end) return;
  const LineShape line{.x = a.x, .y = a.y, .slope = (b.x - a.x) / (b.y - a.y)};
  const auto strip_at = [&](std::int64_t row) {
    const std::int64_t column = rounded_up(line.at(static_cast<double>(row)));
    return std::min(static_cast<std::size_t>(std::max<std::int64_t>(column, 0)) / kWordBits,
                    strips());
  };
  for (std::int64_t row = first; row < end;) {
    // So few that the line is in few strips.
    constexpr std::int64_t kRowsAtOnce = 64;
    const std::int64_t end_of_some = std::min(row + kRowsAtOnce, end);
    const std::size_t from = strip_at(row);
    const std::size_t to = strip_at(end_of_some - 1);
    const std::size_t first_strip = std::min(from, to);
    // Beyond the last strip its partner's flips go on to the end of the row.
    const std::size_t end_strip = std::min(std::max(from, to) + 1, strips());
    const auto begin_row = static_cast<std::size_t>(row);
    const auto end_row = static_cast<std::size_t>(end_of_some);
    row_loops().flip(line, begin_row, end_row, first_strip, end_strip, words_.data(),
                     grid_->rows());
    for (std::size_t strip = first_strip; strip < end_strip; ++strip)
      use(strip, begin_row, end_row);
    row = end_of_some;
  }
}

void BitPlane::fill_between_flips() {
  const auto fill = row_loops().fill;
  // Rows that are inside at the end of the strip before.
  std::vector<Word> carry(grid_->rows());
  Rows carried{.first = grid_->rows(), .end = 0};
  for (std::size_t strip = 0; strip < strips(); ++strip) {
    if (carried.first < carried.end) use(strip, carried.first, carried.end);
    const Rows used = used_[strip];
    if (used.first >= used.end) continue;
    fill(words_.data() + place(strip, used.first), carry.data() + used.first,
         used.end - used.first);
    carried = used;
    while (carried.first < carried.end && carry[carried.first] == 0) ++carried.first;
    while (carried.first < carried.end && carry[carried.end - 1] == 0) --carried.end;
  }
  if (const std::size_t tail = grid_->columns() % kWordBits; tail != 0)
    for (std::size_t row = used_.back().first; row < used_.back().end; ++row)
      words_[place(strips() - 1, row)] &= ~(~Word{0} << tail);
}

std::size_t BitPlane::count_in(const BitPlane* with, const BitPlane* without) const {
  const auto words_of = [](const BitPlane* plane) {
    return plane == nullptr ? nullptr : plane->words_.data();
  };
  return row_loops().count({words_.data(), grid_->rows(), strips(), used_.data()}, words_of(with),
                           words_of(without));
}

}  // namespace routebench::judging
