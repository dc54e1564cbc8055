#include "slicing/straight_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

#include "routebench/geometry/vec.hpp"

namespace routebench::slicing {
namespace {

/// How far a point is from the line between its neighbours; more than any limit if the line turns
/// back there.
double height_mm(Point2 before, Point2 point, Point2 after) {
  constexpr double kFar = 1;
  const Point2 in = point - before, out = after - point, along = after - before;
  const double twice_area = cross(in, out), length2 = dot(along, along);
  if (dot(in, out) < 0 || twice_area * twice_area >= kStraightMm * kStraightMm * length2)
    return kFar;
  return length2 > 0 ? std::abs(twice_area) / std::sqrt(length2) : 0;
}

}  // namespace

void drop_straight_points(Ring& ring) {
  if (ring.size() < 4) return;
  // Where one begins may decide which of many points on a gentle curve are kept.
  std::rotate(
      ring.begin(),
      std::min_element(ring.begin(), ring.end(),
                       [](Point2 a, Point2 b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }),
      ring.end());
  std::vector<double> strayed(ring.size() + 1, 0);  // of the edge that ends at a kept point
  std::size_t kept = 1;
  for (std::size_t i = 1; i <= ring.size(); ++i) {
    const Point2 next = ring[i == ring.size() ? 0 : i];
    double strays = 0;
    for (; kept >= 2; --kept) {
      const double more =
          std::max(strays, strayed[kept - 1]) + height_mm(ring[kept - 2], ring[kept - 1], next);
      if (more >= kStraightMm) break;
      strays = more;
    }
    if (i == ring.size()) break;
    strayed[kept] = strays;
    ring[kept++] = next;
  }
  ring.resize(kept);
}

}  // namespace routebench::slicing
