#include "planner_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "run_child.hpp"

namespace routebench {
namespace {

using Clock = std::chrono::steady_clock;

/// How soon a wish to stop is noticed.
constexpr int kPollMs = 20;
/// How long a process that was told to end may take before it is killed, and how long one that has
/// closed its output may take to end by itself, so that it can be told how it did.
constexpr int kPatienceMs = 500;
constexpr int kLastPatienceMs = 5000;
constexpr std::size_t kLastWordsBytes = 2000;
/// More than any honest route: what never ends a line must not fill our memory.
constexpr std::size_t kMostLineBytes = std::size_t{1} << 31;

std::string message_of(int error) { return std::generic_category().message(error); }

struct Pipe {
  int read_end = -1;
  int write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw Error(ErrorKind::kInternal, "no pipe for a planner's process: " + message_of(errno));
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    if (read_end >= 0) close(read_end);
    if (write_end >= 0) close(write_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  static int take(int& end) { return std::exchange(end, -1); }
};

/// While it lives, writing to a closed pipe fails in this thread instead of ending the process.
class BrokenPipeGuard {
 public:
  BrokenPipeGuard() {
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    sigemptyset(&broken_);
    sigaddset(&broken_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &broken_, &before_);
  }
  ~BrokenPipeGuard() {
    const std::timespec at_once{};
    if (!was_pending_)
      while (sigtimedwait(&broken_, nullptr, &at_once) < 0 && errno == EINTR) {
      }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  BrokenPipeGuard(const BrokenPipeGuard&) = delete;
  BrokenPipeGuard& operator=(const BrokenPipeGuard&) = delete;

 private:
  sigset_t broken_;
  sigset_t before_;
  bool was_pending_ = false;
};

/// In the child: becomes the program. Only calls that are allowed after a fork of many threads.
[[noreturn]] void become(char* const* argv, const char* folder, const std::array<int, 3>& streams,
                         int complaint, bool dies_with_thread) {
  if (dies_with_thread) prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  sigemptyset(&none);
  for (const int number : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_DFL);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  // The streams may have the numbers that they are to be moved to, so they go out of the way first.
  constexpr int kOutOfTheWay = 10;
  const int safe_complaint = fcntl(complaint, F_DUPFD_CLOEXEC, kOutOfTheWay);
  std::array<int, 3> safe{};
  for (std::size_t i = 0; i < 3; ++i) safe[i] = fcntl(streams[i], F_DUPFD_CLOEXEC, kOutOfTheWay);
  for (std::size_t i = 0; i < 3; ++i) dup2(safe[i], static_cast<int>(i));
  // Whatever else is open closes when the program begins.
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  if (*folder == '\0' || chdir(folder) == 0) execvp(argv[0], argv);
  const int error = errno;
  static_cast<void>(!write(safe_complaint, &error, sizeof error));
  _exit(127);
}

void set_nonblocking(int descriptor) { fcntl(descriptor, F_SETFL, O_NONBLOCK); }

enum class ReadResult { kSome, kNothingNow, kEnd };

/// Takes what lies in a pipe, up to one buffer.
ReadResult read_some(int descriptor, std::string& into) {
  std::array<char, 1 << 16> buffer;
  const ssize_t count = read(descriptor, buffer.data(), buffer.size());
  if (count > 0) into.append(buffer.data(), static_cast<std::size_t>(count));
  if (count > 0) return ReadResult::kSome;
  return count < 0 && (errno == EAGAIN || errno == EINTR) ? ReadResult::kNothingNow
                                                          : ReadResult::kEnd;
}

std::optional<int> ended(pid_t process, int patience_ms) {
  const Clock::time_point until = Clock::now() + std::chrono::milliseconds(patience_ms);
  for (;;) {
    int status = 0;
    const pid_t found = waitpid(process, &status, WNOHANG);
    if (found == process) return status;
    if (found < 0 && errno != EINTR) return 0;  // somebody else has reaped it
    if (Clock::now() >= until) return std::nullopt;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::string end_of_process(int status) {
  if (WIFSIGNALED(status)) return "died of " + signal_name(WTERMSIG(status));
  return "ended with exit code " + std::to_string(WEXITSTATUS(status));
}

/// Processor time of another process; 0 if it is gone.
std::int64_t cpu_ns_of(pid_t process) {
  clockid_t clock{};
  std::timespec used{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
  return std::int64_t{used.tv_sec} * 1'000'000'000 + used.tv_nsec;
}

}  // namespace

PlannerProcess::PlannerProcess(const PlannerCommand& command, Errors errors)
    : what_errors_(errors), owner_(getpid()) {
  start(command);
}

void PlannerProcess::start(const PlannerCommand& command) {
  Pipe input, output, errors, complaint;
  std::vector<char*> argv;
  std::vector<std::string> words = command.words;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string folder = command.folder.string();
  // The kernel means the thread that forks when it speaks of the parent; only the first one stays.
  const bool first_thread = gettid() == getpid();
  process_ = fork();
  if (process_ < 0)
    throw Error(ErrorKind::kInternal, "no process for a planner: " + message_of(errno));
  if (process_ == 0)
    become(argv.data(), folder.c_str(), {input.read_end, output.write_end, errors.write_end},
           complaint.write_end, first_thread);
  close(Pipe::take(complaint.write_end));
  int error = 0;
  ssize_t told = 0;
  while ((told = read(complaint.read_end, &error, sizeof error)) < 0 && errno == EINTR) {
  }
  if (told == sizeof error) {
    static_cast<void>(waitpid(process_, nullptr, 0));
    process_ = -1;
    throw Error(ErrorKind::kBadInput, "cannot be started: " + words[0] + ": " + message_of(error));
  }
  input_ = Pipe::take(input.write_end);
  output_ = Pipe::take(output.read_end);
  errors_ = Pipe::take(errors.read_end);
  for (const int stream : {input_, output_, errors_}) set_nonblocking(stream);
}

PlannerProcess::~PlannerProcess() {
  if (getpid() == owner_) finish(kPatienceMs);
}

void PlannerProcess::finish(int patience_ms) {
  if (input_ >= 0) close(std::exchange(input_, -1));
  if (process_ > 0) {
    if (!ended(process_, patience_ms)) {
      kill(process_, SIGKILL);
      while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
    process_ = -1;
  }
  read_errors();
  for (int* stream : {&output_, &errors_})
    if (*stream >= 0) close(std::exchange(*stream, -1));
}

void PlannerProcess::read_errors() {
  std::string fresh;
  while (errors_ >= 0) {
    const ReadResult result = read_some(errors_, fresh);
    if (result == ReadResult::kEnd) close(std::exchange(errors_, -1));
    if (result != ReadResult::kSome) break;
  }
  std::string_view left = what_errors_ == Errors::kPassOn ? fresh : std::string_view();
  while (!left.empty()) {
    const ssize_t written = write(STDERR_FILENO, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) break;
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  said_ += fresh;
  if (said_.size() > kLastWordsBytes) said_.erase(0, said_.size() - kLastWordsBytes);
}

std::string PlannerProcess::last_words() {
  read_errors();
  return last_line_of(said_);
}

void PlannerProcess::fail_dead() {
  const std::optional<int> status = ended(process_, kLastPatienceMs);
  if (status) process_ = -1;
  const char* const where =
      received_.empty() ? " before it answered" : " in the middle of a line of its output";
  const std::string how = status ? "its process " + end_of_process(*status) + where
                                 : std::string("its process closed its output") + where;
  const std::string words = last_words();
  finish(0);
  throw PlannerDied(how + words);
}

PlannerProcess::Answer PlannerProcess::ask(const std::string& request, const std::stop_token& stop,
                                           double silence_s) {
  const BrokenPipeGuard guard;
  said_.clear();
  const std::string line = request + "\n";
  std::string_view to_write = line;
  const std::int64_t cpu_begin = cpu_ns_of(process_);
  const Clock::time_point begin = Clock::now();
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = received_.find('\n', searched);
    if (end != std::string::npos) {
      Answer answer;
      answer.wall_ns =
          std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
      answer.cpu_ns = std::max<std::int64_t>(0, cpu_ns_of(process_) - cpu_begin);
      answer.line = received_.substr(0, end);
      received_.erase(0, end + 1);
      ++lines_;
      read_errors();
      return answer;
    }
    searched = received_.size();
    if (stop.stop_requested()) {
      finish(0);
      throw Error(ErrorKind::kStopped, "stopped as asked");
    }
    if (silence_s > 0 && Clock::now() - begin > std::chrono::duration<double>(silence_s)) {
      const std::string words = last_words();
      finish(0);
      throw Error(ErrorKind::kBadInput, "its process has not answered within " +
                                            std::to_string(static_cast<int>(silence_s)) + " s" +
                                            words);
    }
    std::array<pollfd, 3> watched{
        {{output_, POLLIN, 0}, {errors_, POLLIN, 0}, {to_write.empty() ? -1 : input_, POLLOUT, 0}}};
    poll(watched.data(), watched.size(), kPollMs);
    if (watched[1].revents != 0) read_errors();
    if (watched[2].revents != 0) {
      const ssize_t written = write(input_, to_write.data(), to_write.size());
      // One that has closed its input may yet have answered; if not, its output tells.
      if (written < 0 && errno == EPIPE) to_write = {};
      if (written > 0) to_write.remove_prefix(static_cast<std::size_t>(written));
    }
    if (watched[0].revents != 0 && read_some(output_, received_) == ReadResult::kEnd) fail_dead();
    if (received_.size() > kMostLineBytes) {
      finish(0);
      throw Error(ErrorKind::kBadInput, "its process wrote more than 2 GiB without ending a line");
    }
  }
}

std::uint64_t PlannerProcess::peak_rss_bytes() const {
  std::ifstream in("/proc/" + std::to_string(process_) + "/status");
  for (std::string key; in >> key;) {
    if (key != "VmHWM:") continue;
    std::uint64_t kib = 0;
    in >> kib;
    return kib * 1024;
  }
  return 0;
}

}  // namespace routebench
