#include "routebench/geometry/grid.hpp"

#include <gtest/gtest.h>

namespace routebench {
namespace {

TEST(Grid, SnappingIsIdempotentAndWithinHalfAUnit) {
  for (const double mm : {0.0, 0.1, -0.1, 1.0 / 3, 219.9999999, -1023.7, 0.45}) {
    const double snapped = snap(mm);
    EXPECT_EQ(snap(snapped), snapped);
    EXPECT_LE(std::abs(snapped - mm), 0.5 / kGridUnitsPerMm);
  }
}

TEST(Grid, IndicesAndCoordinatesMapWithoutLoss) {
  for (const std::int64_t units : {std::int64_t{0}, std::int64_t{1}, std::int64_t{-1},
                                   std::int64_t{1} << 40, -(std::int64_t{1} << 40) + 7})
    EXPECT_EQ(to_grid(from_grid(units)), units);
}

TEST(Grid, DifferencesOfGridPointsAreExact) {
  const double a = snap(100.1), b = snap(0.3);
  EXPECT_EQ(to_grid(a - b), to_grid(a) - to_grid(b));
}

}  // namespace
}  // namespace routebench
