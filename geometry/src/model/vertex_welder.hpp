#pragma once
/// Exact welding: equal corners become one vertex.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// Gives equal points equal numbers, in order of first appearance.
///
/// An open-addressing table that grows with the number of distinct points, so that no count of a
/// file is trusted. Points come in batches: all their slots are fetched from memory at once.
class VertexWelder {
 public:
  static constexpr std::size_t kBatch = 48;

  /// `expected` distinct points: a guess that only saves time.
  explicit VertexWelder(std::size_t expected);

  /// Replaces negative zeros in `points` by zeros and writes each point's number to `indices`.
  /// Takes at most kBatch finite points; the distinct ones in all must stay below 2^32 - 1.
  void weld(std::span<Point3> points, std::uint32_t* indices);

  /// 32 bits of a hash of a point without negative zeros. Its low bits choose the slot.
  [[nodiscard]] static std::uint32_t tag_of(const Point3& point) noexcept {
    std::uint64_t h = std::bit_cast<std::uint64_t>(point.x) * 0x9E3779B97F4A7C15U;
    h = std::rotl(h, 29) ^ std::bit_cast<std::uint64_t>(point.y);
    h *= 0xBF58476D1CE4E5B9U;
    h = std::rotl(h, 31) ^ std::bit_cast<std::uint64_t>(point.z);
    h *= 0x94D049BB133111EBU;
    return static_cast<std::uint32_t>(h >> 32U);
  }

  /// The distinct points; the welder is empty afterwards.
  [[nodiscard]] std::vector<Point3> take_vertices();

 private:
  /// A part of the hash, which also gives the place, and the vertex number + 1; 0 is a free slot.
  struct Slot {
    std::uint32_t tag = 0;
    std::uint32_t vertex = 0;
  };

  [[nodiscard]] std::uint32_t find_or_add(const Point3& point, std::uint32_t tag);
  void grow();

  std::vector<Slot> slots_;
  std::size_t mask_;
  std::vector<Point3> vertices_;
};

/// Welds the vertices of an indexed mesh, in place, and drops those that no triangle uses.
void weld_mesh(Mesh& mesh);

}  // namespace routebench::models
