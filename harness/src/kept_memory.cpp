#include "kept_memory.hpp"

#include <malloc.h>

#include <limits>

namespace routebench {

void keep_freed_memory() noexcept {
  constexpr int kMebibyte = 1 << 20;
  ::mallopt(M_MMAP_THRESHOLD, 1024 * kMebibyte);
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  ::mallopt(M_TOP_PAD, 16 * kMebibyte);
}

}  // namespace routebench
