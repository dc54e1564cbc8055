#pragma once
/// Vectors of many megabytes.

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "routebench/geometry/parallel.hpp"

namespace routebench {

inline constexpr std::size_t kHugePageBytes = std::size_t{1} << 21U;

/// Asks for huge pages for memory that has not been touched: a few faults instead of thousands, and
/// fewer misses of the processor's page tables. Nothing happens where the system has none. Returns
/// the pages.
inline std::span<std::byte> advise_huge_pages(void* memory, std::size_t bytes) noexcept {
  void* begin = memory;
  if (std::align(kHugePageBytes, kHugePageBytes, begin, bytes) == nullptr) return {};
  bytes -= bytes % kHugePageBytes;
  ::madvise(begin, bytes, MADV_HUGEPAGE);
  return {static_cast<std::byte*>(begin), bytes};
}

/// Gives memory in huge pages, if it is much, and leaves elements that need no construction as they
/// are: what is written next need not be cleared first.
template <typename T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>&) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kHugePageBytes) return std::allocator<T>().allocate(count);
    void* memory = ::operator new (bytes, std::align_val_t{kHugePageBytes});
    advise_huge_pages(memory, bytes);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    if (count * sizeof(T) < kHugePageBytes) return std::allocator<T>().deallocate(memory, count);
    ::operator delete (memory, std::align_val_t{kHugePageBytes});
  }
  template <typename U>
  void construct(U*) noexcept {
    static_assert(std::is_trivially_copyable_v<U> && std::is_trivially_destructible_v<U>);
  }
  template <typename U, typename... Args>
  void construct(U* element, Args&&... args) {
    std::construct_at(element, std::forward<Args>(args)...);
  }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

/// A vector for many plain elements: resize() leaves new ones without a value.
template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

/// Makes an empty vector that long, in huge pages which are got by all threads.
template <typename T>
void resize_large(std::vector<T>& vector, std::size_t size, const ParallelFor& parallel_for) {
  vector.reserve(size);
  const std::span<std::byte> pages = advise_huge_pages(vector.data(), size * sizeof(T));
  parallel_for(pages.size() / kHugePageBytes, [&](std::size_t page) {
    ::madvise(pages.data() + page * kHugePageBytes, kHugePageBytes, MADV_POPULATE_WRITE);
  });
  vector.resize(size);
}

}  // namespace routebench
