#include "shapes/isosurface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace routebench::shapes {
namespace {

/// Corners of a cube and directions of edges are three bits: x, y, z.
using Corner = unsigned;

/// The six tetrahedra of a cube between its corners 0 and 7, with positive volume.
struct Tetrahedron {
  std::array<Corner, 4> corners;
};
constexpr std::array<Tetrahedron, 6> kTetrahedra{{{{0, 1, 3, 7}},
                                                  {{0, 2, 6, 7}},
                                                  {{0, 4, 5, 7}},
                                                  {{0, 1, 7, 5}},
                                                  {{0, 2, 7, 3}},
                                                  {{0, 4, 7, 6}}}};

/// Tetrahedron corners in an order of even parity, with those inside first.
struct Cut {
  int inside;  ///< 1, 2 or 3 corners; 3 is one corner outside
  std::array<std::size_t, 4> order;
};

/// By the bits of the corners inside; 0 and 15 are not cut.
constexpr std::array<Cut, 16> kCuts{{{0, {0, 1, 2, 3}},
                                     {1, {0, 1, 2, 3}},
                                     {1, {1, 0, 3, 2}},
                                     {2, {0, 1, 2, 3}},
                                     {1, {2, 0, 1, 3}},
                                     {2, {0, 2, 3, 1}},
                                     {2, {1, 2, 0, 3}},
                                     {3, {3, 0, 2, 1}},
                                     {1, {3, 0, 2, 1}},
                                     {2, {0, 3, 1, 2}},
                                     {2, {1, 3, 2, 0}},
                                     {3, {2, 0, 1, 3}},
                                     {2, {2, 3, 0, 1}},
                                     {3, {1, 0, 3, 2}},
                                     {3, {0, 1, 2, 3}},
                                     {0, {0, 1, 2, 3}}}};

class Isosurface {
 public:
  Isosurface(const Field& field, const Point3& size, const std::array<std::size_t, 3>& cubes)
      : field_(field),
        size_(size),
        // One node outside at either end, half a cube beyond the box: its faces become planes.
        nodes_{cubes[0] + 2, cubes[1] + 2, cubes[2] + 2},
        step_{size.x / static_cast<double>(cubes[0]), size.y / static_cast<double>(cubes[1]),
              size.z / static_cast<double>(cubes[2])} {}

