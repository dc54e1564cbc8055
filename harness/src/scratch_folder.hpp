#pragma once
/// A folder for the time that something takes.

#include <filesystem>

namespace routebench {

/// A new folder that is removed with all that is in it when the object goes.
class ScratchFolder {
 public:
  /// Makes it in `parent`. Throws Error{kBadInput} if it cannot.
  explicit ScratchFolder(const std::filesystem::path& parent);
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace routebench
