#include "installed_files.hpp"

#include <dlfcn.h>

#include <system_error>
#include <vector>

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

fs::path python_package_folder() {
  constexpr const char* kHost = "host.py";
  std::error_code error;
  std::vector<fs::path> places;
  // In the Python module this code lies in the package itself.
  Dl_info binary{};
  if (dladdr(reinterpret_cast<const void*>(&python_package_folder), &binary) != 0)
    places.push_back(fs::absolute(binary.dli_fname, error).parent_path());
  const fs::path bin = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {ROUTEBENCH_PYTHON_FROM_PROGRAM "/routebench", "../python/routebench"})
    places.push_back((bin / place).lexically_normal());
  for (const fs::path& place : places)
    if (fs::is_regular_file(place / kHost, error)) return place;
  throw Error(ErrorKind::kBadInput, "the Python package routebench is not at " +
                                        places.at(places.size() - 2).string() +
                                        "; install routebench again");
}

}  // namespace routebench
