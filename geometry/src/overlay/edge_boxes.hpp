#pragma once
/// The boxes around edges, eight at a time.

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

/// Boxes by the number of their edge. Of few edges, those that come near one are found sooner by a
/// look at all than by any order among them.
class EdgeBoxes {
 public:
  explicit EdgeBoxes(std::pmr::memory_resource* memory) : eights_(memory) {}

  /// Boxes that are added meet nothing until they are set.
  void resize(std::size_t edges) { eights_.resize((edges + 7) / 8); }

  void set(std::uint32_t edge, const GridBox& box) {
    Eight& eight = eights_[edge / 8];
    const std::size_t k = edge % 8;
    eight.left[k] = box.lower.x;
    eight.low[k] = box.lower.y;
    eight.right[k] = box.upper.x;
    eight.high[k] = box.upper.y;
  }

  [[nodiscard]] GridBox operator[](std::uint32_t edge) const {
    const Eight& eight = eights_[edge / 8];
    const std::size_t k = edge % 8;
    return {{eight.left[k], eight.low[k]}, {eight.right[k], eight.high[k]}};
  }

  /// Calls visit(edge) for each of the first `edges` whose box meets another one.
  /// Cost  two instructions a box.
  template <typename Visit>
  void visit_meeting(const GridBox& box, std::uint32_t edges, Visit&& visit) const {
    for (std::uint32_t begin = 0; begin < edges; begin += 8) {
      std::uint32_t meeting = eights_[begin / 8].meeting(box);
      if (edges - begin < 8) meeting &= (1U << (edges - begin)) - 1;
      for (; meeting != 0; meeting &= meeting - 1)
        visit(begin + static_cast<std::uint32_t>(std::countr_zero(meeting)));
    }
  }

 private:
  using Coordinates = std::array<std::int32_t, 8>;

  static constexpr Coordinates all(std::int32_t value) {
    return {value, value, value, value, value, value, value, value};
  }

  struct Eight {
    Coordinates left = all(kMaxUnits + 1), low = left, right = all(-kMaxUnits - 1), high = right;

    /// A bit for each that meets a box.
    [[nodiscard]] std::uint32_t meeting(const GridBox& box) const {
#if defined(__SSE2__)
      const auto apart = [&](std::size_t k) {
        const auto four = [k](const Coordinates& eight) {
          return _mm_loadu_si128(reinterpret_cast<const __m128i*>(eight.data() + k));
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
      for (std::size_t k = 0; k < 8; ++k) {
        const GridBox one{{left[k], low[k]}, {right[k], high[k]}};
        bits |= static_cast<std::uint32_t>(one.meets(box)) << k;
      }
      return bits;
#endif
    }
  };

  std::pmr::vector<Eight> eights_;
};

}  // namespace routebench::overlay
