#pragma once
/// Sets of triangles that grow together, with the direction of each triangle in its set.

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace routebench::models {

/// Union-find in which every member knows whether it runs with or against its set's first member.
class TriangleSets {
 public:
  explicit TriangleSets(std::size_t count) : parent_(count), against_(count, false) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  struct Place {
    std::uint32_t set;  ///< the lowest member
    bool against;       ///< relative to that member
  };

  [[nodiscard]] Place find(std::uint32_t member) {
    bool against = false;
    std::uint32_t root = member;
    while (parent_[root] != root) {
      against ^= against_[root] != 0;
      root = parent_[root];
    }
    // Point everything on the way at the root.
    bool rest = against;
    while (parent_[member] != root) {
      const std::uint32_t next = std::exchange(parent_[member], root);
      const bool step = std::exchange(against_[member], rest ? 1 : 0) != 0;
      rest ^= step;
      member = next;
    }
    return {root, against};
  }

  /// Joins the sets of a and b, which run against each other or not. False if they are in one set
  /// already and it says otherwise.
  bool join(std::uint32_t a, std::uint32_t b, bool against) {
    const Place pa = find(a);
    const Place pb = find(b);
    const bool between = pa.against ^ pb.against ^ against;
    if (pa.set == pb.set) return !between;
    const auto [low, high] = std::minmax(pa.set, pb.set);
    parent_[high] = low;
    against_[high] = between ? 1 : 0;
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> against_;
};

}  // namespace routebench::models
