#include "model/join_parts.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>

#include "large_vector.hpp"
#include "model/blocks.hpp"

namespace routebench::models {
namespace {

/// Points of which there may be several, part by part.
struct PartedPoints {
  LargeVector<FloatPoint> points;
  std::vector<std::size_t> begin;  ///< of each part, and the end

  [[nodiscard]] std::size_t parts() const noexcept { return begin.size() - 1; }
};

/// Finds of each point the first that equals it.
///
/// Points are dealt out by their hashes first: into heaps so small that one table after the other
/// stays near to the processor, and that no two threads share one.
class FirstPoints {
 public:
  FirstPoints(const PartedPoints& parted, const ParallelFor& parallel_for)
      : parted_(parted),
        heaps_(std::bit_ceil(std::min(kMostHeaps, parted.points.size() / kPointsPerHeap + 1))),
        dealt_(parted.points.size()),
        first_(parted.points.size()) {
    const std::size_t parts = parted_.parts();
    std::vector<std::size_t> places(parts * heaps_);
    parallel_for(parts, [&](std::size_t part) {
      for_each_tag(part, [&, counts = places.data() + part * heaps_](std::size_t, Tag tag) {
        ++counts[heap_of(tag)];
      });
    });
    std::vector<std::size_t> begin(heaps_ + 1);
    std::size_t place = 0;
    for (std::size_t heap = 0; heap < heaps_; ++heap) {
      begin[heap] = place;
      for (std::size_t part = 0; part < parts; ++part)
        place += std::exchange(places[part * heaps_ + heap], place);
    }
    begin[heaps_] = place;
    parallel_for(parts, [&](std::size_t part) {
      for_each_tag(part, [&, next = places.data() + part * heaps_](std::size_t point, Tag tag) {
        dealt_[next[heap_of(tag)]++] = {tag, static_cast<std::uint32_t>(point)};
      });
    });
    parallel_for(heaps_, [&](std::size_t heap) {
      find_firsts(std::span(dealt_).subspan(begin[heap], begin[heap + 1] - begin[heap]));
    });
  }

  [[nodiscard]] std::uint32_t first(std::size_t point) const noexcept { return first_[point]; }
  [[nodiscard]] bool is_first(std::size_t point) const noexcept { return first_[point] == point; }

 private:
  using Tag = std::uint32_t;
  struct Dealt {
    Tag tag;
    std::uint32_t point;
  };
  static constexpr std::size_t kPointsPerHeap = std::size_t{1} << 12U;
  static constexpr std::size_t kMostHeaps = std::size_t{1} << 10U;

  /// Calls visit(point, tag) for the points of a part.
  template <typename Visit>
  void for_each_tag(std::size_t part, Visit&& visit) const {
    for (std::size_t i = parted_.begin[part]; i < parted_.begin[part + 1]; ++i)
      visit(i, tag_of(parted_.points[i]));
  }
  /// By the high bits, since the low ones choose a slot.
  [[nodiscard]] std::size_t heap_of(Tag tag) const noexcept {
    return std::uint64_t{tag} * heaps_ >> 32U;
  }
  /// Takes the points of a heap, the earlier ones first.
  void find_firsts(std::span<const Dealt> heap) {
    constexpr std::uint32_t kFree = 0xFFFFFFFFU;
    std::vector<Dealt> slots(std::bit_ceil(heap.size() * 2 + 1), Dealt{0, kFree});
    const std::size_t mask = slots.size() - 1;
    for (const Dealt& dealt : heap) {
      std::size_t place = dealt.tag & mask;
      while (slots[place].point != kFree &&
             (slots[place].tag != dealt.tag ||
              parted_.points[slots[place].point] != parted_.points[dealt.point]))
        place = (place + 1) & mask;
      if (slots[place].point == kFree) slots[place] = dealt;
      first_[dealt.point] = slots[place].point;
    }
  }

  const PartedPoints& parted_;
  std::size_t heaps_;
  LargeVector<Dealt> dealt_;          ///< heap after heap
  LargeVector<std::uint32_t> first_;  ///< of each point
};

Point3 in_double_precision(const FloatPoint& p) noexcept { return {p[0], p[1], p[2]}; }

/// Where each part begins among the items of all, and the end.
template <typename Count>
std::vector<std::size_t> beginnings(std::size_t parts, const Count& count) {
  std::vector<std::size_t> begin{0};
  for (std::size_t part = 0; part < parts; ++part) begin.push_back(begin.back() + count(part));
  return begin;
}

}  // namespace

std::vector<Point3> join_parts(std::span<WeldedPart> parts, const ParallelFor& parallel_for) {
  std::vector<Point3> vertices;
  if (parts.size() == 1) {
    std::transform(parts[0].vertices.begin(), parts[0].vertices.end(), std::back_inserter(vertices),
                   in_double_precision);
    return vertices;
  }
  PartedPoints parted;
  parted.begin = beginnings(parts.size(), [&](std::size_t p) { return parts[p].vertices.size(); });
  const std::vector<std::size_t>& begin = parted.begin;
  LargeVector<FloatPoint>& points = parted.points;
  points.resize(begin.back());
  parallel_for(parts.size(), [&](std::size_t p) {
    std::copy(parts[p].vertices.begin(), parts[p].vertices.end(), points.data() + begin[p]);
    parts[p].vertices = {};
  });

  const FirstPoints firsts(parted, parallel_for);
  std::vector<std::size_t> places(parts.size());
  parallel_for(parts.size(), [&](std::size_t p) {
    for (std::size_t v = begin[p]; v < begin[p + 1]; ++v)
      if (firsts.is_first(v)) ++places[p];
  });
  const auto place = beginnings(parts.size(), [&](std::size_t p) { return places[p]; });
  resize_large(vertices, place.back(), parallel_for);
  LargeVector<std::uint32_t> number(points.size());  // of the place of a vertex that is the first
  parallel_for(parts.size(), [&](std::size_t p) {
    std::size_t next = place[p];
    for (std::size_t v = begin[p]; v < begin[p + 1]; ++v) {
      if (!firsts.is_first(v)) continue;
      vertices[next] = in_double_precision(points[v]);
      number[v] = static_cast<std::uint32_t>(next++);
    }
  });
  parallel_for(parts.size(), [&](std::size_t p) {
    std::vector<std::uint32_t> own(begin[p + 1] - begin[p]);
    for (std::size_t v = 0; v < own.size(); ++v) own[v] = number[firsts.first(begin[p] + v)];
    for (auto& triangle : parts[p].triangles)
      for (std::uint32_t& corner : triangle) corner = own[corner];
  });
  return vertices;
}

}  // namespace routebench::models
