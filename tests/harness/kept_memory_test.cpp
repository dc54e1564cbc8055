#include "kept_memory.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kHasOwnAllocator = true;
#else
constexpr bool kHasOwnAllocator = false;
#endif

namespace {

/// What the system tells of the memory at an address; nothing if there is none.
std::optional<std::string> flags_at(std::uintptr_t address) {
  std::ifstream maps("/proc/self/smaps");
  bool is_here = false;
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    if (words >> std::hex >> begin >> dash >> end && dash == '-')
      is_here = begin <= address && address < end;
    if (is_here && line.starts_with("VmFlags:")) return line;
  }
  return std::nullopt;
}

std::uintptr_t address_of(const void* at) { return reinterpret_cast<std::uintptr_t>(at); }

/// Whether it has been asked for large pages there.
bool is_for_large_pages(const void* at) {
  return flags_at(address_of(at)).value_or("").find(" hg") != std::string::npos;
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

/// Looks at this thread's heap and at that of a new one.
void expect_wish_for_large_pages(bool asked) {
  EXPECT_EQ(is_for_large_pages(new_block().get()), asked);
  std::thread([asked] {
    routebench::prepare_heap_of_thread();
    EXPECT_EQ(is_for_large_pages(new_block().get()), asked);
  }).join();
}

TEST(KeptMemory, IsThereForTheNext) {
  if (kHasOwnAllocator) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  if (!flags_at(address_of(&kBytes))) GTEST_SKIP() << "the system does not tell of memory";
  routebench::keep_freed_memory(std::chrono::hours(1));
  const std::uintptr_t freed = address_of(new_block().get());
  EXPECT_TRUE(flags_at(freed));
}

TEST(KeptMemory, AsksForNoLargePagesWhereSmallOnesAreCheap) {
  routebench::keep_freed_memory(std::chrono::hours(1));
  expect_wish_for_large_pages(false);
}

// The last one: what has been asked for stays.
TEST(KeptMemory, AsksForLargePagesWhereSmallOnesAreDear) {
  if (kHasOwnAllocator) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  if (!system_has_large_pages()) GTEST_SKIP() << "the system has no large pages";
  routebench::keep_freed_memory(std::chrono::nanoseconds(0));
  expect_wish_for_large_pages(true);
}

}  // namespace
