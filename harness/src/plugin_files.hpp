#pragma once
/// Files that may be plugins: where they are looked for, and whether one can be loaded at all.

#include <filesystem>
#include <string>
#include <vector>

#include "routebench/planning/registry.hpp"

namespace routebench {

/// Folders that are searched for plugins, in this order: those of the environment variable
/// ROUTEBENCH_PLUGIN_PATH (separated by ':'), the user's own ($XDG_DATA_HOME/routebench/plugins, by
/// default below ~/.local/share), and that of the installation, beside the program.
[[nodiscard]] std::vector<std::filesystem::path> plugin_folders();

/// The *.so and *.py files of a folder by name; none if it cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> plugin_files_in(
    const std::filesystem::path& folder);

/// Loads a plugin in a process forked for that, which a plugin that exits, crashes or hangs while
/// it is loaded takes down alone.
///
/// Takes   the registry into which it is going to be loaded; must be called while this process has
/// no
///         other thread.
/// Returns what is wrong with it; empty if it can be loaded.
/// Cost    a fork, and loading once more than without.
[[nodiscard]] std::string trouble_of_plugin(const Registry& registry,
                                            const std::filesystem::path& file,
                                            double timeout_s = 10);

}  // namespace routebench
