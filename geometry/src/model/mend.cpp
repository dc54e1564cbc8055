#include "model/mend.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "model/blocks.hpp"
#include "model/raw_mesh.hpp"
#include "model/shells.hpp"
#include "model/surface.hpp"

namespace routebench::models {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// What to do about triangles that are there more than once, mildest first.
enum class Copies { kOneOfEachDirection, kKeep, kOne };

struct Treatment {
  bool drop_flat = false;
  Copies copies = Copies::kKeep;
};

/// A treated mesh and what became of it.
struct Treated {
  std::vector<Triangle> triangles;
  Surface surface;
  ShellReport shells;
};

bool has_corner_twice(const Triangle& t) noexcept {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Whether the corners lie on one line.
bool is_flat(const Mesh& mesh, const Triangle& t) noexcept {
  const Point3& a = mesh.vertices[t[0]];
  const Point3& b = mesh.vertices[t[1]];
  const Point3& c = mesh.vertices[t[2]];
  const Point3 u{b.x - a.x, b.y - a.y, b.z - a.z};
  const Point3 v{c.x - a.x, c.y - a.y, c.z - a.z};
  return u.y * v.z == u.z * v.y && u.z * v.x == u.x * v.z && u.x * v.y == u.y * v.x;
}

/// Triangles without area.
struct Degenerate {
  std::size_t collapsed = 0;  ///< with a corner twice
  std::size_t flat = 0;       ///< the others
};

Degenerate count_degenerate(const Mesh& mesh, const ParallelFor& parallel_for) {
  std::vector<Degenerate> blocks(block_count(mesh.triangles.size()));
  const auto count = [&](std::size_t block, std::size_t begin, std::size_t end) {
    Degenerate found;
    for (std::size_t t = begin; t < end; ++t) {
      if (has_corner_twice(mesh.triangles[t])) {
        ++found.collapsed;
      } else if (is_flat(mesh, mesh.triangles[t])) {
        ++found.flat;
      }
    }
    blocks[block] = found;
  };
  for_each_block(mesh.triangles.size(), parallel_for, count);
  Degenerate all;
  for (const Degenerate& found : blocks) {
    all.collapsed += found.collapsed;
    all.flat += found.flat;
  }
  return all;
}

/// A triangle that starts at its lowest corner; `either_way` makes both directions alike.
Triangle normalised(const Triangle& t, bool either_way) noexcept {
  const auto lowest = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
  Triangle n{t[lowest], t[(lowest + 1) % 3], t[(lowest + 2) % 3]};
  if (either_way && n[1] > n[2]) std::swap(n[1], n[2]);
  return n;
}

/// Drops all but the first of equal triangles, keeping the order.
void drop_copies(std::vector<Triangle>& triangles, bool either_way) {
  std::vector<std::pair<Triangle, std::uint32_t>> sorted;
  sorted.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    sorted.emplace_back(normalised(triangles[t], either_way), t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint8_t> copy(triangles.size(), 0);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) copy[sorted[i].second] = 1;
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (copy[t] == 0) triangles[kept++] = triangles[t];
  }
  triangles.resize(kept);
}

void turn_flipped(std::vector<Triangle>& triangles, const Surface& surface) {
  if (surface.turn.empty()) return;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (surface.turn[t] != 0) std::swap(triangles[t][1], triangles[t][2]);
  }
}

/// Applies a treatment to the mesh's triangles; leaves the mesh as it was.
Treated treat(Mesh& mesh, const Treatment& treatment, const ParallelFor& parallel_for) {
  std::vector<Triangle> original = mesh.triangles;
  if (treatment.drop_flat) {
    std::erase_if(mesh.triangles, [&](const Triangle& t) { return is_flat(mesh, t); });
  }
  if (treatment.copies != Copies::kKeep) {
    drop_copies(mesh.triangles, treatment.copies == Copies::kOne);
  }
  Treated treated;
  treated.surface = survey(mesh, parallel_for);
  turn_flipped(mesh.triangles, treated.surface);
  treated.shells = turn_inside_out_shells(mesh, false, treated.surface, parallel_for);
  treated.triangles = std::exchange(mesh.triangles, std::move(original));
  return treated;
}

