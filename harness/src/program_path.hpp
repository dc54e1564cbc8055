#pragma once
/// Where programs are.

#include <filesystem>
#include <optional>
#include <string>

namespace routebench {

/// The file that a program's name stands for: a path if it contains a slash, else what the folders
/// of PATH hold. Nothing if there is no such program that may be executed.
[[nodiscard]] std::optional<std::filesystem::path> program_path(const std::string& name);

}  // namespace routebench
