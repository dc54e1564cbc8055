#pragma once
/// The loop that runs geometry and judging on several cores.

#include "routebench/geometry/parallel.hpp"

namespace routebench {

/// A loop over `jobs` threads (1: the plain loop; 0: one a core), or over as many as the system
/// grants. Threads begin with the first call and end with the last copy of the loop; they sleep,
/// never spin, while they wait. Between calls the process may fork: in the child, and within a call
/// of the same loop, the loop is a plain one. Items are handed out one by one from a shared
/// counter.
[[nodiscard]] ParallelFor parallel_loop(int jobs);

}  // namespace routebench
