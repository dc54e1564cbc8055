#pragma once
/// What the readers have in common.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// A mesh as a file has it: exactly welded, every vertex used and finite, nothing mended or placed.
struct RawMesh {
  Mesh mesh;
  std::vector<std::string> warnings;  ///< one line each
  bool single_precision = false;      ///< coordinates carry 24 bits, as in STL
};

/// What a reader has to know besides the bytes.
struct ReadContext {
  std::string name;     ///< as messages call the model
  bool repair = false;  ///< go on where a sound reader would refuse
  ParallelFor parallel_for = serial_for;
};

/// Throws Error{kBadInput} "NAME: COMPLAINT", on one line whatever the name contains.
[[noreturn]] void refuse_model(const std::string& name, const std::string& complaint);

/// Triangles that can be told apart with 32-bit numbers for their corners.
inline constexpr std::size_t kMostTriangles = 0xFFFFFFFEU / 3;
inline constexpr std::size_t kMostVertices = 0xFFFFFFFEU;

/// Throws Error{kBadInput} if there are more than kMostTriangles.
void refuse_too_many_triangles(const std::string& name, std::size_t triangles);

/// A number for a message, with six digits at most.
[[nodiscard]] std::string rounded(double value);

/// A word of the input in quotes, cut where it gets long.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// "1 facet", "2 facets".
[[nodiscard]] std::string counted(std::size_t count, const char* noun);

}  // namespace routebench::models
