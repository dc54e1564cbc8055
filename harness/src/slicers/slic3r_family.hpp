#pragma once
/// What Slic3r and PrusaSlicer, its descendant, call the same.

#include <filesystem>

#include "slicers/slicer_kind.hpp"

namespace routebench::slicers {

/// The settings that both have, by the same names and meanings.
[[nodiscard]] Settings slic3r_family_settings(const Task& task, const Printer& printer);

/// Writes settings as an .ini file. Throws Error{kBadInput} if it cannot be written.
void write_ini(const std::filesystem::path& file, const Settings& settings);

}  // namespace routebench::slicers
