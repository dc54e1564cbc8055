#pragma once
/// How a foreign slicer is named.

#include <filesystem>
#include <string>
#include <vector>

namespace routebench {

/// Which slicer: a known one by its name, or any other by the command that calls it.
struct SlicerSpec {
  std::string name;              ///< one of slicer_names(); empty with a command
  std::string command;           ///< see check_slicer; empty with a name
  std::filesystem::path folder;  ///< where a relative path of the command's program begins
};

/// "prusa-slicer", "slic3r", "cura-engine".
[[nodiscard]] std::vector<std::string> slicer_names();

/// Checks a name or a command.
///
/// A command is split into words at blanks; a word may be put in single or double quotes, in which
/// blanks are kept. It is never given to a shell: `$`, `*`, `;`, `>` and backslashes mean
/// themselves. In each word, `{model}` stands for the STL file to be sliced and `{gcode}` for the
/// file to be written, both of which must occur; `{folder}` for a folder that is empty before and
/// removed afterwards; `{task.KEY}` and `{printer.KEY}` for values of those tables. `{{` and `}}`
/// are braces.
///
/// Throws Error{kBadInput} saying what is wrong and what would be right.
void check_slicer(const SlicerSpec& spec);

}  // namespace routebench
