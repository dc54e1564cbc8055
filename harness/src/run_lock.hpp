#pragma once
/// One run at a time in a folder of results.

#include <filesystem>

namespace routebench {

/// Holds a folder for this process. Released when it is destroyed or the process ends, in whatever
/// way; a process that was forked from this one does not hold it.
class RunLock {
 public:
  /// Throws Error{kBadInput} naming the process that holds the folder, or if the folder cannot be
  /// written.
  explicit RunLock(const std::filesystem::path& folder);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace routebench
