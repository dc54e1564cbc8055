#include "model/ply_header.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "model/text_lines.hpp"

namespace routebench::models {
namespace {

PlyType type_of(const TextLines& lines, std::string_view word) {
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes{{
      {"char", PlyType::kInt8},
      {"int8", PlyType::kInt8},
      {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},
      {"short", PlyType::kInt16},
      {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},
      {"uint16", PlyType::kUint16},
      {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},
      {"uint", PlyType::kUint32},
      {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},
      {"float32", PlyType::kFloat32},
      {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64},
  }};
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                         [&](const auto& known) { return known.first == word; });
  if (found == kTypes.end()) lines.refuse(in_quotes(word) + " is not a type of a PLY property");
  return found->second;
}

PlyHeader::Format format_of(const TextLines& lines, std::string_view word) {
  if (word == "ascii") return PlyHeader::Format::kText;
  if (word == "binary_little_endian") return PlyHeader::Format::kLittleEndian;
  if (word == "binary_big_endian") return PlyHeader::Format::kBigEndian;
  lines.refuse(in_quotes(word) +
               " is not a PLY format: ascii, binary_little_endian or binary_big_endian");
}

PlyElement read_element(TextLines& lines) {
  PlyElement element;
  element.name = lines.word();
  const std::int64_t count = lines.whole(lines.word());
  if (count < 0) lines.refuse("a count of " + std::to_string(count) + " cannot be meant");
  element.count = static_cast<std::size_t>(count);
  return element;
}

PlyProperty read_property(TextLines& lines) {
  PlyProperty property;
  std::string_view type = lines.word();
  if (type == "list") {
    property.is_list = true;
    property.count_type = type_of(lines, lines.word());
    if (property.count_type == PlyType::kFloat32 || property.count_type == PlyType::kFloat64) {
      lines.refuse("the length of a list must be a whole number");
    }
    type = lines.word();
  }
  property.type = type_of(lines, type);
  property.name = lines.word();
  return property;
}

}  // namespace

std::size_t ply_bytes(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      break;
  }
  return 8;
}

std::size_t PlyElement::find(std::string_view property) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const PlyProperty& p) { return p.name == property; });
  return static_cast<std::size_t>(found - properties.begin());
}

PlyHeader read_ply_header(std::span<const char> bytes, const ReadContext& context) {
  TextLines lines(bytes, context.name);
  PlyHeader header;
  bool has_format = false;
  while (lines.next_line()) {
    const std::string_view keyword = lines.word();
    if (keyword == "end_header") {
      if (!has_format) lines.refuse("the header names no format");
      header.body_offset = lines.rest_offset();
      header.body_line = lines.line() + 1;
      return header;
    }
    if (keyword == "format") {
      header.format = format_of(lines, lines.word());
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(read_element(lines));
    } else if (keyword == "property") {
      if (header.elements.empty()) lines.refuse("a property before any element");
      header.elements.back().properties.push_back(read_property(lines));
    } else if (keyword != "ply" && keyword != "comment" && keyword != "obj_info") {
      lines.refuse(in_quotes(keyword) + " does not belong into a PLY header");
    }
  }
  lines.refuse("the header has no end_header");
}

}  // namespace routebench::models
