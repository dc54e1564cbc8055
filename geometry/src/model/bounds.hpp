#pragma once
/// Boxes around points.

#include <algorithm>
#include <cmath>
#include <limits>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// The smallest box, parallel to the axes, around what was added.
struct Bounds {
  Point3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
  Point3 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity()};

  void add(const Point3& p) noexcept {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  void add(const Bounds& other) noexcept {
    if (other.empty()) return;
    add(other.lower);
    add(other.upper);
  }
  [[nodiscard]] bool empty() const noexcept { return lower.x > upper.x; }
  [[nodiscard]] bool contains(const Bounds& other) const noexcept {
    return lower.x <= other.lower.x && lower.y <= other.lower.y && lower.z <= other.lower.z &&
           upper.x >= other.upper.x && upper.y >= other.upper.y && upper.z >= other.upper.z;
  }
  [[nodiscard]] Point3 size() const noexcept {
    return {upper.x - lower.x, upper.y - lower.y, upper.z - lower.z};
  }
  [[nodiscard]] Point3 middle() const noexcept {
    return {lower.x / 2 + upper.x / 2, lower.y / 2 + upper.y / 2, lower.z / 2 + upper.z / 2};
  }
  [[nodiscard]] double largest_side() const noexcept {
    const Point3 s = size();
    return std::max({s.x, s.y, s.z});
  }
  [[nodiscard]] double diagonal() const noexcept {
    const Point3 s = size();
    return std::hypot(s.x, s.y, s.z);
  }
};

/// The box around all vertices of a mesh.
[[nodiscard]] Bounds bounds_of(const Mesh& mesh, const ParallelFor& parallel_for);

}  // namespace routebench::models
