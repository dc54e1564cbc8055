#pragma once
/// Fingerprints for records: which plugin, which model, which layers.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace routebench {

/// SHA-256 of some bytes, as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// SHA-256 of a file's contents; nothing if it cannot be read. Cost   one pass, constant memory.
[[nodiscard]] std::optional<std::string> sha256_of_file(const std::filesystem::path& file);

}  // namespace routebench
