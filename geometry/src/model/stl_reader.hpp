#pragma once
/// STL in, binary and ASCII told apart by content.

#include <span>

#include "model/raw_mesh.hpp"

namespace routebench::models {

/// What the bytes of a file that claims to be an STL are.
enum class StlKind { kBinary, kAscii, kNeither };

/// Whether the size is exactly 84 bytes and 50 for every facet that the count field announces.
[[nodiscard]] bool is_exact_binary_stl(std::span<const char> bytes);

/// Decides by that size first, since binary headers may read "solid"; then by the bytes
/// that text never has.
[[nodiscard]] StlKind stl_kind(std::span<const char> bytes);

/// Reads either kind.
///
/// Stored normals and attributes are not looked at: the order of the corners says what is outside.
/// Throws Error{kBadInput} for what is neither kind, empty, cut short or has corners that are not
/// finite; with repair
///        the last two lose the facets concerned and a warning says how many.
/// Cost   linear in the bytes; memory by the facets that are really there.
[[nodiscard]] RawMesh read_stl(std::span<const char> bytes, const ReadContext& context);

/// The two halves of read_stl(); `bytes` must be of that kind.
[[nodiscard]] RawMesh read_binary_stl(std::span<const char> bytes, const ReadContext& context);
[[nodiscard]] RawMesh read_ascii_stl(std::span<const char> bytes, const ReadContext& context);

}  // namespace routebench::models
