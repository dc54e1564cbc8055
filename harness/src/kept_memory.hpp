#pragma once
/// What becomes of memory that is given back.

#include <forward_list>
#include <utility>

namespace routebench {

/// Keeps freed memory in the process from now on. For commands that do one job and end: what one
/// step frees the next one wants, and having the system clear new pages takes as long as filling
/// them. It is not asked for large pages: where a hypervisor takes back what is free, such a page
/// may have to be got from it first, which was measured to take 4 ms, and small ones are got from
/// what others have just left. Not where memory is measured or shared with children.
void keep_freed_memory() noexcept;

/// Takes what has done its work and holds it until the process ends, when the system has all memory
/// back at once: to give it back piece by piece takes longer.
template <typename T>
void keep_until_exit(T value) {
  static std::forward_list<T>& kept = *new std::forward_list<T>;
  kept.push_front(std::move(value));
}

}  // namespace routebench
