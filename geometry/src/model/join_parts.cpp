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

std::uint8_t bin_of(const Point3& p) noexcept {
  return static_cast<std::uint8_t>(VertexWelder::tag_of(p) >> 28U);
}
static_assert(kBins == 1U << 4U, "a bin is the top four bits of a tag");

/// The vertices of all parts, one after the other.
class AllVertices {
 public:
  explicit AllVertices(const std::vector<Mesh>& parts) : parts_(parts), begin_{0} {
    for (const Mesh& part : parts) begin_.push_back(begin_.back() + part.vertices.size());
  }
  [[nodiscard]] std::size_t begin(std::size_t part) const { return begin_[part]; }
  [[nodiscard]] std::size_t size() const { return begin_.back(); }

  /// Calls visit(number, point) in order.
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      std::size_t number = begin_[part];
      for (const Point3& point : parts_[part].vertices) visit(number++, point);
    }
  }

 private:
  const std::vector<Mesh>& parts_;
  std::vector<std::size_t> begin_;
};

/// Writes to first[i], for every vertex i of a bin, the first one at its place.
void weld_bin(const AllVertices& all, std::span<const std::uint8_t> bins, std::size_t bin,
              std::span<std::uint32_t> first) {
  VertexWelder welder(all.size() / kBins);
  std::vector<std::uint32_t> first_of;  // per distinct point
  std::array<Point3, VertexWelder::kBatch> points;
  std::array<std::uint32_t, VertexWelder::kBatch> numbers;
  std::array<std::uint32_t, VertexWelder::kBatch> welded;
  std::size_t filled = 0;
  const auto flush = [&] {
    welder.weld({points.data(), filled}, welded.data());
    for (std::size_t i = 0; i < filled; ++i) {
      if (welded[i] == first_of.size()) first_of.push_back(numbers[i]);
      first[numbers[i]] = first_of[welded[i]];
    }
    filled = 0;
  };
  all.for_each([&](std::size_t number, const Point3& point) {
    if (bins[number] != bin) return;
    points[filled] = point;
    numbers[filled] = static_cast<std::uint32_t>(number);
    if (++filled == points.size()) flush();
  });
  flush();
}

/// For every vertex the number of its place, places being numbered in order of first appearance,
/// and the places.
std::pair<std::vector<std::uint32_t>, std::vector<Point3>> weld(const std::vector<Mesh>& parts,
                                                                const AllVertices& all,
                                                                const ParallelFor& parallel_for) {
  std::vector<std::uint8_t> bins(all.size());
  parallel_for(parts.size(), [&](std::size_t part) {
    std::size_t number = all.begin(part);
    for (const Point3& point : parts[part].vertices) bins[number++] = bin_of(point);
  });
  std::vector<std::uint32_t> place(all.size());
  parallel_for(kBins, [&](std::size_t bin) { weld_bin(all, bins, bin, place); });

  std::vector<Point3> places;
  places.reserve(all.size());
  all.for_each([&](std::size_t number, const Point3& point) {
    const std::uint32_t first = place[number];
    if (first == number) {
      place[number] = static_cast<std::uint32_t>(places.size());
      places.push_back(point);
    } else {
      place[number] = place[first];  // which has its number already
    }
  });
  return {std::move(place), std::move(places)};
}

}  // namespace

Mesh join_parts(std::vector<Mesh> parts, const ParallelFor& parallel_for) {
  if (parts.size() == 1) return std::move(parts[0]);
  const AllVertices all(parts);
  auto [place, places] = weld(parts, all, parallel_for);

  std::vector<std::size_t> begin{0};
  for (const Mesh& part : parts) begin.push_back(begin.back() + part.triangles.size());
  Mesh mesh;
  mesh.vertices = std::move(places);
  mesh.triangles.resize(begin.back());
  const std::vector<std::uint32_t>& number = place;
  parallel_for(parts.size(), [&](std::size_t part) {
    const std::uint32_t* const own = number.data() + all.begin(part);
    auto* to = mesh.triangles.data() + begin[part];
    for (const auto& [a, b, c] : parts[part].triangles) *to++ = {own[a], own[b], own[c]};
    parts[part] = {};  // its memory is the next one's
  });
  return mesh;
}

}  // namespace routebench::models
