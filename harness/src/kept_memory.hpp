#pragma once
/// What becomes of memory that is given back.

#include <chrono>
#include <forward_list>
#include <utility>

namespace routebench {

/// Keeps freed memory in the process from now on. For commands that do one job and end: what one
/// step frees the next one wants, and having the system clear new pages takes as long as filling
/// them. Large pages are asked for only where a small one takes `dear_page` or more. Where a
/// hypervisor takes back what is free, a large page may have to be got from it first, which was
/// measured to take 4 ms, as long as 512 small ones of 8 us each; there those took 1.3 us. But they
/// took 12 us where a hypervisor keeps the page tables, and jobs 0.69 to 0.86 of their time with
/// large ones. Not where memory is measured or shared with children. Takes no longer than four new
/// pages do.
void keep_freed_memory(std::chrono::nanoseconds dear_page = std::chrono::microseconds(8)) noexcept;

/// Asks for large pages in the calling thread's heap, too, if keep_freed_memory() has asked for
/// them in the program's. For new threads, before they allocate anything.
void prepare_heap_of_thread() noexcept;

/// Takes what has done its work, be it memory or threads that sleep, and holds it until the process
/// ends, when the system has all of it back at once: to give it back piece by piece takes longer.
template <typename T>
void keep_until_exit(T value) {
  static std::forward_list<T>& kept = *new std::forward_list<T>;
  kept.push_front(std::move(value));
}

}  // namespace routebench
