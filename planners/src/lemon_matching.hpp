#pragma once
/// Minimum-weight perfect matching by LEMON behind a plain interface. LEMON's headers do not
/// compile as C++20, so this header and its one source file stay within C++17.

#include <cstdint>
#include <vector>

namespace routebench::lemon_matching {

struct WeightedPair {
  std::uint32_t a;
  std::uint32_t b;
  std::int64_t weight;
};

/// A set of nodes that the proof of optimality treats as one, and what it pays for that.
struct Blossom {
  std::vector<std::uint32_t> nodes;
  std::int64_t price;
};

/// A matching with the proof that it is the lightest: for every given pair
///
///     kPriceScale * weight >= price[a] + price[b] - (prices of the blossoms that hold both),
///
/// with equality for those that are matched. A pair that was not given and keeps this as well could
/// not have made the matching lighter.
struct Solution {
  std::vector<std::uint32_t> mate;  ///< empty if there is no perfect matching
  std::vector<std::int64_t> price;  ///< one a node
  std::vector<Blossom> blossoms;    ///< nested or disjoint
};

constexpr std::int64_t kPriceScale = 4;

/// Takes   pairs of different nodes below node_count, |weight| < 2^58.
Solution solve(std::uint32_t node_count, const std::vector<WeightedPair>& pairs);

}  // namespace routebench::lemon_matching
