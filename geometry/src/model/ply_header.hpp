#pragma once
/// What a PLY file says about itself.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "model/raw_mesh.hpp"

namespace routebench::models {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Bytes of a number in a binary file.
[[nodiscard]] std::size_t ply_bytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  ///< of the number, or of the numbers in the list
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;

  /// The place of a property among the others; their number if there is none of that name.
  [[nodiscard]] std::size_t find(std::string_view property) const;
};

struct PlyHeader {
  enum class Format { kText, kLittleEndian, kBigEndian };
  Format format = Format::kText;
  std::vector<PlyElement> elements;
  std::size_t body_offset = 0;  ///< where the data begin
  std::size_t body_line = 1;    ///< the number of that line
};

/// Throws Error{kBadInput} naming the line.
[[nodiscard]] PlyHeader read_ply_header(std::span<const char> bytes, const ReadContext& context);

}  // namespace routebench::models
