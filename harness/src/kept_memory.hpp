#pragma once
/// What becomes of memory that is given back.

namespace routebench {

/// Keeps freed memory in the process from now on. For commands that do one job and end: what one
/// step frees the next one wants, and having the system clear new pages takes as long as filling
/// them; so it is asked for large pages too. Not where memory is measured or shared with children.
void keep_freed_memory() noexcept;

}  // namespace routebench
