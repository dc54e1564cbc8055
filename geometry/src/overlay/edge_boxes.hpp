#pragma once
/// The boxes around edges, eight at a time.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "overlay/grid_rings.hpp"

namespace routebench::overlay {

/// So many edges are found sooner by their boxes than by cells, however they lie.
inline constexpr std::uint32_t kFewEdges = 1024;

/// Boxes by the number of their edge. Of few edges, those that come near one are found sooner by a
/// look at all than by any order among them. Of more, the boxes around every eight edges are looked
/// at first, as edges that follow each other lie together.
class EdgeBoxes {
 public:
  EdgeBoxes(std::uint32_t edges, std::pmr::memory_resource* memory)
      : eights_(memory), groups_(memory) {
    resize(edges);
  }

  /// Boxes that are added meet nothing until they are set.
  void resize(std::uint32_t edges) {
    const std::size_t ungrouped = groups_.empty() ? 8 * eights_.size() : 0;
    eights_.resize((edges + 7) / 8);
    if (edges <= kUngrouped) return;
    groups_.resize((eights_.size() + 7) / 8);
    for (std::uint32_t edge = 0; edge < ungrouped; ++edge) widen_group(edge);
  }

  void set(std::uint32_t edge, const GridBox& box) {
    eights_[edge / 8].set(edge % 8, box);
    if (!groups_.empty()) widen_group(edge);
  }

  [[nodiscard]] GridBox operator[](std::uint32_t edge) const {
    return eights_[edge / 8].box(edge % 8);
  }

  /// Calls visit(edge) for each of the first `edges` whose box meets another one.
  /// Cost  two instructions a box.
  template <typename Visit>
  void visit_meeting(const GridBox& box, std::uint32_t edges, Visit&& visit) const {
    if (groups_.empty()) return visit_bits(meeting(eights_, 0, edges, box), 0, visit);
    const std::uint32_t eights = (edges + 7) / 8;
    const auto look_at = [&](std::uint32_t eight) {
      visit_bits(first_of(eights_[eight].meeting(box), edges - 8 * eight), 8 * eight, visit);
    };
    for (std::uint32_t first = 0; first < eights; first += 64)
      visit_bits(meeting(groups_, first, eights, box), first, look_at);
  }

  /// Calls visit(edge, other) for each two whose boxes meet, the other before the edge, but not
  /// just before it: edges of one ring that follow each other always meet.
  /// Cost  of few edges, that of visit_meeting() for each; else about a third.
  template <typename Visit>
  void visit_meeting_pairs(std::uint32_t edges, Visit&& visit) const {
    if (groups_.empty()) {
      for (std::uint32_t edge = 2; edge < edges; ++edge)
        visit_meeting((*this)[edge], edge - 1, [&](std::uint32_t other) { visit(edge, other); });
      return;
    }
    // Only edges that meet the box around eight others look at those.
    const auto look_at = [&](std::uint32_t eight, std::uint32_t other) {
      visit_bits(first_of(eights_[eight].meeting(box_of_eight(other)), edges - 8 * eight),
                 8 * eight, [&](std::uint32_t edge) {
                   const std::uint32_t before_it = std::max(edge, 8 * other + 1) - 8 * other - 1;
                   visit_bits(first_of(eights_[other].meeting((*this)[edge]), before_it), 8 * other,
                              [&](std::uint32_t before) { visit(edge, before); });
                 });
    };
    for (std::uint32_t eight = 0; 8 * eight < edges; ++eight) {
      const GridBox box = box_of_eight(eight);
      for (std::uint32_t first = 0; first <= eight; first += 64)
        visit_bits(meeting(groups_, first, eight + 1, box), first,
                   [&](std::uint32_t other) { look_at(eight, other); });
    }
  }

  /// Whether is_it(edge, other) holds for any two whose boxes meet, of these and of others.
  template <typename IsIt>
  [[nodiscard]] bool any_meeting_pair(const EdgeBoxes& others, IsIt&& is_it) const {
    bool found = false;
    const auto look_at = [&](std::uint32_t eight, std::uint32_t other) {
      visit_bits(eights_[eight].meeting(others.box_of_eight(other)), 8 * eight,
                 [&](std::uint32_t e) {
                   visit_bits(others.eights_[other].meeting((*this)[e]), 8 * other,
                              [&](std::uint32_t f) { found = found || is_it(e, f); });
                 });
    };
    for (std::uint32_t eight = 0; eight < eights_.size() && !found; ++eight) {
      const GridBox box = box_of_eight(eight);
      const auto look = [&](std::uint32_t other) { look_at(eight, other); };
      if (others.groups_.empty())
        for (std::uint32_t other = 0; other < others.eights_.size(); ++other) look(other);
      else
        for (std::uint32_t first = 0; first < others.eights_.size(); first += 64)
          visit_bits(meeting(others.groups_, first, others.eights_.size(), box), first, look);
    }
    return found;
  }

