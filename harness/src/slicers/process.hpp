#pragma once
/// Another program, run to its end and measured.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace routebench {

struct ProcessCall {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  /// Variables that are set besides those of this process.
  std::vector<std::pair<std::string, std::string>> environment;
  std::filesystem::path folder;     ///< in which it runs
  std::filesystem::path log;        ///< where its standard output and error go
  std::optional<int> memory_mb;     ///< of address space that each of its processes may take
  std::optional<double> timeout_s;  ///< after which it is killed
};

struct ProcessEnd {
  int exit_code = 0;  ///< of a process that ended by itself
  int signal = 0;     ///< that killed it; 0: none
  double wall_s = 0;
  double cpu_s = 0;           ///< user and system time of the program and all that it waited for
  double peak_rss_bytes = 0;  ///< of the largest process among them
};

/// Runs a program and waits for it. It has no standard input, no other open file of this process,
/// the signals' default actions, stays in this process's group and dies with it.
///
/// Peak memory is the kernel's count. That count begins with what this process holds at the moment
/// of the fork, so where it is no larger, the peak is the highest of the program's own that was
/// seen by looking every few milliseconds.
///
/// Throws Error{kInternal} if no process can be made, Error{kBadInput} if the program cannot be
///        started or its log not written.
[[nodiscard]] ProcessEnd run_process(const ProcessCall& call);

}  // namespace routebench
