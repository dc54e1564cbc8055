#include "installed_files.hpp"

#include <system_error>

#include "routebench/geometry/error.hpp"

namespace routebench {

namespace fs = std::filesystem;

namespace {

/// A folder of the installation, by its way from the program's.
fs::path folder_from_program(const char* way) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return (program.parent_path() / way).lexically_normal();
}

}  // namespace

fs::path installed_plugin_folder() { return folder_from_program(ROUTEBENCH_PLUGINS_FROM_PROGRAM); }

fs::path data_folder(const std::string& name, const fs::path& place_in_source,
                     const std::string& file) {
  std::error_code error;
  const fs::path source = fs::path(ROUTEBENCH_SOURCE_FOLDER) / place_in_source;
  const fs::path installed = folder_from_program(ROUTEBENCH_DATA_FROM_PROGRAM) / name;
  for (const fs::path& place : {installed, source})
    if (fs::is_regular_file(place / file, error)) return place;
  throw Error(ErrorKind::kBadInput, "the program's folder " + name + " is neither at " +
                                        installed.string() + " nor at " + source.string() +
                                        "; install routebench again");
}

}  // namespace routebench
