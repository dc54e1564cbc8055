#include "slicing/voxel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace routebench::slicing {
namespace {

/// Places within this many cells of a line count as on it: none is missed between two triangles.
constexpr double kOnLine = 1e-9;
/// Where a triangle is narrower than this, lines run along it rather than through it.
constexpr double kEdgeOn = 1e-6;

std::int64_t nearest(double cells) { return static_cast<std::int64_t>(std::floor(cells + 0.5)); }

double squared_length(const CellPoint& a, const CellPoint& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (b[i] - a[i]) * (b[i] - a[i]);
  return sum;
}

/// Spreads bits to higher places as long as those are free.
std::uint64_t spread_up(std::uint64_t bits, std::uint64_t free) {
  for (unsigned step = 1; step < 64; step *= 2) {
    bits |= free & (bits << step);
    free &= free << step;
  }
  return bits;
}

std::uint64_t spread_down(std::uint64_t bits, std::uint64_t free) {
  for (unsigned step = 1; step < 64; step *= 2) {
    bits |= free & (bits >> step);
    free &= free >> step;
  }
  return bits;
}

/// What of a triangle lies in a plane: a piece of a line from `low` to `high`.
struct Chord {
  double low = 0, high = 0;
  double at_low = 0, at_high = 0;  // height above `low` and `high`
  double lowest = 0, highest = 0;  // of all heights
  bool empty = true;

  void add(double place, double height) {
    lowest = empty ? height : std::min(lowest, height);
    highest = empty ? height : std::max(highest, height);
    if (empty || place < low) {
      low = place;
      at_low = height;
    }
    if (empty || place > high) {
      high = place;
      at_high = height;
    }
    empty = false;
  }
};

}  // namespace

VoxelGrid::VoxelGrid(const VoxelFrame& frame)
    : frame_(frame), surface_(frame.words(), 0), outside_(frame.words(), 0) {}

CellPoint VoxelGrid::in_cells(const Point3& p) const {
  return {(p.x - frame_.first.x) / frame_.pitch.x, (p.y - frame_.first.y) / frame_.pitch.y,
          (p.z - frame_.first.z) / frame_.pitch.z};
}

void VoxelGrid::mark(const Cell& cell) {
  Cell inner;
  for (std::size_t i = 0; i < 3; ++i)
    inner[i] = std::clamp(cell[i], std::int64_t{1}, frame_.count[i] - 2);
  const auto x = static_cast<std::size_t>(inner[0]);
  surface_[frame_.row(inner[1], inner[2]) * frame_.row_words() + x / 64] |= std::uint64_t{1}
                                                                            << x % 64;
}

void VoxelGrid::mark(const CellPoint& p) {
  mark(Cell{nearest(p[0]), nearest(p[1]), nearest(p[2])});
}

/// Bresenham's line in three dimensions, both ends included.
template <typename Visit>
void VoxelGrid::visit_line(Cell from, const Cell& to, Visit&& visit) {
  Cell length, step, error;
  for (std::size_t i = 0; i < 3; ++i) {
    length[i] = std::abs(to[i] - from[i]);
    step[i] = to[i] < from[i] ? -1 : 1;
  }
  const std::int64_t longest = *std::max_element(length.begin(), length.end());
  error.fill(longest / 2);
  visit(from);
  for (std::int64_t k = 0; k < longest; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      error[i] -= length[i];
      if (error[i] >= 0) continue;
      from[i] += step[i];
      error[i] += longest;
    }
    visit(from);
  }
}

void VoxelGrid::draw_as_published(const std::array<CellPoint, 3>& corners) {
  std::size_t apex = 0;  // opposite to the longest edge
  double longest = -1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = squared_length(corners[(i + 1) % 3], corners[(i + 2) % 3]);
    if (length <= longest) continue;
    longest = length;
    apex = i;
  }
  const auto cell = [&](std::size_t i) {
    const CellPoint& p = corners[i % 3];
    return Cell{nearest(p[0]), nearest(p[1]), nearest(p[2])};
  };
  visit_line(cell(apex + 1), cell(apex + 2), [&](const Cell& on_edge) {
    visit_line(on_edge, cell(apex), [&](const Cell& inside) { mark(inside); });
  });
}

