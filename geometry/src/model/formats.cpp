#include "model/formats.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "model/stl_reader.hpp"
#include "model/text_lines.hpp"

namespace routebench::models {
namespace {

/// The end of a file's name from its last dot on, in lower case.
std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

bool is_obj_keyword(std::string_view word) {
  constexpr std::array<std::string_view, 9> kKeywords{"v", "vn",     "vt",     "f", "o",
                                                      "g", "mtllib", "usemtl", "s"};
  return std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end();
}

}  // namespace

RawMesh read_mesh(std::span<const char> bytes, const ReadContext& context) {
  if (bytes.empty()) refuse_model(context.name, "empty file");
  if (is_exact_binary_stl(bytes)) return read_stl(bytes, context);
  const std::string_view text(bytes.data(), bytes.size());
  if (text.starts_with("PK\x03\x04")) return read_3mf(bytes, context);

  const std::string extension = extension_of(context.name);
  const std::string_view head = text.substr(0, 4096);
  TextLines lines({head.data(), head.size()}, context.name);
  const std::string_view word = lines.word_on_any_line();
  if (word == "ply") return read_ply(bytes, context);
  if (is_off_keyword(word) || extension == ".off") return read_off(bytes, context);
  if (extension == ".obj") return read_obj(bytes, context);
  if (extension == ".ply")
    refuse_model(context.name, "not a PLY file: must begin with the word ply");
  if (extension == ".3mf") refuse_model(context.name, "not a 3MF file: must be a zip archive");
  if (stl_kind(bytes) != StlKind::kNeither || extension == ".stl") return read_stl(bytes, context);
  if (is_obj_keyword(word)) return read_obj(bytes, context);
  if (extension == ".wkt")
    refuse_model(context.name,
                 "a file of layers is no mesh: there is nothing to scale, simplify or slice");
  refuse_model(context.name, "not a mesh: neither STL nor OBJ, OFF, PLY or 3MF");
}

}  // namespace routebench::models
