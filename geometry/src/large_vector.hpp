#pragma once
/// Vectors of many megabytes.

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "routebench/geometry/parallel.hpp"

namespace routebench {

/// Leaves elements that need no construction as they are: what is written next need not be cleared
/// first.
template <typename T>
struct LargeAllocator : std::allocator<T> {
  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>&) noexcept {}
  template <typename U>
  struct rebind {
    using other = LargeAllocator<U>;
  };

  template <typename U>
  void construct(U*) noexcept {
    static_assert(std::is_trivially_copyable_v<U> && std::is_trivially_destructible_v<U>);
  }
  template <typename U, typename... Args>
  void construct(U* element, Args&&... args) {
    std::construct_at(element, std::forward<Args>(args)...);
  }
};

/// A vector for many plain elements: resize() leaves new ones without a value.
template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

/// Makes an empty vector that long, in pages that are got by all threads.
template <typename T>
void resize_large(std::vector<T>& vector, std::size_t size, const ParallelFor& parallel_for) {
  constexpr std::size_t kPageBytes = 4096, kBlockBytes = std::size_t{1} << 21U;
  vector.reserve(size);
  void* begin = vector.data();
  std::size_t bytes = size * sizeof(T);
  if (std::align(kPageBytes, kPageBytes, begin, bytes) != nullptr)
    parallel_for((bytes + kBlockBytes - 1) / kBlockBytes, [&](std::size_t block) {
      const std::size_t at = block * kBlockBytes;
      ::madvise(static_cast<std::byte*>(begin) + at, std::min(kBlockBytes, bytes - at),
                MADV_POPULATE_WRITE);
    });
  vector.resize(size);
}

}  // namespace routebench
