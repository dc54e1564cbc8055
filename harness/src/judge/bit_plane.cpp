#include "judge/bit_plane.hpp"

#include <algorithm>
#include <cmath>
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
    : grid_(&grid), row_words_((grid.columns() + kWordBits - 1) / kWordBits), used_(grid.rows()) {
  std::vector<std::vector<Word>>& cleared = cleared_words();
  if (!cleared.empty()) {
    words_ = std::move(cleared.back());
    cleared.pop_back();
  }
  if (words_.size() < row_words_ * grid.rows()) words_.resize(row_words_ * grid.rows());
}

BitPlane::~BitPlane() {
  if (words_.empty()) return;  // moved away
  for (std::size_t row = 0; row < used_.size(); ++row)
    visit_row(row, [this](std::size_t i) { words_[i] = 0; });
  cleared_words().push_back(std::move(words_));
}

BitPlane::BitPlane(const SampleGrid& grid, const Polygons& polygons) : BitPlane(grid) {
  if (used_.empty() || polygons.empty()) return;
  // Every edge flips its rows from where it crosses them onwards: what is flipped an odd number of
  // times is inside. A flip changes its own word; the words after it follow at the end.
  const auto add_edge = [this](Point2 a, Point2 b) {
    if (a.y > b.y) std::swap(a, b);
    // Rows with a.y <= row < b.y: half open, so that a vertex on a row counts once.
    const double first = std::max(std::ceil(a.y), 0.0);
    const double end = std::min(std::ceil(b.y), static_cast<double>(grid_->rows()));
    if (first >= end) return;
    const double slope = (b.x - a.x) / (b.y - a.y);
    for (auto row = static_cast<std::size_t>(first); row < static_cast<std::size_t>(end); ++row)
      flip_from(row, a.x + (static_cast<double>(row) - a.y) * slope);
  };
  const auto add_ring = [&](const Ring& ring) {
    if (ring.empty()) return;
    Point2 previous = grid_->to_steps(ring.back());
    for (const Point2 p : ring) {
      const Point2 next = grid_->to_steps(p);
      add_edge(previous, next);
      previous = next;
    }
  };
  for (const Polygon& polygon : polygons) {
    add_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) add_ring(hole);
  }

  const std::size_t tail = grid_->columns() % kWordBits;
  const Word last_mask = tail == 0 ? ~Word{0} : ~(~Word{0} << tail);
  for (std::size_t row = 0; row < used_.size(); ++row) {
    Word carry = 0;  // all ones while inside at a word's end
    visit_row(row, [&](std::size_t i) {
      words_[i] ^= carry;
      carry = Word{0} - (words_[i] >> (kWordBits - 1));
    });
    if (used_[row].end == row_words_) words_[(row + 1) * row_words_ - 1] &= last_mask;
  }
}

void BitPlane::flip_from(std::size_t row, double left) {
  const auto bit = static_cast<std::size_t>(rounded_up(std::max(left, 0.0)));
  if (bit >= grid_->columns()) {
    // Its partner's samples go on to the end of the row.
    used_[row].end = static_cast<std::uint32_t>(row_words_);
    return;
  }
  const auto word = static_cast<std::uint32_t>(bit / kWordBits);
  use(row, {word, word + 1});
  words_[row * row_words_ + word] ^= ~Word{0} << (bit % kWordBits);
}

std::size_t BitPlane::count() const {
  return count([](Word word) { return word; });
}

}  // namespace routebench::judging
