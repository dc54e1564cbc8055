#include "kept_memory.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kHasOwnAllocator = true;
#else
constexpr bool kHasOwnAllocator = false;
#endif

namespace {

/// Whether the system has been asked for large pages where an address lies.
bool is_for_large_pages(const void* at) {
  const auto address = reinterpret_cast<std::uintptr_t>(at);
  std::ifstream maps("/proc/self/smaps");
  bool is_here = false;
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    if (words >> std::hex >> begin >> dash >> end && dash == '-')
      is_here = begin <= address && address < end;
    if (is_here && line.starts_with("VmFlags:")) return line.find(" hg") != std::string::npos;
  }
  return false;
}

constexpr std::size_t kBytes = 3 << 20;

std::unique_ptr<char[]> new_block() {
  auto block = std::make_unique<char[]>(kBytes);
  std::memset(block.get(), 1, kBytes);
  return block;
}

/// Whether the system takes such a wish and tells of it.
bool system_has_large_pages() {
  void* const memory =
      ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  const bool has = ::madvise(memory, kBytes, MADV_HUGEPAGE) == 0 && is_for_large_pages(memory);
  ::munmap(memory, kBytes);
  return has;
}

TEST(KeptMemory, IsThereForTheNext) {
  if (kHasOwnAllocator) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  routebench::keep_freed_memory(std::chrono::hours(1));
  const void* const freed = new_block().get();
  EXPECT_EQ(new_block().get(), freed);
}

TEST(KeptMemory, AsksForNoneWhereSmallOnesAreCheap) {
  routebench::keep_freed_memory(std::chrono::hours(1));
  EXPECT_FALSE(is_for_large_pages(new_block().get()));
  std::thread([] {
    routebench::prepare_heap_of_thread();
    EXPECT_FALSE(is_for_large_pages(new_block().get()));
  }).join();
}

// The last one: what has been asked for stays.
TEST(KeptMemory, AsksForLargePagesWhereSmallOnesAreDear) {
  if (kHasOwnAllocator) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  if (!system_has_large_pages()) GTEST_SKIP() << "the system has no large pages";
  routebench::keep_freed_memory(std::chrono::nanoseconds(0));
  EXPECT_TRUE(is_for_large_pages(new_block().get()));
  std::thread([] {
    routebench::prepare_heap_of_thread();
    EXPECT_TRUE(is_for_large_pages(new_block().get()));
  }).join();
}

}  // namespace
