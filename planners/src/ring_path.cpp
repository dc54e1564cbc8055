#include "routebench/planning/ring_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

constexpr std::size_t kPlaces = 16;  // of a ring from which it is looked at another

}  // namespace

bool comes_before(const Ring& ring, const RingPlace& a, const RingPlace& b) {
  if (a.edge != b.edge) return a.edge < b.edge;
  return squared_distance(ring[a.edge], a.point) < squared_distance(ring[b.edge], b.point);
}

std::vector<Point2> path_along(const Ring& ring, const RingPlace& from, const RingPlace& to) {
  const bool on_one_edge = from.edge == to.edge && comes_before(ring, from, to);
  const std::size_t corners =
      on_one_edge ? 0 : to.edge + (to.edge > from.edge ? 0 : ring.size()) - from.edge;
  std::vector<Point2> path;
  path.reserve(corners + 2);
  path.push_back(from.point);
  const auto go_to = [&](Point2 p) {
    if (p != path.back()) path.push_back(p);
  };
  std::uint32_t edge = from.edge;
  for (std::size_t i = 0; i < corners; ++i) {
    edge = edge + 1 < ring.size() ? edge + 1 : 0;
    go_to(ring[edge]);
  }
  go_to(to.point);
  return path;
}

NearPlace nearest_place(const Ring& ring, Point2 p) {
  NearPlace best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < ring.size(); ++i) {
    const Point2 foot = nearest_on_segment(p, ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]);
    const double squared = squared_distance(p, foot);
    if (squared >= least) continue;
    least = squared;
    best.place = {i, foot};
  }
  best.distance_mm = std::sqrt(least);
  return best;
}

std::vector<RingPlace> spread_places(const Ring& ring, std::size_t count) {
  const double step_mm = perimeter_mm(ring) / static_cast<double>(count);
  std::vector<RingPlace> places;
  double along_mm = 0;  // of the next place, from the edge's start
  for (std::uint32_t i = 0; i < ring.size() && places.size() < count; ++i) {
    const Point2 a = ring[i], b = ring[i + 1 < ring.size() ? i + 1 : 0];
    const double edge_mm = distance(a, b);
    for (; along_mm < edge_mm && places.size() < count; along_mm += step_mm)
      places.push_back({i, lerp(a, b, along_mm / edge_mm)});
    along_mm -= edge_mm;
  }
  return places;
}

double distance_of(const Ring& from, const Ring& to) {
  double least = std::numeric_limits<double>::infinity();
  for (const RingPlace& place : spread_places(from, kPlaces))
    least = std::min(least, nearest_place(to, place.point).distance_mm);
  return least;
}

double length_mm(const std::vector<Point2>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += distance(points[i - 1], points[i]);
  return sum;
}

}  // namespace routebench
