#include "model/cgal_data.hpp"

#include <array>
#include <filesystem>
#include <system_error>
#include <vector>

#include "model/raw_mesh.hpp"
#include "model/tar_member.hpp"
#include "routebench/geometry/nearest_name.hpp"

namespace routebench::models {
namespace {

/// Where Debian's packages have put the set; the folder's name differs between releases.
constexpr std::array<const char*, 2> kArchives{"/usr/share/doc/libcgal-dev/data.tar.gz",
                                               "/usr/share/doc/libcgal-demo/data.tar.gz"};

}  // namespace

std::string read_cgal_data(const std::string& name, const std::string& path) {
  for (const char* const archive : kArchives) {
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(archive, unknown)) continue;
    const std::string root = "data/";
    std::vector<std::string> names;
    if (auto bytes = read_tar_gz_member(archive, root + path, &names)) return *std::move(bytes);
    for (std::string& known : names) {
      if (known.starts_with(root)) known.erase(0, root.size());
    }
    const auto near = nearest_name(path, names);
    refuse_model(name, "CGAL's data set has no such file" +
                           (near ? ", did you mean " + in_quotes(*near) + "?" : std::string()));
  }
  refuse_model(name,
               "this machine lacks CGAL's data set (Debian package libcgal-demo; systems that "
               "drop /usr/share/doc lack it even then): use a shape: model or a file");
}

}  // namespace routebench::models
