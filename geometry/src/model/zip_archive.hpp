#pragma once
/// The files inside a zip archive.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/raw_mesh.hpp"

namespace routebench::models {

/// A zip archive in memory, opened for reading.
class ZipArchive {
 public:
  /// Both must outlive the archive. Throws Error{kBadInput} if the bytes are no zip archive.
  ZipArchive(std::span<const char> bytes, const std::string& name);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  [[nodiscard]] std::vector<std::string> names() const;
  /// The content of a file, checked against its checksum; nothing if there is none of that name.
  /// Case does not count, as the packaging convention demands. Memory grows with what really comes
  /// out, up to 2 GB.
  /// Throws Error{kBadInput} for a damaged or encrypted file.
  [[nodiscard]] std::optional<std::string> read(const std::string& file) const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  const std::string& name_;
};

}  // namespace routebench::models
