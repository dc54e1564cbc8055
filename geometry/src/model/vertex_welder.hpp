#pragma once
/// Exact welding: equal corners become one vertex.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// A point as STL has it.
using FloatPoint = std::array<float, 3>;

/// The same without negative zeros: -0.0 + 0.0 is 0.0.
[[nodiscard]] inline Point3 without_negative_zeros(const Point3& p) noexcept {
  return {p.x + 0.0, p.y + 0.0, p.z + 0.0};
}

/// 32 bits of a hash of a point without negative zeros. Its low bits choose a slot.
[[nodiscard]] inline std::uint32_t tag_of(const Point3& point) noexcept {
  std::uint64_t h = std::bit_cast<std::uint64_t>(point.x) * 0x9E3779B97F4A7C15U;
  h = std::rotl(h, 29) ^ std::bit_cast<std::uint64_t>(point.y);
  h *= 0xBF58476D1CE4E5B9U;
  h = std::rotl(h, 31) ^ std::bit_cast<std::uint64_t>(point.z);
  h *= 0x94D049BB133111EBU;
  return static_cast<std::uint32_t>(h >> 32U);
}
[[nodiscard]] inline std::uint32_t tag_of(const FloatPoint& point) noexcept {
  std::uint64_t xy = 0;
  std::memcpy(&xy, point.data(), sizeof xy);
  std::uint64_t h = xy * 0x9E3779B97F4A7C15U;
  h = std::rotl(h, 29) ^ std::bit_cast<std::uint32_t>(point[2]);
  h *= 0xBF58476D1CE4E5B9U;
  return static_cast<std::uint32_t>(h >> 32U);
}

/// Gives equal points (Point3 or FloatPoint) equal numbers, in order of first appearance.
///
/// An open-addressing table that grows with the number of distinct points, so that no count of a
/// file is trusted. Points come in batches: all their slots are fetched from memory at once.
template <typename Point>
class VertexWelder {
 public:
  static constexpr std::size_t kBatch = 48;

  /// `expected` distinct points: a guess that only saves time.
  explicit VertexWelder(std::size_t expected);

  /// Replaces negative zeros in `points` by zeros and writes each point's number to `indices`.
  /// Takes at most kBatch points; the distinct ones in all must stay below 2^32 - 1. Points that
  /// are not finite get some number, and stay what they are.
  void weld(std::span<Point> points, std::uint32_t* indices);

  /// The distinct points so far.
  [[nodiscard]] const std::vector<Point>& vertices() const noexcept { return vertices_; }
  /// The same; the welder is empty afterwards.
  [[nodiscard]] std::vector<Point> take_vertices();

 private:
  /// A part of the hash, which also gives the place, and the vertex number + 1; 0 is a free slot.
  struct Slot {
    std::uint32_t tag = 0;
    std::uint32_t vertex = 0;
  };

  void grow();

  std::vector<Slot> slots_;
  std::size_t mask_;
  std::vector<Point> vertices_;
};

extern template class VertexWelder<Point3>;
extern template class VertexWelder<FloatPoint>;

/// Welds the vertices of an indexed mesh, in place, and drops those that no triangle uses.
void weld_mesh(Mesh& mesh);

}  // namespace routebench::models
