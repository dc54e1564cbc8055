#pragma once
/// Meshes made in memory, and an area to hold slices against.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench::test {

inline void append(Mesh& mesh, const Mesh& more) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles)
    mesh.triangles.push_back({a + offset, b + offset, c + offset});
}

inline Mesh together(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  append(mesh, b);
  return mesh;
}

inline Mesh moved(Mesh mesh, Point3 by) {
  for (Point3& p : mesh.vertices) p = {p.x + by.x, p.y + by.y, p.z + by.z};
  return mesh;
}

inline Mesh inside_out(Mesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

/// A wall over a counter-clockwise ring with flat ends; the ring must be star-shaped as seen from
/// the mean of its points.
inline Mesh prism(const Ring& ring, double z0_mm, double z1_mm) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(ring.size());
  Point2 middle;
  for (const Point2 p : ring) middle = middle + (1.0 / n) * p;
  for (const double z : {z0_mm, z1_mm}) {
    for (const Point2 p : ring) mesh.vertices.push_back({p.x, p.y, z});
    mesh.vertices.push_back({middle.x, middle.y, z});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n, top = n + 1;
    mesh.triangles.push_back({i, j, top + j});
    mesh.triangles.push_back({i, top + j, top + i});
    mesh.triangles.push_back({j, i, n});
    mesh.triangles.push_back({top + i, top + j, top + n});
  }
  return mesh;
}

inline Mesh box(Point3 lower, Point3 upper) {
  return prism({{lower.x, lower.y}, {upper.x, lower.y}, {upper.x, upper.y}, {lower.x, upper.y}},
               lower.z, upper.z);
}

/// A grid of n x m corners that closes on itself both ways.
template <typename At>
Mesh closed_grid(std::uint32_t n, std::uint32_t m, At&& at) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) mesh.vertices.push_back(at(i, j));
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < m; ++j) {
      const std::uint32_t i1 = (i + 1) % n, j1 = (j + 1) % m;
      mesh.triangles.push_back({i * m + j, i1 * m + j, i1 * m + j1});
      mesh.triangles.push_back({i * m + j, i1 * m + j1, i * m + j1});
    }
  return mesh;
}

/// A torus that lies flat on z = 0, or stands upright on it.
inline Mesh torus(double ring_mm, double tube_mm, std::uint32_t n, std::uint32_t m,
                  bool upright = false) {
  return closed_grid(n, m, [&](std::uint32_t i, std::uint32_t j) {
    const double u = 2 * std::numbers::pi * i / n, v = 2 * std::numbers::pi * j / m;
    const double r = ring_mm + tube_mm * std::cos(v);
    const Point3 flat{r * std::cos(u), r * std::sin(u), tube_mm * std::sin(v)};
    if (upright) return Point3{flat.y, flat.z, flat.x + ring_mm + tube_mm};
    return Point3{flat.x, flat.y, flat.z + tube_mm};
  });
}

/// The same solid with its triangles, their first corners and its vertices in another order.
inline Mesh shuffled(const Mesh& mesh, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> place(mesh.vertices.size());
  for (std::uint32_t v = 0; v < place.size(); ++v) place[v] = v;
  std::shuffle(place.begin(), place.end(), random);
  Mesh result;
  result.vertices.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < place.size(); ++v) result.vertices[place[v]] = mesh.vertices[v];
  for (std::array<std::uint32_t, 3> triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = place[corner];
    std::rotate(triangle.begin(), triangle.begin() + random() % 3, triangle.end());
    result.triangles.push_back(triangle);
  }
  std::shuffle(result.triangles.begin(), result.triangles.end(), random);
  return result;
}

/// Every triangle with three vertices of its own, each moved by up to jitter_mm along every axis.
inline Mesh unwelded(const Mesh& mesh, double jitter_mm, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-jitter_mm, jitter_mm);
  Mesh result;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t corner : triangle) {
      const Point3 p = mesh.vertices[corner];
      result.vertices.push_back({p.x + jitter(random), p.y + jitter(random), p.z + jitter(random)});
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// Area of the cut at a height, counted with winding numbers, by Green's formula over the triangles
/// and without joining anything: an obvious computation that shares nothing with the slicer. A
/// corner at the height counts as above it.
inline double cut_area_mm2(const Mesh& mesh, double z_mm) {
  double twice = 0;
  const Point2 origin{mesh.vertices.front().x, mesh.vertices.front().y};
  for (const auto& triangle : mesh.triangles) {
    Point2 down, up;
    int crossings = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 a = mesh.vertices[triangle[i]], b = mesh.vertices[triangle[(i + 1) % 3]];
      if ((a.z >= z_mm) == (b.z >= z_mm)) continue;
      const Point2 at = lerp({a.x, a.y}, {b.x, b.y}, (z_mm - a.z) / (b.z - a.z));
      (a.z >= z_mm ? down : up) = at - origin;
      ++crossings;
    }
    if (crossings == 2) twice += cross(down, up);
  }
  return twice / 2;
}

/// Signed volume by the divergence theorem.
inline double volume_mm3(const Mesh& mesh) {
  double six = 0;
  for (const auto& triangle : mesh.triangles) {
    const Point3 a = mesh.vertices[triangle[0]], b = mesh.vertices[triangle[1]],
                 c = mesh.vertices[triangle[2]];
    six += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
           a.z * (b.x * c.y - b.y * c.x);
  }
  return six / 6;
}

}  // namespace routebench::test
