#include "slicing/voxel_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"

namespace routebench::slicing {
namespace {

struct Move {
  std::int64_t dx, dy;
};
/// Anticlockwise from the east.
constexpr std::array<Move, 4> kMoves{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// Walks round the material of one layer of cells. The corner (x, y) is the lower left one of the
/// cell (x, y).
class Outlines {
 public:
  Outlines(const VoxelGrid& grid, std::int64_t z)
      : grid_(grid),
        z_(z),
        columns_(grid.frame().count[0]),
        seen_(static_cast<std::size_t>(columns_ * grid.frame().count[1]), false) {}

  std::vector<Ring> rings() {
    std::vector<Ring> all;
    // Every ring has a stretch that leads east along the lower side of a cell.
    for (std::int64_t y = 1; y < grid_.frame().count[1]; ++y)
      for (std::int64_t x = 1; x < columns_; ++x)
        if (material(x, y) && !material(x, y - 1) && !seen(x, y)) all.push_back(walk(x, y));
    return all;
  }

 private:
  [[nodiscard]] bool material(std::int64_t x, std::int64_t y) const {
    return grid_.is_material(x, y, z_);
  }
  [[nodiscard]] std::vector<bool>::reference seen(std::int64_t x, std::int64_t y) {
    return seen_[static_cast<std::size_t>(y * columns_ + x)];
  }

  /// The cell ahead of a corner, on the left or on the right of one who moves.
  [[nodiscard]] bool material_ahead(std::int64_t x, std::int64_t y, Move ahead, bool left) const {
    const Move side = left ? Move{-ahead.dy, ahead.dx} : Move{ahead.dy, -ahead.dx};
    return material(ahead.dx + side.dx > 0 ? x : x - 1, ahead.dy + side.dy > 0 ? y : y - 1);
  }

  Ring walk(std::int64_t x, std::int64_t y) {
    Ring ring;
    std::size_t move = 0;
    while (move != 0 || !seen(x, y)) {
      if (move == 0) seen(x, y) = true;
      x += kMoves[move].dx;
      y += kMoves[move].dy;
      // Left comes first: at a corner where two cells touch the walk stays with its own.
      const std::size_t before = move;
      if (!material_ahead(x, y, kMoves[move], true))
        move = (move + 1) % 4;
      else if (material_ahead(x, y, kMoves[move], false))
        move = (move + 3) % 4;
      if (move != before) ring.push_back(corner(x, y));
    }
    return ring;
  }

  [[nodiscard]] Point2 corner(std::int64_t x, std::int64_t y) const {
    const VoxelFrame& frame = grid_.frame();
    return snap(Point2{frame.first.x + (static_cast<double>(x) - 0.5) * frame.pitch.x,
                       frame.first.y + (static_cast<double>(y) - 0.5) * frame.pitch.y});
  }

  const VoxelGrid& grid_;
  std::int64_t z_;
  std::int64_t columns_;
  std::vector<bool> seen_;  // of a cell's lower side
};

}  // namespace

VoxelFrame frame_of(const Mesh& mesh, const Planes& planes, double cell_mm) {
  Point2 lower{}, upper{};
  bool found = false;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) {
      const Point3& p = mesh.vertices[corner];
      lower = found ? Point2{std::min(lower.x, p.x), std::min(lower.y, p.y)} : Point2{p.x, p.y};
      upper = found ? Point2{std::max(upper.x, p.x), std::max(upper.y, p.y)} : Point2{p.x, p.y};
      found = true;
    }
  // What is beyond any memory need not be exact, but must have a number.
  constexpr double kMost = 1e9;
  const auto cells = [&](double length_mm) {
    return static_cast<std::int64_t>(std::min(std::floor(length_mm / cell_mm + 0.5), kMost)) + 3;
  };
  return {{lower.x - cell_mm, lower.y - cell_mm, planes.z_mm(-1)},
          {cell_mm, cell_mm, planes.height_mm},
          {cells(upper.x - lower.x), cells(upper.y - lower.y), std::int64_t{planes.count} + 2}};
}

std::vector<Polygons> voxel_layers(const Mesh& mesh, const VoxelFrame& frame,
                                   const ParallelFor& parallel_for) {
  VoxelGrid grid(frame);
  grid.draw(mesh);
  grid.flood_outside();
  std::vector<Polygons> layers(static_cast<std::size_t>(frame.count[2]) - 2);
  parallel_for(layers.size(), [&](std::size_t i) {
    layers[i] = polygons_from_rings(Outlines(grid, static_cast<std::int64_t>(i) + 1).rings(),
                                    FillRule::kNonZero);
  });
  return layers;
}

}  // namespace routebench::slicing
