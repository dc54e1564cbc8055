#pragma once
/// The loop that runs geometry and judging on several cores.

#include "routebench/geometry/parallel.hpp"

namespace routebench {

/// A loop over `jobs` threads (1: the plain loop; 0: one a core). Threads live only during a call
/// and sleep, never spin, while they wait; so a process may fork between calls. Items are handed
/// out one by one from a shared counter.
[[nodiscard]] ParallelFor parallel_loop(int jobs);

}  // namespace routebench
