#include "routebench/planning/ring_path.hpp"

#include "routebench/geometry/vec.hpp"

namespace routebench {

bool comes_before(const Ring& ring, const RingPlace& a, const RingPlace& b) {
  if (a.edge != b.edge) return a.edge < b.edge;
  return squared_distance(ring[a.edge], a.point) < squared_distance(ring[b.edge], b.point);
}

std::vector<Point2> path_along(const Ring& ring, const RingPlace& from, const RingPlace& to) {
  std::vector<Point2> path{from.point};
  const auto go_to = [&](Point2 p) {
    if (p != path.back()) path.push_back(p);
  };
  std::uint32_t edge = from.edge;
  if (from.edge != to.edge || !comes_before(ring, from, to)) {
    do {
      edge = edge + 1 < ring.size() ? edge + 1 : 0;
      go_to(ring[edge]);
    } while (edge != to.edge);
  }
  go_to(to.point);
  return path;
}

double length_mm(const std::vector<Point2>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += distance(points[i - 1], points[i]);
  return sum;
}

}  // namespace routebench
