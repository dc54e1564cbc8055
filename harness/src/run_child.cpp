#include "run_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>

#include "byte_stream.hpp"
#include "planner_process.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

constexpr int kPollMs = 100;
/// A child that ends is noticed by its closed pipe at once, unless something that it started holds
/// the pipe open: then after this time.
constexpr int kCheckMs = 10;
constexpr std::size_t kLastWordsBytes = 2000;
/// More than any honest result: a planner that writes into our pipe must not fill our memory.
constexpr std::size_t kMostResultBytes = std::size_t{1} << 31;
constexpr std::string_view kResultMark = "routebench result";
constexpr int kResultDescriptor = 3;
/// Dying within this share of the memory limit is put down to it.
constexpr double kAtMemoryLimit = 0.9;

#if defined(__SANITIZE_ADDRESS__)
// The sanitizer reserves address space for itself and ends the process where it gets none.
constexpr bool kCanLimitMemory = false;
#else
constexpr bool kCanLimitMemory = true;
#endif

[[noreturn]] void fail(const char* what) {
  throw Error(ErrorKind::kInternal,
              std::string(what) + ": " + std::generic_category().message(errno));
}

struct Pipe {
  int read_end = -1;
  int write_end = -1;
};

Pipe make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail("no pipe for a child process");
  return {ends[0], ends[1]};
}

struct MemoryUse {
  std::uint64_t address_space_bytes = 0;
  std::uint64_t resident_bytes = 0;
};

MemoryUse own_memory() {
  std::ifstream in("/proc/self/statm");
  MemoryUse pages;
  in >> pages.address_space_bytes >> pages.resident_bytes;
  const auto page_bytes = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return {pages.address_space_bytes * page_bytes, pages.resident_bytes * page_bytes};
}

std::uint64_t bytes_of_mb(int mb) { return static_cast<std::uint64_t>(mb) << 20; }

/// Sets the soft limit: what we lower ourselves we can lift again.
void limit(__rlimit_resource resource, std::uint64_t value) {
  rlimit both{};
  getrlimit(resource, &both);
  both.rlim_cur = std::min<rlim_t>(value, both.rlim_max);
  setrlimit(resource, &both);
}

/// In the child: what it must not have or do.
void isolate(pid_t parent, int result, int output, const ChildLimits& limits) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it died before this took effect

  sigset_t none;
  sigemptyset(&none);
  for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);
  signal(SIGPIPE, SIG_IGN);
  sigprocmask(SIG_SETMASK, &none, nullptr);

  // The pipes may have the numbers that they are to be moved to, so they go out of the way first.
  const int safe_result = fcntl(result, F_DUPFD, 10);
  const int safe_output = fcntl(output, F_DUPFD, 10);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(safe_output, STDOUT_FILENO);
  dup2(safe_output, STDERR_FILENO);
  dup2(safe_result, kResultDescriptor);
  close_range(kResultDescriptor + 1, ~0U, 0);

  limit(RLIMIT_CORE, 0);
  if (kCanLimitMemory)
    limit(RLIMIT_AS, own_memory().address_space_bytes + bytes_of_mb(limits.memory_mb));
}

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return;  // the parent will miss the rest
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// In the child: tells its parent, without another copy of the text.
void tell(ChildEnd::How how, std::string_view text) {
  ByteWriter head;
  head.add(kResultMark).add(static_cast<std::uint64_t>(how)).add(std::uint64_t{text.size()});
  ByteWriter tail;
  tail.add(kResultMark);
  for (const std::string_view part :
       {std::string_view(head.bytes()), text, std::string_view(tail.bytes())})
    write_all(kResultDescriptor, part);
}

