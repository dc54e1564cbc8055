#pragma once
/// Files and streams that commands write: whole or not at all.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <vector>

namespace routebench {

/// Files that appear together once all of them have been written. Until then they lie under hidden
/// temporary names beside their places. Folders that are missing on the way are made. What was not
/// committed is removed, such folders too.
class OutputSet {
 public:
  using Write = std::function<void(std::ostream&)>;

  OutputSet() = default;
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  ~OutputSet();

  /// Makes a folder, unless it is there already. Throws Error{kBadInput} naming the folder.
  void add_folder(const std::filesystem::path& folder);

  /// Writes a file under its temporary name. A device or a pipe is written at once.
  /// Takes  a function that writes the content; it may throw.
  /// Throws Error{kBadInput} naming the file if it cannot be written (no permission, full disk,
  ///        ...) and Error{kBadUsage} if it was added before.
  void add(const std::filesystem::path& file, const Write& write);

  /// Gives every file its name, replacing what had it. Throws Error{kBadInput} naming the file.
  void commit();

 private:
  /// Makes a folder with its parents; errors name the output that it is for.
  void make_folders(const std::filesystem::path& folder, const std::filesystem::path& output);

  struct Pending {
    std::filesystem::path temporary;
    std::filesystem::path file;
  };
  std::vector<Pending> pending_;
  std::vector<std::filesystem::path> written_;      ///< every file that was added, once resolved
  std::vector<std::filesystem::path> new_folders_;  ///< made here and not committed
};

/// Writes to the standard output through a large buffer.
/// Throws Error{kBadInput} if not all of it could be written.
void write_to_stdout(const OutputSet::Write& write);

}  // namespace routebench
