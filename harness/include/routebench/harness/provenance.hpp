#pragma once
/// Where results come from: program, libraries, machine.

#include <cstdint>
#include <optional>
#include <string>

namespace routebench {

struct Provenance {
  std::string routebench_version;
  std::optional<std::string> git_commit;  ///< of the source tree when the program was built
  std::optional<bool> git_dirty;          ///< tracked files differed from that commit
  std::string program_build_id;           ///< tells builds apart; empty if the linker left none
  std::string compiler;
  std::string compiler_flags;
  std::string libraries_json;  ///< {"SQLite": "3.40.1", ...}
  std::string cpu;             ///< model name
  int cores = 0;               ///< that this process may use
  std::int64_t memory_bytes = 0;
  std::string os;  ///< distribution and kernel
};

/// What is known about this program on this machine.
[[nodiscard]] Provenance collect_provenance();

/// How this process was called, quoted for a shell.
[[nodiscard]] std::string command_line();

/// Now, as 2025-01-31T12:00:00Z.
[[nodiscard]] std::string utc_now();

}  // namespace routebench
