#pragma once
/// Work in child processes: whatever it does, it costs nothing but itself.

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace routebench {

/// What a child is allowed.
struct ChildLimits {
  double timeout_s = 120;
  int memory_mb = 4096;  ///< of address space, above what it has from its parent
};

/// Where a child is; it writes, its parent reads when it has died.
struct ChildProgress {
  enum Phase : int { kPlanning, kJudging, kSlicing, kCutting };
  std::atomic<int> phase{kPlanning};
  std::atomic<std::int64_t> layer{-1};  ///< the last one begun; -1: none
};

/// How a child ended.
struct ChildEnd {
  enum class How {
    kResult,       ///< `text` is what the work returned
    kException,    ///< `text` is what it threw said
    kPlannerDied,  ///< `text` says how the planner's own process ended (see PlannerDied)
    kExited,       ///< it ended its process with `code` before the work was done
    kSignal,       ///< it died of the signal `code`
    kTimedOut,     ///< it was killed because its time was over
    kOutOfMemory,  ///< it could not get the memory that it asked for
  };
  How how = How::kResult;
  std::string text;
  int code = 0;
  std::string last_words;  ///< end of what it wrote to its standard output and error
  double wall_s = 0;
  int phase = ChildProgress::kPlanning;
  std::int64_t layer = -1;
};

/// Runs pieces of work, each in a process forked from this one. Must be used while this process has
/// no other thread.
///
/// A child has its standard input and output taken away, no open file of its parent, no core file,
/// a process group of its own, and dies with its parent. What it started is killed with it.
class ChildPool {
 public:
  using Work = std::function<std::string(ChildProgress&)>;
  using Clock = std::chrono::steady_clock;

  explicit ChildPool(ChildLimits limits);
  /// Kills what still runs.
  ~ChildPool();
  ChildPool(const ChildPool&) = delete;
  ChildPool& operator=(const ChildPool&) = delete;

  /// Begins a piece of work. Throws Error{kInternal} if no process can be made.
  void start(std::size_t id, const Work& work);

  struct Finished {
    std::size_t id;
    ChildEnd end;
  };
  /// Waits for children to end, up to a tenth of a second. Those that ended, if any.
  [[nodiscard]] std::vector<Finished> wait();

  [[nodiscard]] std::size_t running() const noexcept { return children_.size(); }

 private:
  struct Child;
  [[nodiscard]] bool has_ended(const Child& child) const;
  [[nodiscard]] bool died_for_memory(const Child& child, const rusage& usage, int signal) const;
  [[nodiscard]] ChildEnd bury(Child& child) const;

  ChildLimits limits_;
  std::vector<std::unique_ptr<Child>> children_;
};

/// The last line that a process wrote, for a message: "; it last wrote: ..."; empty if none.
[[nodiscard]] std::string last_line_of(const std::string& words);

/// "SIGSEGV" for SIGSEGV; "signal 70" for one without a name.
[[nodiscard]] std::string signal_name(int signal);

}  // namespace routebench
