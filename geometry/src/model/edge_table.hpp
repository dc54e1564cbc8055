#pragma once
/// Which triangles meet at which edge.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "routebench/geometry/parallel.hpp"

namespace routebench::models {

/// The sides of all triangles, grouped by the edge that they lie on.
///
/// Cost   a counting sort by the lower vertex: linear, 8 bytes a side and 4 a vertex.
class EdgeTable {
 public:
  /// A triangle's side as seen from the edge's lower vertex.
  class Side {
   public:
    Side() = default;
    Side(std::uint32_t upper, std::uint32_t triangle, bool rising) noexcept
        : bits_(std::uint64_t{upper} << 32U | std::uint64_t{triangle} << 1U | (rising ? 1U : 0U)) {}
    /// The edge's vertex with the higher number.
    [[nodiscard]] std::uint32_t upper() const noexcept {
      return static_cast<std::uint32_t>(bits_ >> 32U);
    }
    [[nodiscard]] std::uint32_t triangle() const noexcept {
      return static_cast<std::uint32_t>(bits_) >> 1U;
    }
    /// Whether the triangle runs from the lower to the upper vertex.
    [[nodiscard]] bool rising() const noexcept { return (bits_ & 1U) != 0; }
    friend auto operator<=>(const Side&, const Side&) = default;

   private:
    std::uint64_t bits_ = 0;
  };

  /// Takes at most 2^31 triangles, none with a corner twice.
  EdgeTable(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices,
            const ParallelFor& parallel_for = serial_for);

  /// Calls visit(lower vertex, sides) for every edge, by rising vertex numbers; sides by rising
  /// triangle.
  template <typename Visit>
  void for_each_edge(Visit&& visit) const {
    for_each_edge(0, begin_.size() - 1, visit);
  }
  /// The same for edges whose lower vertex is one of [first_vertex, last_vertex).
  template <typename Visit>
  void for_each_edge(std::size_t first_vertex, std::size_t last_vertex, Visit&& visit) const {
    for (std::size_t lower = first_vertex; lower < last_vertex; ++lower) {
      const std::span<const Side> all(sides_.data() + begin_[lower],
                                      begin_[lower + 1] - begin_[lower]);
      for (std::size_t first = 0, next = 0; first < all.size(); first = next) {
        while (next < all.size() && all[next].upper() == all[first].upper()) ++next;
        visit(static_cast<std::uint32_t>(lower), all.subspan(first, next - first));
      }
    }
  }

 private:
  std::vector<std::uint32_t> begin_;  // per lower vertex, and the end
  std::vector<Side> sides_;
};

}  // namespace routebench::models
