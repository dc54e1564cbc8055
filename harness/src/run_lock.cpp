#include "run_lock.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int code) {
  throw Error(ErrorKind::kBadInput,
              file.string() + ": cannot be written: " + std::generic_category().message(code));
}

struct flock whole_file() {
  struct flock range {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  return range;
}

/// False if the file was removed or replaced since it was opened.
bool is_still_there(int descriptor, const std::filesystem::path& file) {
  struct stat held {};
  struct stat found {};
  return fstat(descriptor, &held) == 0 && stat(file.c_str(), &found) == 0 &&
         held.st_ino == found.st_ino && held.st_dev == found.st_dev;
}

}  // namespace

RunLock::RunLock(const std::filesystem::path& folder) : file_(folder / ".lock") {
  // A run that ends removes its file: whoever opened it just before then holds a lock on nothing
  // and has to try again.
  for (;;) {
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) fail(file_, errno);
    struct flock range = whole_file();
    if (fcntl(descriptor_, F_SETLK, &range) == 0) {
      if (is_still_there(descriptor_, file_)) return;
      close(descriptor_);
      continue;
    }
    const int code = errno;
    struct flock holder = whole_file();
    const bool known = fcntl(descriptor_, F_GETLK, &holder) == 0 && holder.l_type != F_UNLCK;
    close(descriptor_);
    if (code != EAGAIN && code != EACCES) fail(file_, code);
    throw Error(ErrorKind::kBadInput,
                folder.string() + ": another run is writing its results here" +
                    (known ? " (process " + std::to_string(holder.l_pid) + ")" : "") +
                    "; wait for it or give another folder with --out");
  }
}

RunLock::~RunLock() {
  unlink(file_.c_str());
  close(descriptor_);
}

}  // namespace routebench
