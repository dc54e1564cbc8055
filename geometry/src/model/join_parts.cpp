#include "model/join_parts.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "model/vertex_welder.hpp"

namespace routebench::models {
namespace {

/// Equal points are in the same bin, and each bin is welded for itself. The number of bins is the
/// same for every number of threads.
constexpr std::size_t kBins = 16;

std::size_t bin_of(const Point3& p) noexcept { return VertexWelder::tag_of(p) >> 28U; }
static_assert(kBins == 1U << 4U, "a bin is the top four bits of a tag");

/// The vertices of one part, sorted by bin; in order within each.
class BinnedPart {
 public:
  BinnedPart() = default;
  /// `first` is the number of the part's first vertex among those of all parts.
  BinnedPart(std::span<const Point3> points, std::size_t first)
      : points_(points), first_(first), sorted_(points.size()) {
    std::vector<std::uint8_t> bins(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      bins[i] = static_cast<std::uint8_t>(bin_of(points[i]));
      ++begin_[bins[i] + 2];
    }
    // Counts are kept two places up, so that after filling each entry is the beginning of its own.
    for (std::size_t bin = 2; bin < begin_.size(); ++bin) begin_[bin] += begin_[bin - 1];
    for (std::size_t i = 0; i < points.size(); ++i)
      sorted_[begin_[bins[i] + 1]++] = static_cast<std::uint32_t>(i);
  }

  /// Calls visit(number, point) for the vertices of a bin.
  template <typename Visit>
  void for_each_in(std::size_t bin, Visit&& visit) const {
    for (std::size_t i = begin_[bin]; i < begin_[bin + 1]; ++i)
      visit(static_cast<std::uint32_t>(first_ + sorted_[i]), points_[sorted_[i]]);
  }
  [[nodiscard]] std::span<const Point3> points() const noexcept { return points_; }
  [[nodiscard]] std::size_t first() const noexcept { return first_; }

 private:
  std::span<const Point3> points_;
  std::size_t first_ = 0;
  std::vector<std::uint32_t> sorted_;
  std::array<std::size_t, kBins + 2> begin_{};
};

/// Writes to first[i], for every vertex i of a bin, the first one at its place.
void weld_bin(std::span<const BinnedPart> parts, std::size_t bin, std::span<std::uint32_t> first) {
  VertexWelder welder(first.size() / kBins);
  std::vector<std::uint32_t> first_of;  // per distinct point
  first_of.reserve(first.size() / kBins);
  std::array<Point3, VertexWelder::kBatch> points;
  std::array<std::uint32_t, VertexWelder::kBatch> numbers;  // written before it is read
  std::array<std::uint32_t, VertexWelder::kBatch> welded;   // as well
  std::size_t filled = 0;
  const auto flush = [&] {
    welder.weld({points.data(), filled}, welded.data());
    for (std::size_t i = 0; i < filled; ++i) {
      if (welded[i] == first_of.size()) first_of.push_back(numbers[i]);
      first[numbers[i]] = first_of[welded[i]];
    }
    filled = 0;
  };
  for (const BinnedPart& part : parts) {
    part.for_each_in(bin, [&](std::uint32_t number, const Point3& point) {
      points[filled] = point;
      numbers[filled] = number;
      if (++filled == points.size()) flush();
    });
  }
  flush();
}

/// Numbers the places of vertices in order of first appearance: one number for each vertex of the
/// parts, and the places.
std::pair<std::vector<std::uint32_t>, std::vector<Point3>> number_places(
    std::span<const BinnedPart> parts, std::size_t vertices, const ParallelFor& parallel_for) {
  std::vector<std::uint32_t> place(vertices);
  parallel_for(kBins, [&](std::size_t bin) { weld_bin(parts, bin, place); });
  std::vector<Point3> places;
  places.reserve(vertices);
  for (const BinnedPart& part : parts) {
    std::size_t number = part.first();
    for (const Point3& point : part.points()) {
      const std::uint32_t first = place[number];
      if (first == number) {
        place[number] = static_cast<std::uint32_t>(places.size());
        places.push_back(point);
      } else {
        place[number] = place[first];  // which has its number already
      }
      ++number;
    }
  }
  return {std::move(place), std::move(places)};
}

}  // namespace

Mesh join_parts(std::vector<Mesh> parts, const ParallelFor& parallel_for) {
  if (parts.size() == 1) return std::move(parts[0]);
  std::vector<std::size_t> first_vertex{0};
  std::vector<std::size_t> first_triangle{0};
  for (const Mesh& part : parts) {
    first_vertex.push_back(first_vertex.back() + part.vertices.size());
    first_triangle.push_back(first_triangle.back() + part.triangles.size());
  }
  std::vector<BinnedPart> binned(parts.size());
  parallel_for(parts.size(), [&](std::size_t part) {
    binned[part] = BinnedPart(parts[part].vertices, first_vertex[part]);
  });
  auto [place, places] = number_places(binned, first_vertex.back(), parallel_for);
  binned = {};
  for (Mesh& part : parts) part.vertices = {};  // what comes next takes as much

  Mesh mesh;
  mesh.vertices = std::move(places);
  mesh.triangles.resize(first_triangle.back());
  const std::vector<std::uint32_t>& number = place;
  parallel_for(parts.size(), [&](std::size_t part) {
    const std::uint32_t* const own = number.data() + first_vertex[part];
    auto* to = mesh.triangles.data() + first_triangle[part];
    for (const auto& [a, b, c] : parts[part].triangles) *to++ = {own[a], own[b], own[c]};
    parts[part] = {};  // its memory is the next one's
  });
  return mesh;
}

}  // namespace routebench::models
