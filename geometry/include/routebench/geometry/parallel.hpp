#pragma once
/// How geometry is run on several cores without owning a thread: the caller hands in a loop.

#include <cstddef>
#include <functional>

namespace routebench {

/// Calls body(i) once for every i in [0, count), in any order, possibly at the same time, and
/// returns when all calls are done. An exception of a body is rethrown. Results must not depend on
/// the order.
using ParallelFor =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// The plain loop.
inline void serial_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

}  // namespace routebench
