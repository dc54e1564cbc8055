// CGAL's slicer as an independent opinion. It works at heights where no vertex lies.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <list>
#include <vector>

#include "meshes.hpp"
#include "models.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"

namespace routebench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// Sections by CGAL at the heights of the layers.
class CgalSections {
 public:
  explicit CgalSections(const Mesh& mesh) {
    std::vector<Surface::Vertex_index> vertices;
    for (const Point3& p : mesh.vertices) vertices.push_back(surface_.add_vertex({p.x, p.y, p.z}));
    for (const auto& [a, b, c] : mesh.triangles)
      EXPECT_TRUE(surface_.add_face(vertices[a], vertices[b], vertices[c]).is_valid());
    slicer_.emplace(surface_);
  }

  [[nodiscard]] std::vector<Ring> at(double z_mm) const {
    std::list<std::vector<Kernel::Point_3>> lines;
    (*slicer_)(Kernel::Plane_3(0, 0, 1, -z_mm), std::back_inserter(lines));
    std::vector<Ring> rings;
    for (const auto& line : lines) {
      EXPECT_EQ(line.front(), line.back());
      Ring ring;
      for (std::size_t i = 0; i + 1 < line.size(); ++i)
        ring.push_back(snap(Point2{line[i].x(), line[i].y()}));
      rings.push_back(ring);
    }
    return rings;
  }

 private:
  Surface surface_;
  std::optional<CGAL::Polygon_mesh_slicer<Surface, Kernel>> slicer_;
};

void expect_equal_sections(const Mesh& mesh, double layer_height_mm) {
  const CgalSections sections(mesh);
  SliceOptions options;
  options.layer_height_mm = layer_height_mm;
  for (const Layer& layer : slice_mesh(mesh, options, "mesh").layers) {
    const std::vector<Ring> rings = sections.at(layer.z_mm);
    std::size_t own_rings = 0;
    for (const Polygon& polygon : layer.polygons) own_rings += 1 + polygon.holes.size();
    const Polygons expected = polygons_from_rings(rings, FillRule::kEvenOdd);
    EXPECT_EQ(own_rings, rings.size()) << layer.z_mm;
    EXPECT_NEAR(area_mm2(layer.polygons), area_mm2(expected), 1e-4) << layer.z_mm;
    EXPECT_NEAR(perimeter_mm(layer.polygons), perimeter_mm(expected), 1e-4) << layer.z_mm;
  }
}

TEST(SliceMesh, AgreesWithCgalOnATorus) {
  expect_equal_sections(test::torus(10, 4, 40, 30, true), 0.617);
  expect_equal_sections(test::torus(10, 4, 40, 30), 0.617);
}

TEST(SliceMesh, AgreesWithCgalOnAScan) {
  ROUTEBENCH_MODELS_OR_SKIP(models);
  expect_equal_sections(load_model((models / "organic" / "spot.stl").string()).mesh, 1.117);
}

}  // namespace
}  // namespace routebench
