#include "slicing/cut_triangles.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <tuple>
#include <utility>

#include "model/blocks.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench::slicing {
namespace {

constexpr std::size_t kMaxCuts = std::size_t{1} << 27;  // 1.5 GiB
constexpr std::size_t kTrianglesPerBlock = std::size_t{1} << 14;
constexpr std::size_t kMaxBlockCursors = std::size_t{1} << 22;  // 32 MiB

using Triangle = std::array<std::uint32_t, 3>;

/// The planes that a triangle crosses: first, ..., last - 1.
struct Span {
  int first;
  int last;
};

/// A mesh with one level for each vertex.
class LevelledMesh {
 public:
  LevelledMesh(const Mesh& mesh, const Planes& planes, const ParallelFor& parallel_for)
      : mesh_(mesh),
        planes_(static_cast<std::size_t>(planes.count)),
        levels_(mesh.vertices.size()) {
    const auto find_levels = [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) levels_[v] = planes.level(mesh.vertices[v].z);
    };
    models::for_each_block(levels_.size(), parallel_for, find_levels);
  }

  [[nodiscard]] std::size_t triangles() const { return mesh_.triangles.size(); }
  [[nodiscard]] std::size_t planes() const { return planes_; }

  [[nodiscard]] Span span(std::size_t triangle) const {
    const Triangle& corners = mesh_.triangles[triangle];
    const int a = levels_[corners[0]], b = levels_[corners[1]], c = levels_[corners[2]];
    return {std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
  }

  /// The cut of a triangle by a plane that it crosses. Going round the triangle, exactly one edge
  /// leads down through the plane and one leads up; seen from outside the triangle runs
  /// counter-clockwise, so the line from the first to the second has the material on its left.
  [[nodiscard]] Cut cut(std::size_t triangle, int plane) const {
    const Triangle& corners = mesh_.triangles[triangle];
    const auto above = [&](std::size_t corner) {
      return static_cast<std::size_t>(levels_[corners[corner]] > plane);
    };
    const Ends& ends = kEnds[above(0) | above(1) << 1U | above(2) << 2U];
    return {corners[ends.alone], corners[ends.from], corners[ends.to]};
  }

 private:
  /// Corners of a triangle: a cut's alone, from_end and to_end.
  struct Ends {
    std::uint8_t alone, from, to;
  };
  /// By the corners that are above the plane: 1, 2, 4. Of 0 and 7 there is no cut.
  static constexpr std::array<Ends, 8> kEnds{
      {{0, 0, 0}, {0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {0, 0, 0}}};

  const Mesh& mesh_;
  std::size_t planes_;
  LargeVector<int> levels_;
};

/// Consecutive triangles that one call of a parallel loop handles. There are as many blocks as the
/// input asks for, whatever the number of threads.
class Blocks {
 public:
  Blocks(std::size_t triangles, std::size_t planes) : triangles_(triangles) {
    const std::size_t affordable = std::max<std::size_t>(1, kMaxBlockCursors / (planes + 1));
    count_ = std::clamp<std::size_t>((triangles + kTrianglesPerBlock - 1) / kTrianglesPerBlock, 1,
                                     affordable);
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t begin(std::size_t block) const { return triangles_ * block / count_; }
  [[nodiscard]] std::size_t end(std::size_t block) const { return begin(block + 1); }

 private:
  std::size_t triangles_;
  std::size_t count_;
};

/// Counts the cuts of each block in each layer: entry [block * planes + plane].
std::vector<std::size_t> count_cuts(const LevelledMesh& mesh, const Blocks& blocks,
                                    const ParallelFor& parallel_for) {
  const std::size_t planes = mesh.planes();
  std::vector<std::size_t> counts(blocks.count() * planes);
  parallel_for(blocks.count(), [&](std::size_t block) {
    // Where triangles begin and end; the running sum of the difference is the count.
    std::vector<std::size_t> begun(planes + 1), ended(planes + 1);
    for (std::size_t t = blocks.begin(block); t < blocks.end(block); ++t) {
      const Span span = mesh.span(t);
      ++begun[static_cast<std::size_t>(span.first)];
      ++ended[static_cast<std::size_t>(span.last)];
    }
    std::size_t active = 0;
    for (std::size_t plane = 0; plane < planes; ++plane) {
      active = active + begun[plane] - ended[plane];
      counts[block * planes + plane] = active;
    }
  });
  return counts;
}

/// Sets the layers' places in the table and turns the counts into the place of each block's first
/// cut in each layer.
CutTable lay_out(std::vector<std::size_t>& counts, std::size_t blocks, std::size_t planes,
                 const std::string& model_name) {
  CutTable table;
  table.begin.resize(planes + 1);
  std::size_t total = 0;
  for (std::size_t plane = 0; plane < planes; ++plane) {
    table.begin[plane] = total;
    for (std::size_t block = 0; block < blocks; ++block)
      total += std::exchange(counts[block * planes + plane], total);
    if (total > kMaxCuts)
      throw Error(ErrorKind::kBadInput,
                  model_name + ": the layers would have more than " + std::to_string(kMaxCuts) +
                      " line segments: take thicker layers or a coarser model");
  }
  table.begin[planes] = total;
  table.cuts.resize(total);
  return table;
}

/// Every triangle pushes its cuts into the planes that it crosses.
void fill_bucketwise(const LevelledMesh& mesh, const Blocks& blocks,
                     std::vector<std::size_t>& cursors, CutTable& table,
                     const ParallelFor& parallel_for) {
  parallel_for(blocks.count(), [&](std::size_t block) {
    std::size_t* const cursor = cursors.data() + block * mesh.planes();
    for (std::size_t t = blocks.begin(block); t < blocks.end(block); ++t) {
      const Span span = mesh.span(t);
      for (int plane = span.first; plane < span.last; ++plane)
        table.cuts[cursor[plane]++] = mesh.cut(t, plane);
    }
  });
}

/// The plane rises through sorted events; the triangles that it meets form the active set.
void fill_sweeping(const LevelledMesh& mesh, CutTable& table) {
  struct Event {
    int plane;
    bool insert;
    std::uint32_t triangle;
  };
  std::vector<Event> events;
  for (std::size_t t = 0; t < mesh.triangles(); ++t) {
    const Span span = mesh.span(t);
    if (span.first == span.last) continue;
    events.push_back({span.first, true, static_cast<std::uint32_t>(t)});
    events.push_back({span.last, false, static_cast<std::uint32_t>(t)});
  }
  std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return std::tuple(a.plane, a.insert, a.triangle) < std::tuple(b.plane, b.insert, b.triangle);
  });

  std::vector<std::uint32_t> active;
  std::vector<std::uint32_t> place(mesh.triangles());  // of an active triangle in `active`
  auto event = events.begin();
  for (std::size_t plane = 0; plane < mesh.planes(); ++plane) {
    for (; event != events.end() && event->plane <= static_cast<int>(plane); ++event) {
      if (event->insert) {
        place[event->triangle] = static_cast<std::uint32_t>(active.size());
        active.push_back(event->triangle);
      } else {
        place[active.back()] = place[event->triangle];
        active[place[event->triangle]] = active.back();
        active.pop_back();
      }
    }
    std::size_t cursor = table.begin[plane];
    for (const std::uint32_t t : active)
      table.cuts[cursor++] = mesh.cut(t, static_cast<int>(plane));
  }
}

/// Every plane asks every triangle.
void fill_naively(const LevelledMesh& mesh, CutTable& table, const ParallelFor& parallel_for) {
  parallel_for(mesh.planes(), [&](std::size_t layer) {
    const int plane = static_cast<int>(layer);
    std::size_t cursor = table.begin[layer];
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
      const Span span = mesh.span(t);
      if (span.first <= plane && plane < span.last) table.cuts[cursor++] = mesh.cut(t, plane);
    }
  });
}

}  // namespace

