#include "kept_memory.hpp"

#include <malloc.h>
#include <sys/mman.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace routebench {
namespace {

constexpr int kMebibyte = 1 << 20;

std::atomic<bool> memory_is_kept{false};

/// Has the system give memory in large pages, of which far fewer have to be asked for, to a part of
/// the thread's heap that is yet to be used. Takes address space only.
void prefer_large_pages(std::size_t bytes) noexcept {
  constexpr std::uintptr_t kPageBytes = 2 * kMebibyte;
  void* const volatile reserved = std::malloc(bytes);
  if (reserved == nullptr) return;
  const auto begin = reinterpret_cast<std::uintptr_t>(reserved);
  const std::uintptr_t first = (begin + kPageBytes - 1) / kPageBytes * kPageBytes;
  // Where the system has no such pages, nothing changes.
  ::madvise(reinterpret_cast<void*>(first), begin + bytes - first, MADV_HUGEPAGE);
  std::free(reserved);
}

}  // namespace

void keep_freed_memory() noexcept {
  ::mallopt(M_MMAP_THRESHOLD, 1024 * kMebibyte);
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  ::mallopt(M_TOP_PAD, 16 * kMebibyte);
  prefer_large_pages(std::size_t{256} * kMebibyte);
  memory_is_kept = true;
}

void keep_freed_memory_of_thread() noexcept {
  // Heaps of threads end at 64 MiB, where others begin.
  if (memory_is_kept) prefer_large_pages(std::size_t{32} * kMebibyte);
}

}  // namespace routebench
