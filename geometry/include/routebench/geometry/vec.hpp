#pragma once
/// Arithmetic on points taken as vectors.

#include <cmath>

#include "routebench/geometry/types.hpp"

namespace routebench {

[[nodiscard]] constexpr Point2 operator+(Point2 a, Point2 b) noexcept {
  return {a.x + b.x, a.y + b.y};
}
[[nodiscard]] constexpr Point2 operator-(Point2 a, Point2 b) noexcept {
  return {a.x - b.x, a.y - b.y};
}
[[nodiscard]] constexpr Point2 operator*(double s, Point2 a) noexcept { return {s * a.x, s * a.y}; }

[[nodiscard]] constexpr double dot(Point2 a, Point2 b) noexcept { return a.x * b.x + a.y * b.y; }

/// z of the cross product; positive where b lies to the left of a.
[[nodiscard]] constexpr double cross(Point2 a, Point2 b) noexcept { return a.x * b.y - a.y * b.x; }

[[nodiscard]] constexpr double squared_distance(Point2 a, Point2 b) noexcept {
  return dot(b - a, b - a);
}
[[nodiscard]] inline double distance(Point2 a, Point2 b) noexcept {
  return std::sqrt(squared_distance(a, b));
}
/// The point at share t of the way from a to b.
[[nodiscard]] constexpr Point2 lerp(Point2 a, Point2 b, double t) noexcept {
  return a + t * (b - a);
}
/// The point of segment ab nearest to p.
[[nodiscard]] constexpr Point2 nearest_on_segment(Point2 p, Point2 a, Point2 b) noexcept {
  const Point2 d = b - a;
  const double length2 = dot(d, d);
  if (length2 <= 0) return a;
  const double t = dot(p - a, d) / length2;
  return t <= 0 ? a : t >= 1 ? b : lerp(a, b, t);
}

}  // namespace routebench
