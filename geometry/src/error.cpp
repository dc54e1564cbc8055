#include "routebench/geometry/error.hpp"

#include <cstddef>
#include <string_view>

namespace routebench {
namespace {

unsigned byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

/// Bytes of the character at the front of a text that is not empty; 0 if they are no UTF-8.
std::size_t character_bytes(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte_at(text, i) & 0xC0) != 0x80) return 0;
  const unsigned second = byte_at(text, 1);
  const bool too_long = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool no_character = (first == 0xED && second >= 0xA0) || (first == 0xF4 && second >= 0x90);
  return too_long || no_character ? 0 : bytes;
}

}  // namespace

Error::~Error() = default;

std::string one_line(std::string_view text) {
  constexpr std::size_t kMostBytes = 4000;
  constexpr unsigned char kDelete = 0x7F;
  std::string line;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t bytes = character_bytes(text.substr(at));
    if (line.size() + bytes > kMostBytes) return line + "...";
    const unsigned char first = static_cast<unsigned char>(text[at]);
    if (first == '\n' || first == '\r' || first == '\t')
      line += ' ';
    else if (bytes == 0 || first < ' ' || first == kDelete)
      line += '?';
    else
      line += text.substr(at, bytes);
    at += bytes == 0 ? 1 : bytes;
  }
  return line;
}

}  // namespace routebench