 private:
  static constexpr std::uint32_t kUngrouped = 64;  // edges

  using Coordinates = std::array<std::int32_t, 8>;

  static constexpr Coordinates all(std::int32_t value) {
    return {value, value, value, value, value, value, value, value};
  }

  /// Calls visit(begin + number) for each bit that is set. One loop over many bits ends where
  /// nobody can foresee less often than many over few.
  template <typename Visit>
  static void visit_bits(std::uint64_t bits, std::uint32_t begin, Visit&& visit) {
    for (; bits != 0; bits &= bits - 1)
      visit(begin + static_cast<std::uint32_t>(std::countr_zero(bits)));
  }
  static std::uint64_t first_of(std::uint64_t bits, std::size_t count) {
    return count < 64 ? bits & ((std::uint64_t{1} << count) - 1) : bits;
  }

  struct alignas(16) Eight {
    Coordinates left = all(kMaxUnits + 1), low = left, right = all(-kMaxUnits - 1), high = right;

    [[nodiscard]] GridBox box(std::size_t k) const {
      return {{left[k], low[k]}, {right[k], high[k]}};
    }
    /// Around all eight.
    [[nodiscard]] GridBox box() const {
      GridBox around = box(0);
      for (std::size_t k = 1; k < 8; ++k) {
        around.lower = {std::min(around.lower.x, left[k]), std::min(around.lower.y, low[k])};
        around.upper = {std::max(around.upper.x, right[k]), std::max(around.upper.y, high[k])};
      }
      return around;
    }
    void set(std::size_t k, const GridBox& box) {
      left[k] = box.lower.x;
      low[k] = box.lower.y;
      right[k] = box.upper.x;
      high[k] = box.upper.y;
    }
    void widen(std::size_t k, const GridBox& box) {
      left[k] = std::min(left[k], box.lower.x);
      low[k] = std::min(low[k], box.lower.y);
      right[k] = std::max(right[k], box.upper.x);
      high[k] = std::max(high[k], box.upper.y);
    }

    /// A bit for each that meets a box.
    [[nodiscard]] std::uint32_t meeting(const GridBox& box) const {
#if defined(__SSE2__)
      const auto apart = [&](std::size_t k) {
        const auto four = [k](const Coordinates& eight) {
          return _mm_load_si128(reinterpret_cast<const __m128i*>(eight.data() + k));
        };
        const auto beside = _mm_or_si128(_mm_cmpgt_epi32(four(left), _mm_set1_epi32(box.upper.x)),
                                         _mm_cmpgt_epi32(_mm_set1_epi32(box.lower.x), four(right)));
        const auto above = _mm_or_si128(_mm_cmpgt_epi32(four(low), _mm_set1_epi32(box.upper.y)),
                                        _mm_cmpgt_epi32(_mm_set1_epi32(box.lower.y), four(high)));
        return _mm_or_si128(beside, above);
      };
      const __m128i bytes = _mm_packs_epi16(_mm_packs_epi32(apart(0), apart(4)), __m128i{});
      return ~static_cast<std::uint32_t>(_mm_movemask_epi8(bytes)) & 0xFFU;
#else
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 8; ++k)
        bits |= static_cast<std::uint32_t>(this->box(k).meets(box)) << k;
      return bits;
#endif
    }
  };

  /// A bit for each of up to 64 boxes, from `first` to before `end`, that meets another one. Takes
  /// a first one that begins an eight.
  [[nodiscard]] static std::uint64_t meeting(const std::pmr::vector<Eight>& eights,
                                             std::size_t first, std::size_t end,
                                             const GridBox& box) {
    const std::size_t count = std::min<std::size_t>(end - first, 64);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < count; i += 8)
      bits |= std::uint64_t{eights[(first + i) / 8].meeting(box)} << i;
    return first_of(bits, count);
  }

  [[nodiscard]] GridBox box_of_eight(std::uint32_t eight) const {
    return groups_.empty() ? eights_[eight].box() : groups_[eight / 8].box(eight % 8);
  }

  void widen_group(std::uint32_t edge) {
    groups_[edge / 64].widen(edge / 8 % 8, eights_[edge / 8].box(edge % 8));
  }

  std::pmr::vector<Eight> eights_;
  std::pmr::vector<Eight> groups_;  // boxes of eights; none of few
};

}  // namespace routebench::overlay
