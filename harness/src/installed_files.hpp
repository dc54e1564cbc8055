#pragma once
/// Files that belong to the program and are not compiled into it.

#include <filesystem>
#include <string>

namespace routebench {

/// The folder `name` of an installed program's data, or else its place in the source tree that this
/// program was built from.
///
/// Takes  that place, relative to the tree's root, and a file in the folder that tells it from any
///        other.
/// Throws Error{kBadInput} naming both places if it is at neither.
[[nodiscard]] std::filesystem::path data_folder(const std::string& name,
                                                const std::filesystem::path& place_in_source,
                                                const std::string& file);

/// The folder of an installed program in which plugins for all its users lie; it need not exist.
[[nodiscard]] std::filesystem::path installed_plugin_folder();
/// The folder of the Python package routebench, in which the host of Python planners lies.
/// Throws Error{kBadInput} if it is not there.
[[nodiscard]] std::filesystem::path python_package_folder();

}  // namespace routebench
