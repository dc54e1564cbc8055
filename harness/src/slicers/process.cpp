#include "slicers/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLookMs = 5;
constexpr int kErrorDescriptor = 3;

std::string why(int error) { return std::generic_category().message(error); }

/// The environment of this process with some variables set, as "NAME=VALUE".
std::vector<std::string> environment_with(
    const std::vector<std::pair<std::string, std::string>>& changes) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    if (equals != text.npos)
      variables[std::string(text.substr(0, equals))] = text.substr(equals + 1);
  }
  for (const auto& [name, value] : changes) variables[name] = value;
  std::vector<std::string> list;
  for (const auto& [name, value] : variables) list.push_back(name + "=" + value);
  return list;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// What exec needs, made before the fork: after it nothing may be allocated.
struct Launch {
  const char* program;
  char* const* arguments;
  char* const* environment;
  const char* folder;
  const char* log;
  rlim_t memory_bytes;
};

/// In the child. Tells errno through the pipe if the program cannot be started.
[[noreturn]] void become(const Launch& launch, pid_t parent, int errors) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  for (int number = 1; number < NSIG; ++number) signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);

  const int safe_errors = fcntl(errors, F_DUPFD, 10);
  const int nothing = open("/dev/null", O_RDONLY);
  const int log = open(launch.log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  bool ready = nothing >= 0 && log >= 0;
  if (ready) {
    dup2(nothing, STDIN_FILENO);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    ready = chdir(launch.folder) == 0;
  }
  int error = errno;
  dup2(safe_errors, kErrorDescriptor);
  fcntl(kErrorDescriptor, F_SETFD, FD_CLOEXEC);
  close_range(kErrorDescriptor + 1, ~0U, 0);
  if (ready) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const rlimit memory{launch.memory_bytes, launch.memory_bytes};
    if (launch.memory_bytes != RLIM_INFINITY) setrlimit(RLIMIT_AS, &memory);
    execve(launch.program, launch.arguments, launch.environment);
    error = errno;
  }
  static_cast<void>(!write(kErrorDescriptor, &error, sizeof error));
  _exit(127);
}

double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double pages = 0;
  in >> pages >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// The highest resident memory of a process since it began its program; 0 if it has ended.
double high_water_bytes(pid_t process) {
  std::ifstream in("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  return 0;
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// Throws Error{kBadInput} if the child has told that it could not start the program. Waits until
/// it has done so or started.
void require_started(int errors, pid_t child, const ProcessCall& call) {
  int error = 0;
  ssize_t count = 0;
  while ((count = read(errors, &error, sizeof error)) < 0 && errno == EINTR) {
  }
  close(errors);
  if (count != sizeof error) return;
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  throw Error(ErrorKind::kBadInput, call.program.string() + ": cannot be started: " + why(error));
}

}  // namespace

ProcessEnd run_process(const ProcessCall& call) {
  std::vector<std::string> words{call.program.string()};
  words.insert(words.end(), call.arguments.begin(), call.arguments.end());
  std::vector<std::string> environment = environment_with(call.environment);
  const std::vector<char*> argv = pointers_to(words);
  const std::vector<char*> envp = pointers_to(environment);
  const Launch launch{call.program.c_str(),
                      argv.data(),
                      envp.data(),
                      call.folder.c_str(),
                      call.log.c_str(),
                      call.memory_mb ? static_cast<rlim_t>(*call.memory_mb) << 20 : RLIM_INFINITY};
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw Error(ErrorKind::kInternal, "no pipe for a process: " + why(errno));
  const double inherited_bytes = resident_bytes();
  const pid_t parent = getpid();
  const Clock::time_point began = Clock::now();
  const pid_t child = fork();
  if (child == 0) become(launch, parent, ends[1]);
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    throw Error(ErrorKind::kInternal,
                "no process for " + call.program.string() + ": " + why(errno));
  }
  require_started(ends[0], child, call);

  ProcessEnd end;
  double seen_bytes = 0;
  int status = 0;
  rusage usage{};
  for (;;) {
    const pid_t ended = wait4(child, &status, WNOHANG, &usage);
    if (ended == child || (ended < 0 && errno != EINTR)) break;
    seen_bytes = std::max(seen_bytes, high_water_bytes(child));
    if (call.timeout_s && seconds_since(began) > *call.timeout_s) kill(child, SIGKILL);
    poll(nullptr, 0, kLookMs);
  }
  end.wall_s = seconds_since(began);
  end.cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  const double counted_bytes = 1024 * static_cast<double>(usage.ru_maxrss);
  end.peak_rss_bytes = counted_bytes > 1.01 * inherited_bytes ? counted_bytes : seen_bytes;
  if (WIFSIGNALED(status))
    end.signal = WTERMSIG(status);
  else
    end.exit_code = WEXITSTATUS(status);
  return end;
}

}  // namespace routebench
