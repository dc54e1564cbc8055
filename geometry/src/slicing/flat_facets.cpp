#include <algorithm>
#include <cmath>

#include "routebench/geometry/solid.hpp"

namespace routebench {
namespace {

constexpr double kLevelMm = 0.1;
constexpr double kNearMm = 0.8;
constexpr double kSlope = 0.2;
constexpr double kLayersBelow = 2;
constexpr double kLayersAbove = 1;

struct Extent {
  Point3 lower;
  Point3 upper;
};

Extent extent_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Point3 a = mesh.vertices[triangle[0]];
  Extent extent{a, a};
  for (const std::uint32_t corner : {triangle[1], triangle[2]}) {
    const Point3 p = mesh.vertices[corner];
    extent.lower = {std::min(extent.lower.x, p.x), std::min(extent.lower.y, p.y),
                    std::min(extent.lower.z, p.z)};
    extent.upper = {std::max(extent.upper.x, p.x), std::max(extent.upper.y, p.y),
                    std::max(extent.upper.z, p.z)};
  }
  return extent;
}

bool is_flat(const Extent& extent, FlatRule rule) {
  const double rise_mm = extent.upper.z - extent.lower.z;
  if (rule == FlatRule::kNear) return rise_mm <= kLevelMm;
  const double side_mm = std::max(extent.upper.x - extent.lower.x, extent.upper.y - extent.lower.y);
  return rise_mm < kSlope * side_mm;
}

}  // namespace

std::vector<bool> layers_with_flat_facets(const Mesh& mesh, FlatRule rule, double layer_height_mm,
                                          std::size_t layer_count) {
  // Plane k lies at (k + 1/2) layer heights.
  const auto place_of = [layer_height_mm](double z_mm) { return z_mm / layer_height_mm - 0.5; };
  std::vector<bool> dense(layer_count, false);
  const auto mark = [&dense](double first, double last) {
    const double end = static_cast<double>(dense.size());
    for (double k = std::max(first, 0.0); k <= last && k < end; k += 1)
      dense[static_cast<std::size_t>(k)] = true;
  };
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    const Extent extent = extent_of(mesh, triangle);
    if (!is_flat(extent, rule)) continue;
    if (rule == FlatRule::kSlope) {
      const double first_plane = std::ceil(place_of(extent.lower.z));
      mark(first_plane - kLayersBelow, first_plane + kLayersAbove);
    } else {
      // Strictly nearer.
      mark(std::floor(place_of(extent.lower.z - kNearMm)) + 1,
           std::ceil(place_of(extent.lower.z + kNearMm)) - 1);
    }
  }
  return dense;
}

}  // namespace routebench
