#include "chordal_axis.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>

#include <cmath>
#include <utility>

#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

constexpr std::uint32_t kOutside = UINT32_MAX;
constexpr std::uint32_t kUnseen = UINT32_MAX - 1;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<std::uint32_t, Kernel>>;
using Data =
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>, FaceBase>;
// Rings may touch, so a vertex may lie on another ring's edge.
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Data, CGAL::Exact_predicates_tag>;
using Face = Triangulation::Face_handle;

// Points that follow each other along a straight side turn all triangles between them and the side
// across, one by one: few of them are still faster in than sorted.
constexpr std::size_t kFewPoints = 512;

/// The points of a ring, no two of them farther apart than step_mm; none if it has no area.
std::vector<Kernel::Point_2> points_along(const Ring& ring, double step_mm) {
  std::vector<Kernel::Point_2> points;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 a = ring[i], b = ring[i + 1 < ring.size() ? i + 1 : 0];
    if (a == b) continue;
    const int steps = static_cast<int>(distance(a, b) / step_mm) + 1;
    for (int k = 0; k < steps; ++k) {
      const Point2 p = lerp(a, b, static_cast<double>(k) / steps);
      points.emplace_back(p.x, p.y);
    }
  }
  if (points.size() < 3) points.clear();
  return points;
}

void insert(const Ring& ring, double step_mm, Triangulation& triangulation) {
  const std::vector<Kernel::Point_2> points = points_along(ring, step_mm);
  if (points.size() <= kFewPoints)
    return triangulation.insert_constraint(points.begin(), points.end(), true);
  std::vector<std::pair<std::size_t, std::size_t>> sides{{points.size() - 1, 0}};
  for (std::size_t i = 1; i < points.size(); ++i) sides.emplace_back(i - 1, i);
  triangulation.insert_constraints(points.begin(), points.end(), sides.begin(), sides.end());
}

/// Marks every face as outside or inside, the latter by number; returns those inside.
std::vector<Face> number_inside(Triangulation& triangulation) {
  for (const Face face : triangulation.all_face_handles()) face->info() = kUnseen;
  std::vector<Face> inside;
  // Faces of one depth, then those behind the constraints around them.
  std::vector<Face> depth{triangulation.infinite_face()}, deeper;
  for (bool is_inside = false; !depth.empty(); is_inside = !is_inside) {
    deeper.clear();
    while (!depth.empty()) {
      const Face face = depth.back();
      depth.pop_back();
      if (face->info() != kUnseen) continue;
      face->info() = is_inside ? static_cast<std::uint32_t>(inside.size()) : kOutside;
      if (is_inside) inside.push_back(face);
      for (int side = 0; side < 3; ++side)
        if (face->neighbor(side)->info() == kUnseen)
          (face->is_constrained(side) ? deeper : depth).push_back(face->neighbor(side));
    }
    std::swap(depth, deeper);
  }
  return inside;
}

Point2 corner(Face face, int index) {
  const Kernel::Point_2& p = face->vertex(index)->point();
  return {p.x(), p.y()};
}

}  // namespace

ChordalAxis chordal_axis(const Polygon& polygon, double step_mm) {
  Triangulation triangulation;
  insert(polygon.outer, step_mm, triangulation);
  for (const Ring& hole : polygon.holes) insert(hole, step_mm, triangulation);
  ChordalAxis axis;
  if (triangulation.dimension() < 2) return axis;
  const std::vector<Face> inside = number_inside(triangulation);
  axis.triangles.resize(inside.size());
  for (std::uint32_t i = 0; i < inside.size(); ++i) {
    const Face face = inside[i];
    const Point2 a = corner(face, 0), b = corner(face, 1), c = corner(face, 2);
    axis.triangles[i].centre = (1.0 / 3) * (a + b + c);
    for (int side = 0; side < 3; ++side) {
      if (face->is_constrained(side)) continue;
      const std::uint32_t other = face->neighbor(side)->info();
      if (other == kOutside || other < i) continue;
      const auto chord = static_cast<std::uint32_t>(axis.chords.size());
      axis.chords.push_back(
          {lerp(corner(face, Triangulation::ccw(side)), corner(face, Triangulation::cw(side)), 0.5),
           {i, other}});
      for (const std::uint32_t triangle : {i, other}) {
        ChordalAxis::Triangle& of = axis.triangles[triangle];
        of.chords[of.count++] = chord;
      }
    }
  }
  return axis;
}

}  // namespace routebench
