#include "shapes/shapes.hpp"
#include "shapes/subdivide.hpp"

namespace routebench::shapes {

Mesh make_box(ShapeQuery& query) {
  const double x = query.mm("x", 20);
  const double y = query.mm("y", 20);
  const double z = query.mm("z", 20);
  const std::size_t triangles = query.triangles(12);
  query.finish();
  const Mesh box{
      {{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}, {0, 0, z}, {x, 0, z}, {x, y, z}, {0, y, z}},
      {{0, 2, 1},
       {0, 3, 2},
       {4, 5, 6},
       {4, 6, 7},
       {0, 1, 5},
       {0, 5, 4},
       {1, 2, 6},
       {1, 6, 5},
       {2, 3, 7},
       {2, 7, 6},
       {3, 0, 4},
       {3, 4, 7}}};
  return subdivide_to(box, triangles);
}

}  // namespace routebench::shapes
