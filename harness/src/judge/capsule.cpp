#include "judge/capsule.hpp"

#include <algorithm>

namespace routebench::judging {
namespace {

/// Which of some rows a row is, or else the first one or the end.
std::size_t place_in(const RowSpans& rows, std::int64_t row) {
  return static_cast<std::size_t>(std::clamp<std::int64_t>(
      row - static_cast<std::int64_t>(rows.first_row), 0, static_cast<std::int64_t>(rows.count)));
}

}  // namespace

void Capsule::cut_start(RowSpans& rows) const noexcept {
  const DiscShape start{.x = begins_low_ ? shape_.low_x : shape_.high_x,
                        .y = begins_low_ ? shape_.low_y : shape_.high_y,
                        .square = shape_.square};
  const std::size_t begin = place_in(rows, rounded_up(start.y - radius_));
  const std::size_t end = place_in(rows, rounded_down(start.y + radius_) + 1);
  if (begin < end) row_loops().cut_disc(start, begin, end, rows);
}

void Capsule::set_words(RowSpans& rows, std::size_t columns) const noexcept {
  double left = std::min(shape_.low_x, shape_.high_x);
  double right = std::max(shape_.low_x, shape_.high_x);
  if (shape_.slope != 0 && last_ - first_ >= static_cast<double>(RowSpans::kMost)) {
    // Of the centre line, what is within the radius of the rows.
    const auto x = [this](double y) {
      return shape_.low_x +
             shape_.slope * (std::clamp(y, shape_.low_y, shape_.high_y) - shape_.low_y);
    };
    const auto first = static_cast<double>(rows.first_row);
    const auto [a, b] =
        std::minmax({x(first - radius_), x(first + static_cast<double>(rows.count - 1) + radius_)});
    left = std::max(left, a);
    right = std::min(right, b);
  }
  const auto place = [columns](double column) {
    return std::clamp(column, 0.0, static_cast<double>(columns));
  };
  const auto first = static_cast<std::size_t>(static_cast<std::int64_t>(place(left - radius_ - 1)));
  const auto end = static_cast<std::size_t>(static_cast<std::int64_t>(place(right + radius_ + 2)));
  rows.first_word = first / kWordBits;
  rows.end_word = (end + kWordBits - 1) / kWordBits;
}

bool Capsule::fill(RowSpans& rows, std::size_t columns) const noexcept {
  rows.is_cut = false;
  set_words(rows, columns);
  if (rows.first_word >= rows.end_word) return false;
  const RowLoops& loops = row_loops();
  // Rows at which both ends are on straight sides take no square root, if they are worth a loop of
  // their own.
  constexpr std::size_t kFew = 8;
  std::size_t begin = 0;
  std::size_t end = 0;
  if (rows.count >= kFew) {
    begin = place_in(rows, rounded_up(std::max(shape_.left.begin, shape_.right.begin)));
    end = place_in(rows, rounded_down(std::min(shape_.left.end, shape_.right.end)) + 1);
  }
  if (begin + kFew <= end) {
    if (begin > 0) loops.rows(shape_, columns, 0, begin, rows);
    loops.straight_rows(shape_, columns, begin, end, rows);
    if (end < rows.count) loops.rows(shape_, columns, end, rows.count, rows);
  } else {
    loops.rows(shape_, columns, 0, rows.count, rows);
  }
  // No columns beyond the last row.
  std::fill_n(rows.left + rows.count, RowSpans::kRoom, 0);
  std::fill_n(rows.end + rows.count, RowSpans::kRoom, 0);
  return true;
}

}  // namespace routebench::judging
