#include "model/join_parts.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <iterator>
#include <span>
#include <utility>

#include "large_vector.hpp"
#include "model/blocks.hpp"

namespace routebench::models {
namespace {

/// Finds equal points while several threads add theirs.
class SharedWelder {
 public:
  SharedWelder(std::span<const FloatPoint> points, const ParallelFor& parallel_for)
      : points_(points),
        slots_(std::bit_ceil(points.size() + points.size() / 2 + 2)),
        mask_(slots_.size() - 1),
        earlier_(points.size()) {
    const auto clear = [&](std::size_t, std::size_t begin, std::size_t end) {
      std::fill(slots_.data() + begin, slots_.data() + end, 0);
    };
    for_each_block(slots_.size(), parallel_for, clear);
  }

  /// Adds the points [begin, end).
  void add(std::size_t begin, std::size_t end) noexcept {
    constexpr std::size_t kBatch = 32;
    std::array<std::uint32_t, kBatch> tags;  // written before it is read
    for (std::size_t first = begin; first < end; first += kBatch) {
      const std::size_t last = std::min(end, first + kBatch);
      for (std::size_t i = first; i < last; ++i) {
        earlier_[i] = static_cast<std::uint32_t>(i);
        tags[i - first] = tag_of(points_[i]);
        __builtin_prefetch(&slots_[tags[i - first] & mask_], 1);
      }
      for (std::size_t i = first; i < last; ++i) add(i, tags[i - first]);
    }
  }

  // When all points were added:

  [[nodiscard]] bool is_first(std::size_t number) const noexcept {
    return earlier_[number] == number;
  }
  /// The first of all points that equal one.
  [[nodiscard]] std::size_t first(std::size_t number) const noexcept {
    while (!is_first(number)) number = earlier_[number];
    return number;
  }

 private:
  /// Of two equal points that meet at a slot, the earlier one stays there. The later one leaves for
  /// good, so nobody else writes down who was earlier.
  void add(std::size_t number, std::uint32_t tag) noexcept {
    const std::uint64_t own = std::uint64_t{tag} << 32U | (number + 1);
    for (std::size_t place = tag & mask_;; place = (place + 1) & mask_) {
      std::atomic_ref slot(slots_[place]);
      std::uint64_t there = slot.load(std::memory_order_acquire);
      if (there == 0 && slot.compare_exchange_strong(there, own)) return;
      if (there >> 32U != tag || points_[number_in(there)] != points_[number]) continue;
      while (own < there && !slot.compare_exchange_weak(there, own)) {
      }
      earlier_[number_in(std::max(own, there))] = number_in(std::min(own, there));
      return;
    }
  }
  [[nodiscard]] static std::uint32_t number_in(std::uint64_t slot) noexcept {
    return static_cast<std::uint32_t>(slot) - 1;
  }

  std::span<const FloatPoint> points_;
  LargeVector<std::uint64_t> slots_;  ///< tag and number + 1; 0 is free
  std::size_t mask_;
  LargeVector<std::uint32_t> earlier_;  ///< of each point: one that equals it, or itself
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
  const auto begin =
      beginnings(parts.size(), [&](std::size_t p) { return parts[p].vertices.size(); });
  LargeVector<FloatPoint> points(begin.back());
  parallel_for(parts.size(), [&](std::size_t p) {
    std::copy(parts[p].vertices.begin(), parts[p].vertices.end(), points.data() + begin[p]);
    parts[p].vertices = {};
  });

  SharedWelder welder(points, parallel_for);
  std::vector<std::size_t> places(parts.size());
  parallel_for(parts.size(), [&](std::size_t p) { welder.add(begin[p], begin[p + 1]); });
  parallel_for(parts.size(), [&](std::size_t p) {
    for (std::size_t v = begin[p]; v < begin[p + 1]; ++v)
      if (welder.is_first(v)) ++places[p];
  });
  const auto place = beginnings(parts.size(), [&](std::size_t p) { return places[p]; });
  resize_large(vertices, place.back(), parallel_for);
  LargeVector<std::uint32_t> number(points.size());  // of the place of a vertex that is the first
  parallel_for(parts.size(), [&](std::size_t p) {
    std::size_t next = place[p];
    for (std::size_t v = begin[p]; v < begin[p + 1]; ++v) {
      if (!welder.is_first(v)) continue;
      vertices[next] = in_double_precision(points[v]);
      number[v] = static_cast<std::uint32_t>(next++);
    }
  });
  parallel_for(parts.size(), [&](std::size_t p) {
    std::vector<std::uint32_t> own(begin[p + 1] - begin[p]);
    for (std::size_t v = 0; v < own.size(); ++v) own[v] = number[welder.first(begin[p] + v)];
    for (auto& triangle : parts[p].triangles)
      for (std::uint32_t& corner : triangle) corner = own[corner];
  });
  return vertices;
}

}  // namespace routebench::models