int Planes::level(double z_mm) const noexcept {
  // The division may be wrong by one; the comparison with the planes themselves decides.
  const double estimate = std::clamp(z_mm / height_mm + 0.5, 0.0, static_cast<double>(count));
  int level = static_cast<int>(estimate);
  while (level > 0 && this->z_mm(level - 1) > z_mm) --level;
  while (level < count && this->z_mm(level) <= z_mm) ++level;
  return level;
}

bool run_straight_up(std::span<const Cut> lower, std::span<const Cut> upper, const Mesh& mesh,
                     double lean_mm) {
  const auto is_upright = [&](const Cut& cut) {
    const Point3 &from = mesh.vertices[cut.alone], &to = mesh.vertices[cut.from_end],
                 &other = mesh.vertices[cut.to_end];
    const Point3 a{to.x - from.x, to.y - from.y, to.z - from.z};
    const Point3 b{other.x - from.x, other.y - from.y, other.z - from.z};
    // The normal's slope is what the triangle leans by on its way up.
    const Point3 normal{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double way_up = std::max(a.z * a.z, b.z * b.z);  // the vertex alone is lowest or highest
    return normal.z * normal.z * way_up <=
           lean_mm * lean_mm * (normal.x * normal.x + normal.y * normal.y);
  };
  return std::equal(lower.begin(), lower.end(), upper.begin(), upper.end(),
                    [&](const Cut& a, const Cut& b) { return a == b && is_upright(a); });
}

CutTable cut_triangles(const Mesh& mesh, const Planes& planes, SliceMethod method,
                       const std::string& model_name, const ParallelFor& parallel_for) {
  const LevelledMesh levelled(mesh, planes, parallel_for);
  const Blocks blocks(levelled.triangles(), levelled.planes());
  std::vector<std::size_t> cursors = count_cuts(levelled, blocks, parallel_for);
  CutTable table = lay_out(cursors, blocks.count(), levelled.planes(), model_name);
  switch (method) {
    case SliceMethod::kBucket:
      fill_bucketwise(levelled, blocks, cursors, table, parallel_for);
      break;
    case SliceMethod::kSweep:
      fill_sweeping(levelled, table);
      break;
    case SliceMethod::kNaive:
      fill_naively(levelled, table, parallel_for);
      break;
    case SliceMethod::kVoxel:
      throw Error(ErrorKind::kInternal, "voxels do not cut triangles");
  }
  return table;
}

}  // namespace routebench::slicing
