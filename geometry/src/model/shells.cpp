#include "model/shells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "model/blocks.hpp"
#include "model/bounds.hpp"
#include "model/nesting.hpp"

namespace routebench::models {
namespace {

Point3 minus(const Point3& a, const Point3& b) noexcept {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Point3 cross3(const Point3& a, const Point3& b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(const Point3& a) noexcept { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

/// A shell's figures, in units of the file.
struct Shell {
  Bounds bounds;
  double volume = 0;  ///< about the middle of the bounds
  bool closed = false;
  bool solid = false;  ///< closed, or nearly
  // Of a shell that is not closed:
  double area = 0;     ///< twice
  Point3 area_vector;  ///< twice
};

/// A shell counts as nearly closed while the missing part is smaller than a half sphere's opening.
constexpr double kNearlyClosed = 0.5;
/// Volumes below this share of the cube over the diagonal are rounding.
constexpr double kNoVolume = 1e-12;

/// Calls add(shell, triangle) for every triangle and its shell. Of few shells every block of
/// triangles makes figures of its own, which are put together in order by merge(shell, figures): so
/// they do not depend on the threads. `shells` is where they begin.
template <typename Add, typename Merge>
void measure_triangles(const Surface& surface, const ParallelFor& parallel_for,
                       std::vector<Shell>& shells, const Add& add, const Merge& merge) {
  constexpr std::size_t kFewShells = 64;
  const std::size_t triangles = surface.shell.size();
  if (shells.size() > kFewShells) {
    for (std::size_t t = 0; t < triangles; ++t) add(shells[surface.shell[t]], t);
    return;
  }
  std::vector<std::vector<Shell>> figures(block_count(triangles), shells);
  const auto measure_block = [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::vector<Shell>& own = figures[block];
    if (own.size() > 1) {
      for (std::size_t t = begin; t < end; ++t) add(own[surface.shell[t]], t);
      return;
    }
    Shell only = own[0];  // in registers
    for (std::size_t t = begin; t < end; ++t) add(only, t);
    own[0] = only;
  };
  for_each_block(triangles, parallel_for, measure_block);
  for (const std::vector<Shell>& own : figures) {
    for (std::size_t s = 0; s < shells.size(); ++s) merge(shells[s], own[s]);
  }
}

std::vector<Shell> measure(const Mesh& mesh, bool uses_all_vertices, const Surface& surface,
                           const ParallelFor& parallel_for) {
  std::vector<Shell> shells(surface.closed.size());
  for (std::size_t s = 0; s < shells.size(); ++s) shells[s].closed = surface.closed[s] != 0;
  const auto add_bounds = [&](Shell& shell, std::size_t t) {
    for (const std::uint32_t v : mesh.triangles[t]) shell.bounds.add(mesh.vertices[v]);
  };
  if (shells.size() == 1 && uses_all_vertices)
    shells[0].bounds = bounds_of(mesh, parallel_for);
  else
    measure_triangles(surface, parallel_for, shells, add_bounds,
                      [](Shell& shell, const Shell& part) { shell.bounds.add(part.bounds); });
  const auto add_volume = [&](Shell& shell, std::size_t t) {
    const Point3 middle = shell.bounds.middle();
    const auto& [i, j, k] = mesh.triangles[t];
    const Point3 a = minus(mesh.vertices[i], middle);
    const Point3 b = minus(mesh.vertices[j], middle);
    const Point3 c = minus(mesh.vertices[k], middle);
    const Point3 normal = cross3(minus(b, a), minus(c, a));
    shell.volume += (a.x * normal.x + a.y * normal.y + a.z * normal.z) / 6;
    if (shell.closed) return;
    shell.area += length(normal);
    shell.area_vector = {shell.area_vector.x + normal.x, shell.area_vector.y + normal.y,
                         shell.area_vector.z + normal.z};
  };
  const auto merge_volumes = [](Shell& shell, const Shell& part) {
    shell.volume += part.volume;
    shell.area += part.area;
    shell.area_vector = {shell.area_vector.x + part.area_vector.x,
                         shell.area_vector.y + part.area_vector.y,
                         shell.area_vector.z + part.area_vector.z};
  };
  measure_triangles(surface, parallel_for, shells, add_volume, merge_volumes);
  for (Shell& shell : shells)
    shell.solid = shell.closed || length(shell.area_vector) < kNearlyClosed * shell.area;
  return shells;
}

bool is_empty(const Shell& shell) {
  const double side = shell.bounds.diagonal();
  return std::abs(shell.volume) <= kNoVolume * side * side * side;
}

/// Volume that the patches which are no solids enclose together, about their common middle.
double scattered_volume(const std::vector<Shell>& shells) {
  Bounds all;
  for (const Shell& shell : shells) {
    if (!shell.solid) all.add(shell.bounds);
  }
  if (all.empty()) return 0;
  const Point3 middle = all.middle();
  double volume = 0;
  for (const Shell& shell : shells) {
    if (shell.solid) continue;
    const Point3 arm = minus(shell.bounds.middle(), middle);
    volume += shell.volume + (arm.x * shell.area_vector.x + arm.y * shell.area_vector.y +
                              arm.z * shell.area_vector.z) /
                                 6;
  }
  return volume;
}

/// Which solids have to be turned.
std::vector<std::uint8_t> solids_to_turn(const Mesh& mesh, const Surface& surface,
                                         const std::vector<Shell>& shells) {
  std::vector<std::uint8_t> turn(shells.size(), 0);
  const auto faces_inwards = [&](std::size_t s) { return shells[s].solid && shells[s].volume < 0; };
  std::vector<Bounds> solids(shells.size());
  bool any = false;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    any |= faces_inwards(s);
    if (shells[s].solid) solids[s] = shells[s].bounds;
  }
  if (!any) return turn;

  std::vector<std::vector<std::uint32_t>> around = enclosing_shells(mesh, surface.shell, solids);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (!shells[s].solid) continue;
    std::size_t outermost = 0;
    std::size_t outermost_inwards = 0;
    for (const std::uint32_t o : around[s]) {
      if (!around[o].empty()) continue;
      ++outermost;
      if (faces_inwards(o)) ++outermost_inwards;
    }
    turn[s] = (outermost == 0 ? faces_inwards(s) : outermost == outermost_inwards) ? 1 : 0;
  }
  return turn;
}

}  // namespace

ShellReport turn_inside_out_shells(Mesh& mesh, bool uses_all_vertices, const Surface& surface,
                                   const ParallelFor& parallel_for) {
  const std::vector<Shell> shells = measure(mesh, uses_all_vertices, surface, parallel_for);
  std::vector<std::uint8_t> turn = solids_to_turn(mesh, surface, shells);
  const double scattered = scattered_volume(shells);
  ShellReport report;
  report.count = shells.size();
  report.volume = std::abs(scattered);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (!shells[s].solid) {
      turn[s] = scattered < 0 ? 1 : 0;
    } else {
      report.volume += turn[s] != 0 ? -shells[s].volume : shells[s].volume;
    }
    report.turned += turn[s];
    if (shells[s].closed && is_empty(shells[s])) ++report.empty;
  }
  if (report.turned == 0) return report;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (turn[surface.shell[t]] != 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return report;
}

}  // namespace routebench::models
