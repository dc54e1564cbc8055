#pragma once
/// Mesh files by content.

#include <span>
#include <string_view>

#include "model/raw_mesh.hpp"

namespace routebench::models {

/// Reads any of the known formats: STL, OBJ, OFF, PLY, 3MF.
///
/// The content decides; the end of the name only where the content does not.
/// Throws Error{kBadInput} for what is none of them, empty or damaged.
[[nodiscard]] RawMesh read_mesh(std::span<const char> bytes, const ReadContext& context);

/// The readers. Polygons become triangles, vertices are welded exactly; normals, colours and
/// materials are passed over.
[[nodiscard]] RawMesh read_obj(std::span<const char> bytes, const ReadContext& context);
[[nodiscard]] RawMesh read_off(std::span<const char> bytes, const ReadContext& context);
[[nodiscard]] RawMesh read_ply(std::span<const char> bytes, const ReadContext& context);
/// All build items of the first model in the package, with components, transformations and unit;
/// supports and parts that are only marked as such are left out.
[[nodiscard]] RawMesh read_3mf(std::span<const char> bytes, const ReadContext& context);

/// Whether a word begins an OFF file: OFF, COFF, STCNOFF ...
[[nodiscard]] bool is_off_keyword(std::string_view word);

}  // namespace routebench::models
