#include "counted_memory.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

constexpr std::memory_order kOrder = std::memory_order_relaxed;

std::atomic<bool> counting = false;
std::atomic<std::int64_t> allocations = 0;
std::atomic<std::int64_t> allocated_bytes = 0;
std::atomic<std::int64_t> bytes = 0;
std::atomic<std::int64_t> most_bytes = 0;

/// Notes a block that has just been allocated.
void* noted(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  if (!counting.load(kOrder)) return block;
  const auto size = static_cast<std::int64_t>(::malloc_usable_size(block));
  allocations.fetch_add(1, kOrder);
  allocated_bytes.fetch_add(size, kOrder);
  const std::int64_t now = bytes.fetch_add(size, kOrder) + size;
  std::int64_t most = most_bytes.load(kOrder);
  while (most < now && !most_bytes.compare_exchange_weak(most, now, kOrder)) {
  }
  return block;
}

void give_back(void* block) noexcept {
  if (counting.load(kOrder))
    bytes.fetch_sub(static_cast<std::int64_t>(::malloc_usable_size(block)), kOrder);
  std::free(block);
}

std::size_t rounded_up(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return (size + step - 1) / step * step;
}

}  // namespace

// These two stand behind all other forms of new and delete.
void* operator new(std::size_t size) { return noted(std::malloc(size == 0 ? 1 : size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return noted(
      std::aligned_alloc(static_cast<std::size_t>(alignment), rounded_up(size, alignment)));
}
void operator delete(void* block) noexcept { give_back(block); }
void operator delete(void* block, std::size_t) noexcept { give_back(block); }
void operator delete(void* block, std::align_val_t) noexcept { give_back(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { give_back(block); }

namespace routebench::bench {

void start_counting() {
  allocations = 0;
  allocated_bytes = 0;
  bytes = 0;
  most_bytes = 0;
  counting = true;
}

MemoryCount stop_counting() {
  counting = false;
  return {allocations, allocated_bytes, bytes, most_bytes};
}

}  // namespace routebench::bench
