#pragma once
/// The meshes that come with CGAL's documentation.

#include <string>

namespace routebench::models {

/// The bytes of a file of CGAL's data set, for example "meshes/elephant.off".
///
/// Debian ships the set compressed in the package libcgal-demo.
/// Throws Error{kBadInput} if the machine does not have it (naming the package) or the set has no
///        such file (naming the nearest).
[[nodiscard]] std::string read_cgal_data(const std::string& name, const std::string& path);

}  // namespace routebench::models
