#include "judge/capsule.hpp"

#include <algorithm>

namespace routebench::judging {

void Capsule::set_words(GridPart& part) const noexcept {
  double left = std::min(shape_.low_x, shape_.high_x);
  double right = std::max(shape_.low_x, shape_.high_x);
  const double radius = shape_.radius;
  if (shape_.slope != 0 && last_ - first_ >= static_cast<double>(kRowsAtOnce)) {
    // Of the centre line, what is within the radius of the rows.
    const auto x = [this](double y) {
      return shape_.low_x +
             shape_.slope * (std::clamp(y, shape_.low_y, shape_.high_y) - shape_.low_y);
    };
    const double a = x(static_cast<double>(part.first_row) - radius);
    const double b = x(static_cast<double>(part.end_row - 1) + radius);
    left = std::max(left, std::min(a, b));
    right = std::min(right, std::max(a, b));
  }
  const auto place = [&part](double column) {
    return static_cast<std::size_t>(
        static_cast<std::int64_t>(std::clamp(column, 0.0, static_cast<double>(part.columns))));
  };
  part.first_word = place(left - radius - 1) / kWordBits;
  part.end_word = (place(right + radius + 2) + kWordBits - 1) / kWordBits;
}

}  // namespace routebench::judging