/// Tries the treatments that can matter and keeps the best.
Treated best_treatment(Mesh& mesh, bool has_flat, const Surface& as_it_came,
                       const ParallelFor& parallel_for) {
  const bool has_copies = as_it_came.copies_along + as_it_came.copies_against > 0;
  std::optional<Treated> best;
  for (const bool drop_flat : {true, false}) {
    if (drop_flat && !has_flat) continue;
    for (const Copies copies : {Copies::kOneOfEachDirection, Copies::kKeep, Copies::kOne}) {
      if (copies != Copies::kKeep && !has_copies) continue;
      Treated treated = treat(mesh, {drop_flat, copies}, parallel_for);
      const auto badness = [](const Treated& t) {
        return std::tuple(t.surface.unpaired_edges, t.shells.empty == t.shells.count);
      };
      if (!best || badness(treated) < badness(*best)) best = std::move(treated);
    }
  }
  return *std::move(best);
}

/// Drops vertices that no triangle uses.
void drop_unused_vertices(Mesh& mesh) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) number[v] = 0;
  }
  std::uint32_t used = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kUnused) continue;
    mesh.vertices[used] = mesh.vertices[v];
    number[v] = used++;
  }
  if (used == mesh.vertices.size()) return;
  mesh.vertices.resize(used);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = number[v];
  }
}

void describe_defects(const MeshReport& report, std::vector<std::string>& warnings) {
  const auto warn = [&](std::size_t count, const char* noun, const char* what) {
    if (count > 0) warnings.push_back(counted(count, noun) + ' ' + what);
  };
  warn(report.open_edges, "open edge", "(with one triangle): the surface has holes or cracks");
  warn(report.non_manifold_edges, "non-manifold edge", "(with three or more triangles)");
  warn(report.flipped_triangles, "triangle",
       "flipped against the neighbours: turned to agree with them");
  warn(report.degenerate_triangles, "triangle",
       "without area: dropped where they do not hold the surface together");
  warn(report.duplicate_triangles, "triangle",
       "there already: dropped where the surface closes without them");
}

}  // namespace

void mend(Mesh& mesh, const std::string& name, MeshReport& report,
          std::vector<std::string>& warnings, const ParallelFor& parallel_for) {
  report.triangles = mesh.triangles.size();
  report.vertices = mesh.vertices.size();
  const auto [collapsed, flat] = count_degenerate(mesh, parallel_for);
  if (collapsed > 0) std::erase_if(mesh.triangles, has_corner_twice);
  report.degenerate_triangles = collapsed + flat;
  if (flat == mesh.triangles.size()) {
    refuse_model(name, "nothing to print: no triangle has an area");
  }

  Surface surface = survey(mesh, parallel_for);
  report.components = surface.components;
  report.open_edges = surface.open_edges;
  report.non_manifold_edges = surface.non_manifold_edges;
  report.flipped_triangles = surface.flipped_triangles;
  report.duplicate_triangles = surface.copies_along + surface.copies_against;
  describe_defects(report, warnings);

  ShellReport shells;
  if (flat + report.duplicate_triangles > 0) {
    Treated best = best_treatment(mesh, flat > 0, surface, parallel_for);
    mesh.triangles = std::move(best.triangles);
    surface = std::move(best.surface);
    shells = best.shells;
  } else {
    turn_flipped(mesh.triangles, surface);
    shells = turn_inside_out_shells(mesh, collapsed == 0, surface, parallel_for);
  }
  if (collapsed + flat > 0) drop_unused_vertices(mesh);

  if (shells.empty == shells.count) {
    refuse_model(name, "nothing to print: the surface encloses no volume");
  }
  if (shells.empty > 0) {
    warnings.push_back(counted(shells.empty, "shell") + " of " + std::to_string(shells.count) +
                       " without volume: nothing of it can be printed");
  }
  if (shells.turned > 0) {
    warnings.push_back(counted(shells.turned, "shell") + " of " + std::to_string(shells.count) +
                       " inside out: turned");
  }
  report.volume_mm3 = shells.volume;
}

}  // namespace routebench::models