void VoxelGrid::close_pinholes(const std::array<CellPoint, 3>& corners, std::size_t axis) {
  const std::size_t across = (axis + 1) % 3, along = (axis + 2) % 3;
  const auto [lowest, highest] =
      std::minmax({corners[0][across], corners[1][across], corners[2][across]});
  for (double line = std::ceil(lowest - kOnLine); line <= highest + kOnLine; line += 1) {
    Chord chord;
    for (std::size_t i = 0; i < 3; ++i) {
      const CellPoint& a = corners[i];
      const CellPoint& b = corners[(i + 1) % 3];
      const auto [low, high] = std::minmax(a[across], b[across]);
      if (low > line + kOnLine || high < line - kOnLine) continue;
      if (high - low <= kOnLine) {
        chord.add(a[along], a[axis]);
        chord.add(b[along], b[axis]);
        continue;
      }
      const double share = std::clamp((line - a[across]) / (b[across] - a[across]), 0.0, 1.0);
      chord.add(a[along] + share * (b[along] - a[along]), a[axis] + share * (b[axis] - a[axis]));
    }
    if (chord.empty) continue;
    const double width = chord.high - chord.low;
    for (double place = std::ceil(chord.low - kOnLine); place <= chord.high + kOnLine; place += 1) {
      const auto mark_at = [&](double height) {
        CellPoint met{};
        met[across] = line;
        met[along] = place;
        met[axis] = height;
        mark(met);
      };
      if (width > kEdgeOn) {
        const double share = std::clamp((place - chord.low) / width, 0.0, 1.0);
        mark_at(chord.at_low + share * (chord.at_high - chord.at_low));
        continue;
      }
      for (double height = chord.lowest; height < chord.highest; height += 1) mark_at(height);
      mark_at(chord.highest);
    }
  }
}

void VoxelGrid::draw(const Mesh& mesh) {
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    const std::array<CellPoint, 3> corners{in_cells(mesh.vertices[triangle[0]]),
                                           in_cells(mesh.vertices[triangle[1]]),
                                           in_cells(mesh.vertices[triangle[2]])};
    draw_as_published(corners);
    for (std::size_t axis = 0; axis < 3; ++axis) close_pinholes(corners, axis);
  }
}

bool VoxelGrid::flood_row(std::size_t row) {
  const std::size_t words = frame_.row_words(),
                    rows_a_layer = static_cast<std::size_t>(frame_.count[1]);
  const std::size_t begin = row * words;
  const auto from_row = [&](bool there_is, std::size_t other, std::size_t i) {
    return there_is ? outside_[other * words + i] : 0;
  };
  const std::size_t y = row % rows_a_layer, z = row / rows_a_layer;
  bool changed = false;
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t free = ~surface_[begin + i];
    const std::uint64_t seeds =
        outside_[begin + i] | from_row(y > 0, row - 1, i) |
        from_row(y + 1 < rows_a_layer, row + 1, i) | from_row(z > 0, row - rows_a_layer, i) |
        from_row(row + rows_a_layer < frame_.rows(), row + rows_a_layer, i) | carry;
    const std::uint64_t reached = spread_up(seeds & free, free);
    changed = changed || reached != outside_[begin + i];
    outside_[begin + i] = reached;
    carry = reached >> 63U;
  }
  carry = 0;
  for (std::size_t i = words; i-- > 0;) {
    const std::uint64_t free = ~surface_[begin + i];
    const std::uint64_t reached = spread_down(outside_[begin + i] | (carry << 63U & free), free);
    changed = changed || reached != outside_[begin + i];
    outside_[begin + i] = reached;
    carry = reached & 1U;
  }
  return changed;
}

void VoxelGrid::flood_outside() {
  const auto rows_a_layer = static_cast<std::size_t>(frame_.count[1]);
  std::vector<bool> waits(frame_.rows(), false);
  std::vector<std::size_t> now{0}, next;
  outside_[0] |= 1;  // a corner of the border, which is free
  const auto ask = [&](bool there_is, std::size_t row) {
    if (!there_is || waits[row]) return;
    waits[row] = true;
    next.push_back(row);
  };
  while (!now.empty()) {
    for (const std::size_t row : now) {
      waits[row] = false;
      if (!flood_row(row)) continue;
      const std::size_t y = row % rows_a_layer;
      ask(y > 0, row - 1);
      ask(y + 1 < rows_a_layer, row + 1);
      ask(row >= rows_a_layer, row - rows_a_layer);
      ask(row + rows_a_layer < frame_.rows(), row + rows_a_layer);
    }
    now.clear();
    std::swap(now, next);
  }
}

}  // namespace routebench::slicing
