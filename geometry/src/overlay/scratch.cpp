#include "overlay/scratch.hpp"

#include <functional>
#include <memory>

#if __has_include(<sanitizer/asan_interface.h>)
#include <sanitizer/asan_interface.h>  // its macros do nothing in other builds
#else
#define ASAN_POISON_MEMORY_REGION(memory, bytes) ((void)(memory), (void)(bytes))
#define ASAN_UNPOISON_MEMORY_REGION(memory, bytes) ((void)(memory), (void)(bytes))
#endif

namespace routebench::overlay {
namespace {

constexpr std::size_t kStep = alignof(std::max_align_t);

constexpr std::size_t in_whole_steps(std::size_t bytes) {
  return (bytes + kStep - 1) / kStep * kStep;
}

}  // namespace

struct Scratch::Block {
  Block() { ASAN_POISON_MEMORY_REGION(bytes, kBlockBytes); }
  ~Block() { ASAN_UNPOISON_MEMORY_REGION(bytes, kBlockBytes); }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  [[nodiscard]] bool holds(const std::byte* memory) const {
    return std::greater_equal<>()(memory, bytes) && std::less<>()(memory, bytes + kBlockBytes);
  }

  static Block& of_this_thread() {
    // By a pointer: programs that load this library at run time have little room for threads' data.
    thread_local const std::unique_ptr<Block> block(new Block);
    return *block;
  }

  std::size_t used = 0;
  alignas(kStep) std::byte bytes[kBlockBytes];
};

Scratch::Scratch() : block_(Block::of_this_thread()), begin_(block_.used) {}

Scratch::~Scratch() {
  ASAN_POISON_MEMORY_REGION(block_.bytes + begin_, block_.used - begin_);
  block_.used = begin_;
}

void* Scratch::do_allocate(std::size_t bytes, std::size_t alignment) {
  if (alignment > kStep || bytes > kBlockBytes - block_.used)
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  std::byte* const memory = block_.bytes + block_.used;
  block_.used += in_whole_steps(bytes);
  ASAN_UNPOISON_MEMORY_REGION(memory, bytes);
  return memory;
}

void Scratch::do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) {
  auto* const first = static_cast<std::byte*>(memory);
  if (!block_.holds(first))
    return std::pmr::new_delete_resource()->deallocate(memory, bytes, alignment);
  ASAN_POISON_MEMORY_REGION(first, bytes);
  if (first + in_whole_steps(bytes) == block_.bytes + block_.used)
    block_.used -= in_whole_steps(bytes);
}

}  // namespace routebench::overlay
