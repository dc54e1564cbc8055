#include "shapes/subdivide.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "model/edge_table.hpp"

namespace routebench::shapes {
namespace {

/// The point at a share of the way from a to b.
Point3 between(const Point3& a, const Point3& b, double share) noexcept {
  return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share};
}

using models::EdgeTable;

class Subdivision {
 public:
  Subdivision(const Mesh& mesh, std::size_t parts)
      : mesh_(mesh), parts_(static_cast<std::uint32_t>(parts)) {}

  Mesh run() {
    out_.vertices = mesh_.vertices;
    cut_edges();
    out_.triangles.reserve(mesh_.triangles.size() * parts_ * parts_);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) cut_triangle(t);
    return std::move(out_);
  }

 private:
  /// Puts parts - 1 points on every edge, from its lower to its upper vertex.
  void cut_edges() {
    first_on_side_.resize(mesh_.triangles.size());
    EdgeTable(mesh_.triangles, mesh_.vertices.size())
        .for_each_edge([&](std::uint32_t lower, std::span<const EdgeTable::Side> sides) {
          const std::uint32_t upper = sides[0].upper();
          const auto first = static_cast<std::uint32_t>(out_.vertices.size());
          for (std::uint32_t i = 1; i < parts_; ++i) {
            out_.vertices.push_back(
                between(mesh_.vertices[lower], mesh_.vertices[upper], share(i)));
          }
          for (const EdgeTable::Side side : sides) {
            const auto& t = mesh_.triangles[side.triangle()];
            for (std::size_t c = 0; c < 3; ++c) {
              const auto [low, high] = std::minmax({t[c], t[(c + 1) % 3]});
              if (low == lower && high == upper) first_on_side_[side.triangle()][c] = first;
            }
          }
        });
  }

  [[nodiscard]] double share(std::uint32_t part) const {
    return static_cast<double>(part) / static_cast<double>(parts_);
  }

  /// The i-th point on side c of triangle t, counted from corner c; 0 and parts are the corners.
  [[nodiscard]] std::uint32_t on_side(std::size_t t, std::size_t c, std::uint32_t i) const {
    const std::uint32_t from = mesh_.triangles[t][c];
    const std::uint32_t to = mesh_.triangles[t][(c + 1) % 3];
    if (i == 0) return from;
    if (i == parts_) return to;
    return first_on_side_[t][c] + (from < to ? i - 1 : parts_ - 1 - i);
  }

  /// Row r lies r parts from corner 0 towards side 1 and has r + 1 points.
  [[nodiscard]] std::vector<std::uint32_t> make_row(std::size_t t, std::uint32_t r) {
    if (r == 0) return {on_side(t, 0, 0)};
    std::vector<std::uint32_t> row(r + 1);
    row.front() = on_side(t, 0, r);
    row.back() = on_side(t, 2, parts_ - r);
    for (std::uint32_t i = 1; i < r; ++i) {
      if (r == parts_) {
        row[i] = on_side(t, 1, i);
        continue;
      }
      row[i] = static_cast<std::uint32_t>(out_.vertices.size());
      out_.vertices.push_back(between(out_.vertices[row.front()], out_.vertices[row.back()],
                                      static_cast<double>(i) / static_cast<double>(r)));
    }
    return row;
  }

  void cut_triangle(std::size_t t) {
    std::vector<std::uint32_t> above = make_row(t, 0);
    for (std::uint32_t r = 1; r <= parts_; ++r) {
      std::vector<std::uint32_t> row = make_row(t, r);
      for (std::uint32_t i = 0; i < r; ++i) {
        out_.triangles.push_back({above[i], row[i], row[i + 1]});
        if (i + 1 < r) out_.triangles.push_back({above[i], row[i + 1], above[i + 1]});
      }
      above = std::move(row);
    }
  }

  const Mesh& mesh_;
  std::uint32_t parts_;
  Mesh out_;
  std::vector<std::array<std::uint32_t, 3>> first_on_side_;
};

}  // namespace

Mesh subdivide(const Mesh& mesh, std::size_t parts) {
  return parts <= 1 ? mesh : Subdivision(mesh, parts).run();
}

Mesh subdivide_to(const Mesh& mesh, std::size_t triangles) {
  const double ratio = static_cast<double>(triangles) / static_cast<double>(mesh.triangles.size());
  return subdivide(mesh, static_cast<std::size_t>(std::max(1.0, std::round(std::sqrt(ratio)))));
}

}  // namespace routebench::shapes
