#pragma once
/// What the benchmarks run on: shapes of any number of triangles and layers of any number of
/// points.

#include <cstdint>
#include <string>

#include "random_polygons.hpp"
#include "routebench/geometry/model.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::bench {

/// A sphere of 60 mm with about that many triangles.
inline Model sphere(std::int64_t triangles) {
  return load_model("shape:sphere?diameter=60&triangles=" + std::to_string(triangles));
}

/// One layer with the outline of a star of that many points, 100 mm across.
inline Layer star_layer(std::int64_t points) {
  Layer layer;
  layer.z_mm = 0.1;
  layer.height_mm = 0.2;
  layer.polygons = {{test::star(1, static_cast<int>(points), {50, 50}, 47.0, 50.0), {}}};
  return layer;
}

}  // namespace routebench::bench
