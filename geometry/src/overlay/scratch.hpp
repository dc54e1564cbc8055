#pragma once
/// Memory for what one call needs only until it returns.

#include <cstddef>
#include <memory_resource>

namespace routebench::overlay {

/// Hands out memory from a block that the thread keeps, so that an overlay of a few points asks the
/// system for nothing. What does not fit into the block is taken from the heap. A scratch gives all
/// back when it ends, and so may be made while another one of its thread is in use; that one must
/// take nothing before the later one has ended.
///
/// Memory given back last is handed out again; other memory only once the scratch ends.
class Scratch final : public std::pmr::memory_resource {
 public:
  Scratch();
  ~Scratch() override;
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  static constexpr std::size_t kBlockBytes = std::size_t{64} << 10U;  ///< of each thread

 private:
  struct Block;

  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* memory, std::size_t bytes, std::size_t alignment) override;
  [[nodiscard]] bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override {
    return this == &other;
  }

  Block& block_;
  std::size_t begin_;  // of what is left of the block
};

}  // namespace routebench::overlay
