#pragma once
/// Cutting long arrays into blocks for a parallel loop.

#include <cstddef>

#include "routebench/geometry/parallel.hpp"

namespace routebench::models {

/// Items of an array that one call of a loop handles at most: few enough for what is known of them
/// to stay near the processor, many enough to be worth a call.
inline constexpr std::size_t kItemsPerBlock = std::size_t{1} << 16;

/// How many blocks for_each_block() makes of so many items, whatever the number of threads.
[[nodiscard]] constexpr std::size_t block_count(std::size_t items) noexcept {
  return (items + kItemsPerBlock - 1) / kItemsPerBlock;
}

/// Calls body(block, begin, end) for consecutive blocks of [0, items), equal but for one item.
template <typename Body>
void for_each_block(std::size_t items, const ParallelFor& parallel_for, const Body& body) {
  const std::size_t count = block_count(items);
  parallel_for(count, [&](std::size_t block) {
    body(block, items * block / count, items * (block + 1) / count);
  });
}

}  // namespace routebench::models
