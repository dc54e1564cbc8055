#include "kept_memory.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace routebench {
namespace {

constexpr int kMebibyte = 1 << 20;

/// Has the system give memory in large pages, of which far fewer have to be asked for, to a part of
/// the heap that is yet to be used. Takes address space only.
void prefer_large_pages() noexcept {
  constexpr std::size_t kReservedBytes = std::size_t{256} * kMebibyte;
  constexpr std::uintptr_t kPageBytes = 2 * kMebibyte;
  const auto end_of_heap = [] { return reinterpret_cast<std::uintptr_t>(::sbrk(0)); };
  const std::uintptr_t begin = (end_of_heap() + kPageBytes - 1) / kPageBytes * kPageBytes;
  void* volatile reserved = std::malloc(kReservedBytes);
  std::free(reserved);
  const std::uintptr_t end = end_of_heap();
  // Where the system has no such pages, nothing changes.
  if (end > begin) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace

void keep_freed_memory() noexcept {
  ::mallopt(M_MMAP_THRESHOLD, 1024 * kMebibyte);
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  ::mallopt(M_TOP_PAD, 16 * kMebibyte);
  prefer_large_pages();
}

}  // namespace routebench
