#pragma once
/// A planner that is a program of its own: it reads requests as lines and writes a line for each.

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include "routebench/geometry/error.hpp"

namespace routebench {

/// A planner's own process has ended when it should have answered.
class PlannerDied : public Error {
 public:
  explicit PlannerDied(const std::string& message) : Error(ErrorKind::kBadInput, message) {}
};

/// How a planner's process is started: words without a shell, in a folder.
struct PlannerCommand {
  std::vector<std::string> words;  ///< the program, looked up in PATH, and its arguments
  std::filesystem::path folder;    ///< where it runs; empty: here
};

/// One process, asked one thing at a time. Lives in the process that started it; in one forked from
/// that it must not be used, and its end there changes nothing.
///
/// It has no open file but its three streams, dies with the process that uses it, and keeps the
/// limits of that process.
class PlannerProcess {
 public:
  enum class Errors { kPassOn, kKeep };

  /// Takes  what becomes of its standard error beside its last words.
  /// Throws Error{kBadInput} if the program cannot be started.
  explicit PlannerProcess(const PlannerCommand& command, Errors errors = Errors::kPassOn);
  /// Closes its input and kills it if it does not end upon that.
  ~PlannerProcess();
  PlannerProcess(const PlannerProcess&) = delete;
  PlannerProcess& operator=(const PlannerProcess&) = delete;

  /// What it takes to answer, seen from outside: from before the request is written until the
  /// answer has been read.
  struct Answer {
    std::string line;  ///< without its end
    std::int64_t wall_ns = 0;
    std::int64_t cpu_ns = 0;  ///< of the process
  };

  /// Writes one line and waits for one line.
  ///
  /// Takes  the seconds after which silence is an error; 0: none.
  /// Throws PlannerDied if it ends or closes its output, saying how and what it last wrote;
  ///        Error{kStopped} when asked to stop; Error{kBadInput} if it is silent too long. After
  ///        any of these the process is of no more use.
  [[nodiscard]] Answer ask(const std::string& request, const std::stop_token& stop,
                           double silence_s = 0);

  /// How many lines it has written.
  [[nodiscard]] std::size_t lines() const noexcept { return lines_; }
  /// "; it last wrote: ..." for a message; empty if its standard error has said nothing.
  [[nodiscard]] std::string last_words();
  /// The most memory that it has had, as far as it still runs.
  [[nodiscard]] std::uint64_t peak_rss_bytes() const;

 private:
  void start(const PlannerCommand& command);
  void read_errors();
  [[noreturn]] void fail_dead();
  void finish(int patience_ms);

  Errors what_errors_;
  pid_t owner_ = -1;
  pid_t process_ = -1;
  int input_ = -1;
  int output_ = -1;
  int errors_ = -1;
  std::string received_;  ///< of its output, beyond the last answer
  std::string said_;      ///< end of what it wrote to its standard error
  std::size_t lines_ = 0;
};

}  // namespace routebench
