#include "routebench/harness/output.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ostream>
#include <streambuf>
#include <string>
#include <system_error>
#include <utility>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace fs = std::filesystem;
namespace {

/// Of larger pieces the system keeps copies in larger pieces of its memory, which take it longer to
/// find: on some virtual machines milliseconds.
constexpr std::size_t kBufferBytes = std::size_t{1} << 17;

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw Error(ErrorKind::kBadInput, file.string() + ": cannot be written: " + reason);
}

/// Collects bytes and hands them to an open file in large pieces; remembers the first failure.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(int descriptor) : descriptor_(descriptor), bytes_(kBufferBytes) {
    setp(bytes_.data(), bytes_.data() + bytes_.size());
  }

  /// errno of the first failed write, else 0.
  [[nodiscard]] int error() const noexcept { return error_; }

 protected:
  int_type overflow(int_type c) override {
    if (!flush()) return traits_type::eof();
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }

  int sync() override { return flush() ? 0 : -1; }

 private:
  bool flush() {
    for (const char* at = pbase(); at < pptr() && error_ == 0;) {
      const ssize_t written = ::write(descriptor_, at, static_cast<std::size_t>(pptr() - at));
      if (written >= 0) {
        at += written;
      } else if (errno != EINTR) {
        error_ = errno;
      }
    }
    setp(bytes_.data(), bytes_.data() + bytes_.size());
    return error_ == 0;
  }

  int descriptor_;
  std::vector<char> bytes_;
  int error_ = 0;
};

/// An open file descriptor that is closed whatever happens.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const noexcept { return number_; }
  /// Some file systems report a full disk only here. Returns errno, else 0.
  [[nodiscard]] int close() noexcept {
    return ::close(std::exchange(number_, -1)) == 0 ? 0 : errno;
  }

 private:
  int number_;
};

std::string reason_of(int error) { return std::generic_category().message(error); }

void write_through(int descriptor, const fs::path& name, const OutputSet::Write& write) {
  FileBuffer buffer(descriptor);
  std::ostream out(&buffer);
  write(out);
  out.flush();
  if (buffer.error() != 0) fail(name, reason_of(buffer.error()));
}

/// Writes the whole content to a path that is opened with the given flags.
void write_file(const fs::path& path, int flags, const fs::path& name,
                const OutputSet::Write& write) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666));
  if (file.number() < 0) fail(name, reason_of(errno));
  write_through(file.number(), name, write);
  if (const int error = file.close(); error != 0) fail(name, reason_of(error));
}

}  // namespace

OutputSet::~OutputSet() {
  std::error_code ignored;
  for (const Pending& pending : pending_) fs::remove(pending.temporary, ignored);
  // Only empty folders go: what somebody else has put there meanwhile stays.
  for (auto folder = new_folders_.rbegin(); folder != new_folders_.rend(); ++folder)
    fs::remove(*folder, ignored);
}

void OutputSet::make_folders(const fs::path& folder, const fs::path& output) {
  std::error_code error;
  std::vector<fs::path> missing;
  fs::path there = folder;
  for (; !there.empty() && !fs::exists(there, error); there = there.parent_path())
    missing.push_back(there);
  if (!there.empty() && !fs::is_directory(there, error))
    fail(output, (there == output ? "it" : there.string()) + " is not a folder");
  for (auto at = missing.rbegin(); at != missing.rend(); ++at) {
    if (fs::create_directory(*at, error)) new_folders_.push_back(*at);
    if (error)
      fail(output,
           *at == output ? error.message() : "folder " + at->string() + ": " + error.message());
  }
}

void OutputSet::add_folder(const fs::path& folder) { make_folders(folder, folder); }

void OutputSet::add(const fs::path& file, const Write& write) {
  if (file == "-")
    throw Error(ErrorKind::kBadUsage,
                "-: only --json writes to the standard output; give the name of a file");
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::is_directory(status)) fail(file, "it is a folder");
  const bool there = fs::exists(status);
  if (there && ::access(file.c_str(), W_OK) != 0) fail(file, reason_of(errno));
  if (there && !fs::is_regular_file(status)) {
    write_file(file, 0, file, write);
    return;
  }
  // A link keeps pointing where it does: what it names is replaced.
  fs::path target = fs::weakly_canonical(file, error);
  if (error) target = file;
  if (std::find(written_.begin(), written_.end(), target) != written_.end())
    throw Error(ErrorKind::kBadUsage,
                file.string() + ": named for two outputs; give each a file of its own");
  written_.push_back(target);
  make_folders(file.parent_path(), file);
  const fs::path temporary = target.parent_path() / ("." + target.filename().string() + "." +
                                                     std::to_string(::getpid()) + ".part");
  pending_.push_back({temporary, target});
  write_file(temporary, O_CREAT | O_TRUNC, file, write);
}

void OutputSet::commit() {
  while (!pending_.empty()) {
    std::error_code error;
    fs::rename(pending_.back().temporary, pending_.back().file, error);
    if (error) fail(pending_.back().file, error.message());
    pending_.pop_back();
  }
  new_folders_.clear();
}

void write_to_stdout(const OutputSet::Write& write) {
  write_through(STDOUT_FILENO, "standard output", write);
}

}  // namespace routebench
