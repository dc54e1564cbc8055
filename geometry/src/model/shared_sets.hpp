#pragma once
/// Sets that several threads join at the same time.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace routebench::models {

/// Union-find without locks. What is in one set in the end does not depend on who joined first.
///
/// Source  R. Anderson and H. Woll, 1991: a root is put under another by one compare-and-swap; ways
///         to roots are halved in passing. Here the lower of two roots stays one.
class SharedSets {
 public:
  explicit SharedSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  void join(std::uint32_t a, std::uint32_t b) noexcept {
    for (;;) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t still_root = a;
      if (std::atomic_ref(parent_[a]).compare_exchange_strong(still_root, b, kOrder)) return;
    }
  }

  /// For each member another of its set that is lower; the lowest has itself. When all joins are
  /// done; the sets are empty afterwards.
  [[nodiscard]] std::vector<std::uint32_t> take_parents() { return std::exchange(parent_, {}); }

 private:
  /// Whatever a thread reads here was true at some time, and members never leave a set.
  static constexpr std::memory_order kOrder = std::memory_order_relaxed;

  [[nodiscard]] std::uint32_t root(std::uint32_t member) noexcept {
    for (;;) {
      const std::uint32_t parent = std::atomic_ref(parent_[member]).load(kOrder);
      if (parent == member) return member;
      const std::uint32_t next = std::atomic_ref(parent_[parent]).load(kOrder);
      if (next == parent) return parent;
      std::atomic_ref(parent_[member]).store(next, kOrder);
      member = next;
    }
  }

  std::vector<std::uint32_t> parent_;
};

}  // namespace routebench::models
