#include "kept_memory.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace routebench {
namespace {

constexpr int kMebibyte = 1 << 20;
/// By how much heaps grow at least, mostly.
constexpr int kGrowthBytes = 16 * kMebibyte;
/// What the program's heap gets at once if it is to be of large pages: of addresses, not of memory.
/// What grows later is of small ones.
constexpr int kLargeBytes = 1024 * kMebibyte;
/// All that the allocator lets the heap of a thread have, which begins at a multiple of it.
constexpr int kThreadBytes = 64 * kMebibyte;

std::atomic<bool> asks_for_large_pages = false;

/// Whether a new page takes so long.
bool small_page_takes(std::chrono::nanoseconds at_least) noexcept {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kPages = 4;
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  void* const memory =
      ::mmap(nullptr, kPages * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return false;
  Clock::duration least = Clock::duration::max();
  for (std::size_t i = 0; i < kPages; ++i) {
    const Clock::time_point begin = Clock::now();
    static_cast<volatile std::byte*>(memory)[i * page] = std::byte{1};
    least = std::min(least, Clock::now() - begin);  // some are interrupted
  }
  ::munmap(memory, kPages * page);
  return least >= at_least;
}

/// The last block that lies idle; each begins with the address of the one before.
std::atomic<void*> idle_blocks = nullptr;

/// A new block of the calling thread's heap that is never given back; its address, or 0.
std::uintptr_t take_idle_block(std::size_t bytes) noexcept {
  void** const block = static_cast<void**>(std::malloc(std::max(bytes, sizeof(void*))));
  if (block != nullptr) *block = idle_blocks.exchange(block);
  return reinterpret_cast<std::uintptr_t>(block);
}

/// Asks for large pages in the calling thread's heap, from where the next one begins up to where
/// `end_of(address in it)` says. Up to there blocks lie idle: a page that is partly there already
/// stays in pieces. False if the heap cannot grow.
template <typename EndOf>
bool ask_for_large_pages(const EndOf& end_of) noexcept {
  constexpr std::uintptr_t kLarge = 2 * kMebibyte;
  const std::uintptr_t block = take_idle_block(kLarge);
  if (block == 0) return false;
  const std::uintptr_t begin = (block + 2 * kLarge - 1) / kLarge * kLarge, end = end_of(block);
  if (begin < end)
    ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // no more than a hint
  take_idle_block(begin - block - kLarge);  // only now is anything written beyond it
  return true;
}

}  // namespace

void keep_freed_memory(std::chrono::nanoseconds dear_page) noexcept {
  ::mallopt(M_MMAP_THRESHOLD, 1024 * kMebibyte);
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  ::mallopt(M_TOP_PAD, kGrowthBytes);
  if (!small_page_takes(dear_page)) return;
  ::mallopt(M_TOP_PAD, kLargeBytes);
  asks_for_large_pages = ask_for_large_pages(
      [](std::uintptr_t) { return reinterpret_cast<std::uintptr_t>(::sbrk(0)); });
  ::mallopt(M_TOP_PAD, asks_for_large_pages ? kThreadBytes : kGrowthBytes);
}

void prepare_heap_of_thread() noexcept {
  if (!asks_for_large_pages) return;
  ask_for_large_pages(
      [](std::uintptr_t block) { return (block / kThreadBytes + 1) * kThreadBytes; });
}

}  // namespace routebench
