#pragma once
/// The data that flows through routebench: mesh, rings, polygons, layers. Plain aggregates,
/// millimetres.

#include <array>
#include <cstdint>
#include <vector>

namespace routebench {

/// A point of a layer, mm.
struct Point2 {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
};

/// A point of a model, mm.
struct Point3 {
  double x = 0;
  double y = 0;
  double z = 0;
  friend bool operator==(const Point3&, const Point3&) = default;
};

/// A closed line: at least three points, the first one not repeated at the end.
using Ring = std::vector<Point2>;

/// An area with holes. The outer ring runs counter-clockwise, the holes clockwise; rings may touch
/// in points but neither cross nor share a stretch.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;
  friend bool operator==(const Polygon&, const Polygon&) = default;
};

/// Disjoint polygons (they may touch in points).
using Polygons = std::vector<Polygon>;

/// Triangles over shared vertices, mm. Seen from outside the solid a triangle runs
/// counter-clockwise.
struct Mesh {
  std::vector<Point3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// One cut through a model.
struct Layer {
  int index = 0;          ///< 0 is the lowest
  double z_mm = 0;        ///< height of the cutting plane above the bed
  double height_mm = 0;   ///< thickness of the slab that this cut stands for
  Polygons polygons;      ///< the material
  Polygons solid;         ///< part of it that must be filled densely: skins (see solid.hpp)
  bool repaired = false;  ///< a gap wider than a crack was closed here by request

  friend bool operator==(const Layer&, const Layer&) = default;
};

}  // namespace routebench
