#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>
#include <vector>

#include "large_vector.hpp"
#include "model/blocks.hpp"
#include "routebench/geometry/model.hpp"

namespace routebench {
namespace {

/// A bijection of 64-bit numbers in which every input bit moves about half of the output bits.
std::uint64_t mix(std::uint64_t h) noexcept {
  h ^= h >> 32U;
  h *= 0xE9846AF9B1A615DU;
  h ^= h >> 32U;
  h *= 0xE9846AF9B1A615DU;
  h ^= h >> 28U;
  return h;
}

std::uint64_t chain(std::uint64_t seed, std::uint64_t next) noexcept {
  return mix(std::rotl(seed, 23) + 0x9E3779B97F4A7C15U + next);
}

std::uint64_t point_hash(const Point3& p) noexcept {
  const std::uint64_t xy =
      chain(std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0));
  return chain(xy, std::bit_cast<std::uint64_t>(p.z + 0.0));
}

/// Whichever corner comes first. Without branches, which nobody could foresee.
std::uint64_t triangle_hash(std::uint64_t a, std::uint64_t b, std::uint64_t c) noexcept {
  const std::uint64_t all = a ^ b ^ c;
  const auto all_if = [](bool is) { return 0 - static_cast<std::uint64_t>(is); };
  const std::uint64_t least = std::min(std::min(a, b), c);
  // Of equal corners the first one counts; which one is seen in what follows it.
  const std::uint64_t a_is_least = all_if(a == least), b_is_least = all_if(b == least);
  const std::uint64_t next =
      (b & a_is_least) | (~a_is_least & ((c & b_is_least) | (a & ~b_is_least)));
  return chain(chain(least, next), all ^ least ^ next);
}

}  // namespace

std::uint64_t content_hash(const Mesh& mesh, const ParallelFor& parallel_for) {
  LargeVector<std::uint64_t> points(mesh.vertices.size());
  models::for_each_block(points.size(), parallel_for,
                         [&](std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t v = begin; v < end; ++v)
                             points[v] = point_hash(mesh.vertices[v]);
                         });
  // Sums of the triangles' hashes: addition forgets their order.
  std::vector<std::uint64_t> sums(models::block_count(mesh.triangles.size()));
  const auto add_up = [&](std::size_t block, std::size_t begin, std::size_t end) {
    std::uint64_t sum = 0;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [i, j, k] = mesh.triangles[t];
      sum += triangle_hash(points[i], points[j], points[k]);
    }
    sums[block] = sum;
  };
  models::for_each_block(mesh.triangles.size(), parallel_for, add_up);
  return mix(std::accumulate(sums.begin(), sums.end(), std::uint64_t{mesh.triangles.size()}));
}

}  // namespace routebench
