#pragma once
/// Single files out of compressed archives.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace routebench::models {

/// The content of one file in a tar archive that is compressed with gzip, without unpacking
/// anything to the disc; nothing if there is none of that name. Then `names`, if given, gets all.
/// Throws Error{kBadInput} if the archive cannot be read.
/// Cost   decompressing up to the file.
[[nodiscard]] std::optional<std::string> read_tar_gz_member(const std::filesystem::path& archive,
                                                            const std::string& member,
                                                            std::vector<std::string>* names);

}  // namespace routebench::models