/// In the child: does the work and tells of it. Never returns.
[[noreturn]] void work_and_exit(const ChildPool::Work& work, ChildProgress& progress) {
  // What is told is our business, not a part of what the work may take.
  const auto lift_limit = [] { limit(RLIMIT_AS, RLIM_INFINITY); };
  try {
    const std::string result = work(progress);
    lift_limit();
    tell(ChildEnd::How::kResult, result);
  } catch (const std::bad_alloc&) {
    lift_limit();
    tell(ChildEnd::How::kOutOfMemory, "");
  } catch (const PlannerDied& death) {
    lift_limit();
    tell(ChildEnd::How::kPlannerDied, death.what());
  } catch (const std::exception& error) {
    lift_limit();
    tell(ChildEnd::How::kException, error.what());
  } catch (...) {
    lift_limit();
    tell(ChildEnd::How::kException, "something was thrown that is no std::exception");
  }
  _exit(0);
}

/// What a child told, if all of it arrived.
std::optional<ChildEnd> told_by(std::string_view bytes) {
  try {
    ByteReader in(bytes);
    if (in.text() != kResultMark) return std::nullopt;
    const std::uint64_t how = in.whole();
    ChildEnd end;
    end.text = in.text();
    if (in.text() != kResultMark) return std::nullopt;
    for (const ChildEnd::How told : {ChildEnd::How::kResult, ChildEnd::How::kException,
                                     ChildEnd::How::kPlannerDied, ChildEnd::How::kOutOfMemory})
      if (how == static_cast<std::uint64_t>(told)) {
        end.how = told;
        return end;
      }
    return std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// The kernel's count of processes that it killed for want of memory.
std::uint64_t kernel_memory_kills() {
  std::ifstream in("/proc/vmstat");
  std::string key;
  for (std::uint64_t value = 0; in >> key >> value;)
    if (key == "oom_kill") return value;
  return 0;
}

void keep_tail(std::string& text, std::size_t bytes) {
  if (text.size() > 2 * bytes) text.erase(0, text.size() - bytes);
}

}  // namespace

struct ChildPool::Child {
  std::size_t id = 0;
  pid_t process = -1;
  int result = -1;
  int output = -1;
  ChildProgress* progress = nullptr;
  Clock::time_point began;
  bool timed_out = false;
  std::uint64_t inherited_bytes = 0;  ///< resident memory of the parent
  std::uint64_t kernel_kills_before = 0;
  std::string received;
  std::string said;

  Child() {
    void* page = mmap(nullptr, sizeof(ChildProgress), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page == MAP_FAILED) fail("no shared page for a child process");
    progress = new (page) ChildProgress;
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process > 0) {
      kill(-process, SIGKILL);
      while (waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
    if (result >= 0) close(result);
    if (output >= 0) close(output);
    munmap(progress, sizeof(ChildProgress));
  }

  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - began).count();
  }

  /// Takes what lies in a pipe without waiting for more; closes it at its end.
  static void drain(int& pipe, std::string& into) {
    std::array<char, 1 << 16> buffer;
    while (pipe >= 0) {
      const ssize_t count = read(pipe, buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return;
      if (count == 0) {
        close(pipe);
        pipe = -1;
        return;
      }
      into.append(buffer.data(), static_cast<std::size_t>(count));
      if (into.size() > kMostResultBytes) into.clear();
      if (count < static_cast<ssize_t>(buffer.size())) return;
    }
  }

  void listen() {
    drain(result, received);
    drain(output, said);
    keep_tail(said, kLastWordsBytes);
  }
};

ChildPool::ChildPool(ChildLimits limits) : limits_(limits) {}

ChildPool::~ChildPool() = default;

void ChildPool::start(std::size_t id, const Work& work) {
  auto child = std::make_unique<Child>();
  child->id = id;
  const Pipe result = make_pipe();
  child->result = result.read_end;
  const Pipe output = make_pipe();
  child->output = output.read_end;
  fcntl(child->result, F_SETFL, O_NONBLOCK);
  fcntl(child->output, F_SETFL, O_NONBLOCK);
  child->kernel_kills_before = kernel_memory_kills();
  child->inherited_bytes = own_memory().resident_bytes;
  const pid_t parent = getpid();
  child->began = Clock::now();
  const pid_t process = fork();
  if (process == 0) {
    isolate(parent, result.write_end, output.write_end, limits_);
    work_and_exit(work, *child->progress);
  }
  close(result.write_end);
  close(output.write_end);
  if (process < 0) fail("no child process");
  child->process = process;
  // Both sides do it, so that the group exists whoever comes first.
  setpgid(process, process);
  children_.push_back(std::move(child));
}

bool ChildPool::has_ended(const Child& child) const {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(child.process), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == child.process;
}

/// Whether a child that died of a signal did so for want of memory: an allocation failed where
/// nothing could be thrown, or a null pointer from malloc was used, or the kernel picked it.
bool ChildPool::died_for_memory(const Child& child, const rusage& usage, int signal) const {
  const double taken_bytes =
      static_cast<double>(usage.ru_maxrss) * 1024 - static_cast<double>(child.inherited_bytes);
  return child.said.find("std::bad_alloc") != std::string::npos ||
         taken_bytes > kAtMemoryLimit * static_cast<double>(bytes_of_mb(limits_.memory_mb)) ||
         (signal == SIGKILL && kernel_memory_kills() > child.kernel_kills_before);
}

ChildEnd ChildPool::bury(Child& child) const {
  const double wall_s = child.seconds();
  // What it started goes before it is reaped: until then its number, and so its group's, is taken.
  kill(-child.process, SIGKILL);
  int status = 0;
  rusage usage{};
  while (wait4(child.process, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  child.process = -1;
  child.listen();

  ChildEnd end;
  const std::optional<ChildEnd> told = told_by(child.received);
  if (child.timed_out) {
    end.how = ChildEnd::How::kTimedOut;
  } else if (WIFSIGNALED(status)) {
    end.code = WTERMSIG(status);
    const bool memory = died_for_memory(child, usage, end.code);
    end.how = memory ? ChildEnd::How::kOutOfMemory : ChildEnd::How::kSignal;
  } else if (told && WEXITSTATUS(status) == 0) {
    end = *told;
  } else {
    end.how = ChildEnd::How::kExited;
    end.code = WEXITSTATUS(status);
  }
  if (child.said.size() > kLastWordsBytes) child.said.erase(0, child.said.size() - kLastWordsBytes);
  end.last_words = std::move(child.said);
  end.wall_s = wall_s;
  end.phase = child.progress->phase;
  end.layer = child.progress->layer;
  return end;
}

std::vector<ChildPool::Finished> ChildPool::wait() {
  std::vector<Finished> finished;
  const Clock::time_point until = Clock::now() + std::chrono::milliseconds(kPollMs);
  while (finished.empty() && !children_.empty() && Clock::now() < until) {
    std::vector<pollfd> watched;
    for (const auto& child : children_)
      for (const int pipe : {child->result, child->output})
        if (pipe >= 0) watched.push_back({pipe, POLLIN, 0});
    poll(watched.data(), watched.size(), kCheckMs);
    for (auto& child : children_) {
      child->listen();
      if (has_ended(*child)) {
        finished.push_back({child->id, bury(*child)});
        child.reset();
      } else if (!child->timed_out && child->seconds() > limits_.timeout_s) {
        child->timed_out = true;
        kill(-child->process, SIGKILL);
      }
    }
    std::erase(children_, nullptr);
  }
  return finished;
}

std::string last_line_of(const std::string& words) {
  const std::size_t end = words.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return {};
  const std::size_t begin = words.find_last_of("\r\n", end);
  std::string line = words.substr(begin == std::string::npos ? 0 : begin + 1,
                                  begin == std::string::npos ? end + 1 : end - begin);
  constexpr std::size_t kMostBytes = 300;
  if (line.size() > kMostBytes) line.resize(kMostBytes);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return "; it last wrote: " + line;
}

std::string signal_name(int signal) {
  const char* name = sigabbrev_np(signal);
  return name == nullptr ? "signal " + std::to_string(signal) : std::string("SIG") + name;
}

}  // namespace routebench
