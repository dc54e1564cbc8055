#include "model/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "routebench/geometry/error.hpp"

namespace routebench::models {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
/// What a face of the triangulation is told: unknown, outside or inside.
enum class Where : std::uint8_t { kUnknown, kOutside, kInside };
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Kernel, CGAL::Triangulation_face_base_with_info_2<Where, Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// A side of a ring, lower index first.
using Side = std::pair<std::uint32_t, std::uint32_t>;

/// Constrained Delaunay triangulation of an area; nothing if points coincide or sides cross.
class AreaTriangulation {
 public:
  /// Sides that are run through an even number of times are bridges, not borders.
  std::optional<std::vector<Triangle>> run(std::span<const Point2> points,
                                           const std::map<Side, std::size_t>& sides) try {
    std::map<std::uint32_t, Cdt::Vertex_handle> handles;
    for (const auto& [side, times] : sides) {
      for (const std::uint32_t v : {side.first, side.second}) {
        if (handles.contains(v)) continue;
        const Cdt::Vertex_handle handle = cdt_.insert({points[v].x, points[v].y}, last_face_);
        last_face_ = handle->face();
        handle->info() = v;
        handles.emplace(v, handle);
      }
    }
    if (cdt_.number_of_vertices() != handles.size()) return std::nullopt;
    for (const auto& [side, times] : sides) {
      if (times % 2 == 0) continue;
      const Cdt::Vertex_handle a = handles.at(side.first);
      const Cdt::Vertex_handle b = handles.at(side.second);
      cdt_.insert_constraint(a, b);
      // A side through another point would be cut there: a neighbour would not know of it.
      if (!cdt_.is_edge(a, b)) return std::nullopt;
    }
    if (cdt_.dimension() < 2) return std::nullopt;
    mark();
    std::vector<Triangle> triangles;
    for (const Cdt::Face_handle face : cdt_.finite_face_handles()) {
      if (face->info() != Where::kInside) continue;
      triangles.push_back(
          {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    return triangles;
  } catch (const Cdt::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }

 private:
  /// Floods from outside; every border that is crossed changes inside and outside.
  void mark() {
    for (const Cdt::Face_handle face : cdt_.all_face_handles()) face->info() = Where::kUnknown;
    std::vector<Cdt::Face_handle> reached{cdt_.infinite_face()};
    cdt_.infinite_face()->info() = Where::kOutside;
    while (!reached.empty()) {
      const Cdt::Face_handle face = reached.back();
      reached.pop_back();
      for (int i = 0; i < 3; ++i) {
        const Cdt::Face_handle next = face->neighbor(i);
        if (next->info() != Where::kUnknown) continue;
        const bool inside = (face->info() == Where::kInside) != face->is_constrained(i);
        next->info() = inside ? Where::kInside : Where::kOutside;
        reached.push_back(next);
      }
    }
  }

  Cdt cdt_;
  Cdt::Face_handle last_face_;
};

void count_sides(std::span<const std::uint32_t> ring, std::map<Side, std::size_t>& sides) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto [low, high] = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
    if (low != high) ++sides[{low, high}];
  }
}

/// The axis along which a polygon looks largest, and whether it runs clockwise seen against it.
struct View {
  std::size_t axis;
  bool clockwise;
};

View view_of(std::span<const Point3> vertices, std::span<const std::uint32_t> corners) {
  const Point3& o = vertices[corners[0]];
  std::array<double, 3> normal{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Point3& b = vertices[corners[i]];
    const Point3& c = vertices[corners[i + 1]];
    const Point3 u{b.x - o.x, b.y - o.y, b.z - o.z};
    const Point3 v{c.x - o.x, c.y - o.y, c.z - o.z};
    normal[0] += u.y * v.z - u.z * v.y;
    normal[1] += u.z * v.x - u.x * v.z;
    normal[2] += u.x * v.y - u.y * v.x;
  }
  std::size_t axis = 2;
  if (std::abs(normal[0]) > std::abs(normal[axis])) axis = 0;
  if (std::abs(normal[1]) > std::abs(normal[axis])) axis = 1;
  return {axis, normal[axis] < 0};
}

Point2 seen_along(std::size_t axis, const Point3& p) {
  return axis == 0 ? Point2{p.y, p.z} : axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

void append_fan(std::span<const std::uint32_t> corners, std::vector<Triangle>& triangles) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    triangles.push_back({corners[0], corners[i], corners[i + 1]});
  }
}

}  // namespace

void triangulate_face(std::span<const Point3> vertices, std::span<const std::uint32_t> corners,
                      std::vector<Triangle>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  const View view = view_of(vertices, corners);
  std::vector<Point2> points;
  std::vector<std::uint32_t> ring;
  std::map<std::uint32_t, std::uint32_t> known;  // vertex to point
  std::vector<std::uint32_t> vertex_of;
  for (const std::uint32_t v : corners) {
    const auto [found, added] = known.emplace(v, static_cast<std::uint32_t>(points.size()));
    if (added) {
      points.push_back(seen_along(view.axis, vertices[v]));
      vertex_of.push_back(v);
    }
    ring.push_back(found->second);
  }
  std::map<Side, std::size_t> sides;
  count_sides(ring, sides);
  const auto cut = AreaTriangulation().run(points, sides);
  // Any other number of triangles tells that the polygon is not simple.
  if (!cut || cut->size() != corners.size() - 2) {
    append_fan(corners, triangles);
    return;
  }
  for (Triangle t : *cut) {
    if (view.clockwise) std::swap(t[1], t[2]);
    triangles.push_back({vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]});
  }
}

std::vector<Triangle> triangulate_area(std::span<const Point2> points,
                                       std::span<const std::vector<std::uint32_t>> rings) {
  std::map<Side, std::size_t> sides;
  for (const std::vector<std::uint32_t>& ring : rings) count_sides(ring, sides);
  auto cut = AreaTriangulation().run(points, sides);
  if (!cut) throw Error(ErrorKind::kInternal, "an area whose rings cross cannot be triangulated");
  return *std::move(cut);
}

}  // namespace routebench::models
