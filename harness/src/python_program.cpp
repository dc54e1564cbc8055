#include "python_program.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <memory>
#include <system_error>

#include "installed_files.hpp"
#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

/// While it lives, Ctrl-C stops the child alone, which then cleans up behind itself.
class IgnoreInterrupt {
 public:
  IgnoreInterrupt() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGINT, &ignore, &previous_);
  }
  ~IgnoreInterrupt() { sigaction(SIGINT, &previous_, nullptr); }
  IgnoreInterrupt(const IgnoreInterrupt&) = delete;
  IgnoreInterrupt& operator=(const IgnoreInterrupt&) = delete;

  /// Whether the child is to be interrupted, too.
  [[nodiscard]] bool was_ignored() const { return previous_.sa_handler == SIG_IGN; }

 private:
  struct sigaction previous_ {};
};

/// Runs a program without a shell and waits for it. Returns its exit code.
/// Throws  Error{kBadInput} if it cannot be started, Error{kInternal} if a signal ended it.
int run_program(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  const IgnoreInterrupt guard;
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  const std::unique_ptr<posix_spawnattr_t, int (*)(posix_spawnattr_t*)> cleanup(
      &attributes, posix_spawnattr_destroy);
  if (!guard.was_ignored()) {
    sigset_t restored;
    sigemptyset(&restored);
    sigaddset(&restored, SIGINT);
    posix_spawnattr_setsigdefault(&attributes, &restored);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  }

  pid_t child = 0;
  const int failure = posix_spawn(&child, argv[0], nullptr, &attributes, argv.data(), environ);
  if (failure != 0)
    throw Error(ErrorKind::kBadInput, "this needs " + arguments[0] + " with matplotlib: " +
                                          std::generic_category().message(failure) +
                                          "; install the package python3-matplotlib");
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR)
      throw Error(ErrorKind::kInternal,
                  "waiting for " + arguments[0] + ": " + std::generic_category().message(errno));
  if (WIFSIGNALED(status))
    throw Error(ErrorKind::kInternal,
                arguments[0] + " was ended by signal " + std::to_string(WTERMSIG(status)));
  return WEXITSTATUS(status);
}

}  // namespace

int run_python_package(const std::string& package, const std::vector<std::string>& arguments) {
  // Isolated from the user's own packages, leaving no compiled files behind.
  std::vector<std::string> words{
      kPython, "-I", "-B",
      data_folder(package, "experiments/" + package, "__main__.py") / "__main__.py"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return run_program(std::move(words));
}

void add_argument(std::vector<std::string>& arguments, const char* name, const std::string& value) {
  if (!value.empty()) arguments.push_back(std::string(name) + "=" + value);
}

}  // namespace routebench
