#pragma once
/// A file's bytes without copying them.

#include <cstddef>
#include <filesystem>
#include <span>

namespace routebench::models {

/// A regular file mapped into memory for reading, as long as the object lives.
class MappedFile {
 public:
  /// Throws Error{kBadInput} for what is absent, unreadable or not a regular file.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const char> bytes() const noexcept {
    return {static_cast<const char*>(data_), size_};
  }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace routebench::models
