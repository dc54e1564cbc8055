#pragma once
/// Which triangles meet at which edge.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "large_vector.hpp"
#include "routebench/geometry/parallel.hpp"

namespace routebench::models {

/// The sides of all triangles, grouped by the edge that they lie on, range by range: each stretch
/// of triangles has a range of edges, those whose lower vertex it is the first to use. Nearly all
/// of their sides are found in that stretch, where a mesh's triangles follow their neighbours; the
/// others are kept. So a range's edges are made when they are asked for, near to the processor.
///
/// Cost   a counting sort by the lower vertex, linear; 16 bytes a side that is kept, for a moment
///        twice as many.
class EdgeTable {
 public:
  static constexpr std::size_t kTrianglesPerRange = std::size_t{1} << 15U;

  /// A triangle's side as seen from the edge's lower vertex.
  class Side {
   public:
    Side() = default;
    constexpr Side(std::uint32_t upper, std::uint32_t triangle, bool rising) noexcept
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
    std::uint64_t bits_;
  };

  /// Takes at most 2^31 triangles, none with a corner twice, which outlive the table.
  EdgeTable(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices,
            const ParallelFor& parallel_for = serial_for);

  [[nodiscard]] std::size_t ranges() const noexcept { return first_vertex_.size() - 1; }
  /// The stretch of triangles of a range: first and last + 1.
  [[nodiscard]] std::pair<std::size_t, std::size_t> triangles_of(std::size_t range) const noexcept {
    const std::size_t begin = range * kTrianglesPerRange;
    return {begin, std::min(begin + kTrianglesPerRange, triangles_.size())};
  }
  /// Whose stretch a triangle is in.
  [[nodiscard]] static std::size_t range_of(std::uint32_t triangle) noexcept {
    return triangle / kTrianglesPerRange;
  }

  /// Calls visit(lower vertex, sides) for every edge of a range, by rising vertex numbers; sides by
  /// rising triangle. The sides are gone afterwards.
  template <typename Visit>
  void for_each_edge(std::size_t range, Visit&& visit) const {
    const SortedSides sorted = sorted_sides(range);
    std::uint32_t lower = first_vertex_[range];
    for (std::size_t v = 0; v + 1 < sorted.begin.size(); ++v, ++lower) {
      const std::span<const Side> all(sorted.sides.data() + sorted.begin[v],
                                      sorted.begin[v + 1] - sorted.begin[v]);
      for (std::size_t first = 0, next = 0; first < all.size(); first = next) {
        while (next < all.size() && all[next].upper() == all[first].upper()) ++next;
        visit(lower, all.subspan(first, next - first));
      }
    }
  }
  /// The same for all ranges.
  template <typename Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t range = 0; range < ranges(); ++range) for_each_edge(range, visit);
  }

 private:
  /// A side on an edge of a range that is not its triangle's.
  struct Stray {
    std::uint32_t lower;
    Side side;
  };
  struct SortedSides {
    std::vector<std::uint32_t> begin;  ///< per vertex of the range, and the end
    LargeVector<Side> sides;
  };

  /// Calls visit(lower, side) for a triangle's sides.
  template <typename Visit>
  void for_each_side_of(std::size_t triangle, Visit&& visit) const;
  /// Sides in the stretch of a range that lie on edges of others, by the edge's range.
  struct Strays {
    struct Group {
      std::uint32_t range;
      std::span<const Stray> strays;
    };
    LargeVector<Stray> strays;
    std::vector<Group> groups;
  };
  [[nodiscard]] Strays strays_from(std::size_t range) const;
  [[nodiscard]] SortedSides sorted_sides(std::size_t range) const;

  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> first_vertex_;                    ///< of each range, and the end
  std::vector<Strays> strays_;                                 ///< from the stretch of each range
  std::vector<std::vector<std::span<const Stray>>> received_;  ///< on the edges of each range
};

}  // namespace routebench::models