  Mesh run() {
    const std::size_t plane = nodes_[0] * nodes_[1];
    for (Layer& layer : layers_) {
      layer.values.resize(plane);
      layer.vertices.resize(plane * 8);
    }
    fill(0);
    for (std::size_t k = 0; k + 1 < nodes_[2]; ++k) {
      fill(k + 1);
      for (std::size_t j = 0; j + 1 < nodes_[1]; ++j) {
        for (std::size_t i = 0; i + 1 < nodes_[0]; ++i) cut_cube(i, j, k);
      }
    }
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// The nodes at one height and the vertices on the edges that begin there.
  struct Layer {
    std::vector<double> values;
    std::vector<std::uint32_t> vertices;  // by node and direction
  };

  [[nodiscard]] Point3 node(std::size_t i, std::size_t j, std::size_t k) const {
    return {(static_cast<double>(i) - 0.5) * step_.x, (static_cast<double>(j) - 0.5) * step_.y,
            (static_cast<double>(k) - 0.5) * step_.z};
  }

  /// The field within the box; outside it the distance from the box, negative.
  [[nodiscard]] double sample(const Point3& p) const {
    const double room = std::min({p.x, size_.x - p.x, p.y, size_.y - p.y, p.z, size_.z - p.z});
    return room <= 0 ? room : std::min(room, field_(p));
  }

  void fill(std::size_t k) {
    Layer& layer = layers_[k % 2];
    std::fill(layer.vertices.begin(), layer.vertices.end(), kNone);
    for (std::size_t j = 0; j < nodes_[1]; ++j) {
      for (std::size_t i = 0; i < nodes_[0]; ++i) {
        layer.values[j * nodes_[0] + i] = sample(node(i, j, k));
      }
    }
  }

  struct Place {
    std::size_t i, j, k;
    [[nodiscard]] Place operator+(Corner c) const {
      return {i + (c & 1U), j + (c >> 1U & 1U), k + (c >> 2U)};
    }
  };

  [[nodiscard]] std::size_t index(const Place& p) const { return p.j * nodes_[0] + p.i; }
  [[nodiscard]] double value(const Place& p) const { return layers_[p.k % 2].values[index(p)]; }

  void cut_cube(std::size_t i, std::size_t j, std::size_t k) {
    const Place cube{i, j, k};
    std::array<bool, 8> inside{};
    for (Corner c = 0; c < 8; ++c) inside[c] = value(cube + c) > 0;
    if (std::all_of(inside.begin(), inside.end(), [&](bool in) { return in == inside[0]; })) return;
    for (const Tetrahedron& tetrahedron : kTetrahedra) {
      std::size_t bits = 0;
      for (std::size_t c = 0; c < 4; ++c) {
        if (inside[tetrahedron.corners[c]]) bits |= std::size_t{1} << c;
      }
      cut_tetrahedron(cube, tetrahedron, kCuts[bits]);
    }
  }

  void cut_tetrahedron(const Place& cube, const Tetrahedron& tetrahedron, const Cut& cut) {
    const auto on = [&](std::size_t a, std::size_t b) {
      return vertex(cube, tetrahedron.corners[cut.order[a]], tetrahedron.corners[cut.order[b]]);
    };
    if (cut.inside == 1) {
      mesh_.triangles.push_back({on(0, 1), on(0, 2), on(0, 3)});
    } else if (cut.inside == 3) {
      mesh_.triangles.push_back({on(0, 1), on(0, 3), on(0, 2)});
    } else if (cut.inside == 2) {
      mesh_.triangles.push_back({on(0, 2), on(0, 3), on(1, 3)});
      mesh_.triangles.push_back({on(0, 2), on(1, 3), on(1, 2)});
    }
  }

  /// The vertex between two corners of a cube, one of which is part of the other.
  std::uint32_t vertex(const Place& cube, Corner a, Corner b) {
    const Corner low = a & b;
    const Corner direction = (a | b) ^ low;
    const Place from = cube + low;
    const Place to = from + direction;
    std::uint32_t& known = layers_[from.k % 2].vertices[index(from) * 8 + direction];
    if (known != kNone) return known;
    known = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back(
        crossing(node(from.i, from.j, from.k), value(from), node(to.i, to.j, to.k), value(to)));
    return known;
  }

  /// Where the field changes its sign between p and q, by false position with the Illinois rule: an
  /// end that stays twice counts half. The box's faces come out exactly level.
  [[nodiscard]] Point3 crossing(const Point3& p, double at_p, const Point3& q, double at_q) const {
    const auto point = [&](double t) {
      return Point3{p.x + (q.x - p.x) * t, p.y + (q.y - p.y) * t, p.z + (q.z - p.z) * t};
    };
    const double enough = std::min({step_.x, step_.y, step_.z}) / 1000;
    const bool p_inside = at_p > 0;
    double low = 0;
    double high = 1;
    double t = 0.5;
    int stays = 0;  // how often the upper end stayed, or negative the lower one
    for (int round = 0; round < 60; ++round) {
      t = low + (high - low) * (at_p / (at_p - at_q));
      const double value = sample(point(t));
      if (std::abs(value) < enough) break;
      if ((value > 0) == p_inside) {
        low = t;
        at_p = value;
        stays = std::max(stays, 0) + 1;
        if (stays > 1) at_q /= 2;
      } else {
        high = t;
        at_q = value;
        stays = std::min(stays, 0) - 1;
        if (stays < -1) at_p /= 2;
      }
    }
    // Away from the nodes, so that no two vertices around a node coincide.
    const Point3 found = point(std::clamp(t, 0.01, 0.99));
    return {onto_face(found.x, size_.x, step_.x), onto_face(found.y, size_.y, step_.y),
            onto_face(found.z, size_.z, step_.z)};
  }

  /// Moves a coordinate that the search left beside a face of the box onto it.
  static double onto_face(double at, double size, double step) {
    const double tolerance = step / 500;
    if (std::abs(at) < tolerance) return 0;
    return std::abs(at - size) < tolerance ? size : at;
  }

  const Field& field_;
  Point3 size_;
  std::array<std::size_t, 3> nodes_;
  Point3 step_;
  std::array<Layer, 2> layers_;
  Mesh mesh_;
};

std::array<std::size_t, 3> cubes_of(const Point3& size, double edge) {
  const auto along = [&](double length) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(length / edge)));
  };
  return {along(size.x), along(size.y), along(size.z)};
}

}  // namespace

Mesh isosurface(const Field& field, const Point3& size, const std::array<std::size_t, 3>& cubes) {
  return Isosurface(field, size, cubes).run();
}

Mesh isosurface_of(std::size_t triangles, const Field& field, const Point3& size,
                   double longest_edge_mm) {
  // What comes out of the longest edge tells how the triangles multiply: by the square of the edge.
  double edge = longest_edge_mm;
  for (int trial = 0;; ++trial) {
    Mesh mesh = isosurface(field, size, cubes_of(size, edge));
    const double ratio = static_cast<double>(std::max<std::size_t>(mesh.triangles.size(), 1)) /
                         static_cast<double>(triangles);
    const double next = std::min(longest_edge_mm, edge * std::sqrt(ratio));
    if (trial == 2 || std::abs(ratio - 1) < 0.02 || next == edge) return mesh;
    edge = next;
  }
}

}  // namespace routebench::shapes
