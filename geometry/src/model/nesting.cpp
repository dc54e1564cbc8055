#include "model/nesting.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace routebench::models {
namespace {

/// The lowest vertex of every shell that takes part: of several the one with the least y, then x.
std::vector<Point3> lowest_points(const Mesh& mesh,
                                  std::span<const std::uint32_t> shell_of_triangle,
                                  std::size_t shells) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<Point3> lowest(shells, {kFar, kFar, kFar});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Point3& best = lowest[shell_of_triangle[t]];
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Point3& p = mesh.vertices[v];
      if (std::tie(p.z, p.y, p.x) < std::tie(best.z, best.y, best.x)) best = p;
    }
  }
  return lowest;
}

/// Points in square bins over the xy plane.
class PointBins {
 public:
  PointBins(const std::vector<Point3>& points, std::span<const Bounds> shells) {
    std::size_t used = 0;
    for (std::size_t s = 0; s < points.size(); ++s) {
      if (shells[s].empty()) continue;
      bounds_.add(points[s]);
      ++used;
    }
    across_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(used)));
    bins_.resize(across_ * across_);
    for (std::uint32_t s = 0; s < points.size(); ++s) {
      if (shells[s].empty()) continue;
      bins_[row(points[s].y) * across_ + column(points[s].x)].push_back(s);
    }
  }

  /// Calls visit(shell) for every point in the bins that a box touches.
  template <typename Visit>
  void for_each_near(const Bounds& box, Visit&& visit) const {
    if (box.upper.x < bounds_.lower.x || box.lower.x > bounds_.upper.x ||
        box.upper.y < bounds_.lower.y || box.lower.y > bounds_.upper.y) {
      return;
    }
    for (std::size_t r = row(box.lower.y); r <= row(box.upper.y); ++r) {
      for (std::size_t c = column(box.lower.x); c <= column(box.upper.x); ++c) {
        for (const std::uint32_t shell : bins_[r * across_ + c]) visit(shell);
      }
    }
  }

 private:
  [[nodiscard]] std::size_t place(double at, double low, double high) const {
    if (!(at > low)) return 0;
    if (at >= high) return across_ - 1;
    const double share = (at - low) / (high - low);
    return std::min(across_ - 1, static_cast<std::size_t>(share * static_cast<double>(across_)));
  }
  [[nodiscard]] std::size_t row(double y) const {
    return place(y, bounds_.lower.y, bounds_.upper.y);
  }
  [[nodiscard]] std::size_t column(double x) const {
    return place(x, bounds_.lower.x, bounds_.upper.x);
  }

  Bounds bounds_;
  std::size_t across_ = 1;
  std::vector<std::vector<std::uint32_t>> bins_;
};

/// Twice the area of the triangle a, b, p over the xy plane; the sign says on which side of ab the
/// point lies. Computed from the lesser of a and b to the greater, so that two triangles with a
/// common side never disagree.
double side_of(const Point3& a, const Point3& b, const Point3& p) noexcept {
  const bool swapped = std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z);
  const Point3& from = swapped ? b : a;
  const Point3& to = swapped ? a : b;
  const double area = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
  return swapped ? -area : area;
}

/// How often the line upwards from p runs out of (+1) or into (-1) the solid through a triangle.
///
/// Half-open in y and x, as for a point in a polygon: a line through a vertex or an edge meets
/// exactly one of the triangles around it on each side.
int crossing_above(const std::array<Point3, 3>& t, const Point3& p) noexcept {
  int winding = 0;
  std::array<double, 3> area{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3& a = t[i];
    const Point3& b = t[(i + 1) % 3];
    area[i] = side_of(a, b, p);
    if (a.y <= p.y && b.y > p.y && area[i] > 0) ++winding;
    if (a.y > p.y && b.y <= p.y && area[i] < 0) --winding;
  }
  if (winding == 0) return 0;
  const double whole = area[0] + area[1] + area[2];
  if (whole == 0) return 0;
  const double z = (t[0].z * area[1] + t[1].z * area[2] + t[2].z * area[0]) / whole;
  return z > p.z ? winding : 0;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> enclosing_shells(
    const Mesh& mesh, std::span<const std::uint32_t> shell_of_triangle,
    std::span<const Bounds> shell_bounds) {
  const std::vector<Point3> points = lowest_points(mesh, shell_of_triangle, shell_bounds.size());
  const PointBins bins(points, shell_bounds);
  struct Crossing {
    std::uint32_t inner;
    std::uint32_t outer;
    int winding;
  };
  std::vector<Crossing> crossings;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t outer = shell_of_triangle[t];
    if (shell_bounds[outer].empty()) continue;
    std::array<Point3, 3> corners;
    Bounds box;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = mesh.vertices[mesh.triangles[t][i]];
      box.add(corners[i]);
    }
    bins.for_each_near(box, [&](std::uint32_t inner) {
      if (inner == outer || !shell_bounds[outer].contains(shell_bounds[inner])) return;
      const int winding = crossing_above(corners, points[inner]);
      if (winding != 0) crossings.push_back({inner, outer, winding});
    });
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return std::tie(a.inner, a.outer) < std::tie(b.inner, b.outer);
  });
  std::vector<std::vector<std::uint32_t>> around(shell_bounds.size());
  for (std::size_t first = 0, next = 0; first < crossings.size(); first = next) {
    int winding = 0;
    const auto [inner, outer, unused] = crossings[first];
    for (; next < crossings.size() && crossings[next].inner == inner &&
           crossings[next].outer == outer;
         ++next) {
      winding += crossings[next].winding;
    }
    if (winding != 0) around[inner].push_back(outer);
  }
  return around;
}

}  // namespace routebench::models
