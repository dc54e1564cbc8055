#include "model/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "model/raw_mesh.hpp"

namespace routebench::models {
namespace {

/// Closes a file descriptor at the end of a scope.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const noexcept { return fd_; }

 private:
  int fd_;
};

std::string last_system_error() { return std::generic_category().message(errno); }

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  // Not blocking: a named pipe without a writer must not hang the program before it is refused.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) refuse_model(path.string(), "cannot be opened: " + last_system_error());
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) {
    refuse_model(path.string(), "cannot be read: " + last_system_error());
  }
  if (S_ISDIR(status.st_mode)) refuse_model(path.string(), "is a folder, not a model file");
  if (!S_ISREG(status.st_mode)) refuse_model(path.string(), "is not a regular file");
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) return;  // an empty range cannot be mapped
  // Not all pages at once: each thread gets those that it reads.
  void* mapped = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.get(), 0);
  if (mapped == MAP_FAILED) {
    refuse_model(path.string(), "cannot be mapped into memory: " + last_system_error());
  }
  data_ = mapped;
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(data_, size_);
}

}  // namespace routebench::models
