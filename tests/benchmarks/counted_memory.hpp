#pragma once
/// What is allocated while something runs, in all threads and libraries of the program.

#include <cstdint>

namespace routebench::bench {

/// Of what was allocated since start_counting(), by `new`.
struct MemoryCount {
  std::int64_t allocations = 0;
  std::int64_t allocated_bytes = 0;  ///< in all
  std::int64_t bytes = 0;            ///< still held; less than 0 if older memory was given back
  std::int64_t most_bytes = 0;       ///< held at a time
};

void start_counting();
[[nodiscard]] MemoryCount stop_counting();

}  // namespace routebench::bench
