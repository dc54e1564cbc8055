#include "model/content_hash.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace routebench::models {
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

}  // namespace

std::uint64_t content_hash(const Mesh& mesh) {
  std::vector<std::uint64_t> points(mesh.vertices.size());
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), points.begin(), point_hash);
  std::uint64_t sum = 0;  // of the triangles' hashes: addition forgets their order
  for (const auto& t : mesh.triangles) {
    std::uint64_t a = points[t[0]];
    std::uint64_t b = points[t[1]];
    std::uint64_t c = points[t[2]];
    while (a > b || a > c) {
      const std::uint64_t first = a;
      a = b;
      b = c;
      c = first;
    }
    sum += chain(chain(a, b), c);
  }
  return mix(sum + mesh.triangles.size());
}

}  // namespace routebench::models
