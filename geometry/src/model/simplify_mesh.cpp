#include "model/simplify_mesh.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_ratio_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "model/raw_mesh.hpp"
#include "model/vertex_welder.hpp"

namespace routebench::models {
namespace {

namespace collapse = CGAL::Surface_mesh_simplification;
namespace processing = CGAL::Polygon_mesh_processing;

using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using Triangle = std::array<std::uint32_t, 3>;

/// Vertices by coordinates, triangles by vertices: the same whatever the order in the file.
void put_in_order(Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    const Point3& p = mesh.vertices[a];
    const Point3& q = mesh.vertices[b];
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<std::uint32_t> rank(order.size());
  std::vector<Point3> vertices(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    rank[order[i]] = static_cast<std::uint32_t>(i);
    vertices[i] = mesh.vertices[order[i]];
  }
  mesh.vertices = std::move(vertices);
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) corner = rank[corner];
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
  }
  std::sort(mesh.triangles.begin(), mesh.triangles.end());
}

/// Throws Error{kBadInput} where triangles meet so that no surface goes through them.
Surface surface_of(const Mesh& mesh, const std::string& name) {
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.vertices.size());
  for (const Point3& p : mesh.vertices) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  if (!processing::is_polygon_soup_a_polygon_mesh(triangles))
    refuse_model(name,
                 "cannot be simplified: parts touch along edges or in corners, so it is not one "
                 "surface; leave simplify= out");
  Surface surface;
  processing::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return surface;
}

Mesh mesh_of(const Surface& surface) {
  Mesh mesh;
  std::vector<std::uint32_t> number(surface.number_of_vertices() +
                                    surface.number_of_removed_vertices());
  for (const auto vertex : surface.vertices()) {
    number[vertex.idx()] = static_cast<std::uint32_t>(mesh.vertices.size());
    const Kernel::Point_3& p = surface.point(vertex);
    mesh.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto face : surface.faces()) {
    Triangle triangle{};
    std::size_t i = 0;
    for (const auto vertex : surface.vertices_around_face(surface.halfedge(face)))
      triangle[i++] = number[vertex.idx()];
    mesh.triangles.push_back(triangle);
  }
  weld_mesh(mesh);
  return mesh;
}

struct OnBorder {
  using key_type = Surface::Edge_index;
  using value_type = bool;
  using reference = bool;
  using category = boost::readable_property_map_tag;
  const Surface* surface;
  friend bool get(const OnBorder& map, Surface::Edge_index edge) {
    return map.surface->is_border(edge);
  }
};

/// Largest distance of the vertices and the middles of the faces of `from` to the surface `to`.
double farthest(const Surface& from, const Surface& to) {
  using Primitive = CGAL::AABB_face_graph_triangle_primitive<Surface>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  Tree tree(faces(to).first, faces(to).second, to);
  tree.accelerate_distance_queries();
  double squared = 0;
  const auto look = [&](const Kernel::Point_3& p) {
    squared = std::max(squared, tree.squared_distance(p));
  };
  for (const auto vertex : from.vertices()) look(from.point(vertex));
  for (const auto face : from.faces()) {
    std::array<Kernel::Point_3, 3> corners;
    std::size_t i = 0;
    for (const auto vertex : from.vertices_around_face(from.halfedge(face)))
      corners[i++] = from.point(vertex);
    look(CGAL::centroid(corners[0], corners[1], corners[2]));
  }
  return std::sqrt(squared);
}

}  // namespace

Simplification simplify_mesh(Mesh& mesh, double share, const std::string& name) {
  using Policies = collapse::GarlandHeckbert_plane_policies<Surface, Kernel>;
  using Placement = collapse::Constrained_placement<
      collapse::Bounded_normal_change_placement<Policies::Get_placement>, OnBorder>;

  Simplification result;
  result.triangles_before = mesh.triangles.size();
  put_in_order(mesh);
  const Surface original = surface_of(mesh, name);
  Surface simpler = original;
  const Policies policies(simpler);
  const OnBorder on_border{&simpler};
  // A closed surface has three edges for every two triangles, before as after.
  const collapse::Count_ratio_stop_predicate<Surface> enough(share);
  collapse::edge_collapse(
      simpler, enough,
      CGAL::parameters::edge_is_constrained_map(on_border)
          .get_cost(policies.get_cost())
          .get_placement(Placement(
              on_border, collapse::Bounded_normal_change_placement<Policies::Get_placement>(
                             policies.get_placement()))));
  simpler.collect_garbage();
  mesh = mesh_of(simpler);
  if (mesh.triangles.size() < 4)
    refuse_model(name, "simplify=" + rounded(share) + " leaves nothing of " +
                           counted(result.triangles_before, "triangle") + "; leave a larger share");
  result.triangles_after = mesh.triangles.size();
  result.deviation_mm = std::max(farthest(original, simpler), farthest(simpler, original));
  return result;
}

}  // namespace routebench::models
