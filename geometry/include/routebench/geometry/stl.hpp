#pragma once
/// Binary STL out: what every other tool for meshes reads.

#include <filesystem>
#include <string>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// The bytes of a binary STL file: coordinates rounded to single precision, normals computed from
/// the corners, a header that does not begin with "solid". Equal meshes give equal bytes.
///
/// Throws Error{kBadInput} for more triangles than the format can count.
/// Cost   84 + 50 bytes a triangle.
[[nodiscard]] std::string stl_bytes(const Mesh& mesh);

/// Writes stl_bytes() to a file.
/// Throws Error{kBadInput} naming the file if it cannot be written.
void write_stl(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace routebench
