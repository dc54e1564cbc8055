#include "judge/bit_plane.hpp"

#include <algorithm>
#include <utility>

namespace routebench::judging {

BitPlane::BitPlane(const SampleGrid& grid, const Polygons& polygons) : BitPlane(grid) {
  if (words_.empty() || polygons.empty()) return;
  // Every edge flips its rows from where it crosses them onwards: what is flipped an odd number of
  // times is inside. The flips are kept as one bit each and summed along the rows at the end.
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
  for (std::size_t begin = 0; begin < words_.size(); begin += row_words_) {
    Word carry = 0;  // all ones while inside at a word's end
    for (std::size_t i = begin; i < begin + row_words_; ++i) {
      Word word = words_[i];
      if (word == 0) {  // nothing changes here
        words_[i] = carry;
        continue;
      }
      for (unsigned shift = 1; shift < kWordBits; shift *= 2) word ^= word << shift;
      words_[i] = word ^ carry;
      carry = (words_[i] >> (kWordBits - 1) & 1U) != 0 ? ~Word{0} : 0;
    }
    words_[begin + row_words_ - 1] &= last_mask;
  }
}

void BitPlane::flip_from(std::size_t row, double left) {
  const double column = std::max(std::ceil(left), 0.0);
  if (column >= static_cast<double>(grid_->columns())) return;
  const auto bit = static_cast<std::size_t>(column);
  words_[row * row_words_ + bit / kWordBits] ^= Word{1} << (bit % kWordBits);
}

std::size_t BitPlane::count() const {
  return count([](Word word) { return word; });
}

}  // namespace routebench::judging
