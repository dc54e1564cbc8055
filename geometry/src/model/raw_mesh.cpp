#include "model/raw_mesh.hpp"

#include <array>
#include <charconv>

#include "routebench/geometry/error.hpp"

namespace routebench::models {

void refuse_model(const std::string& name, const std::string& complaint) {
  std::string line = name + ": " + complaint;
  for (char& c : line) {
    const bool control = (c >= 0 && c < ' ') || c == '\x7f';
    if (control) c = '?';
  }
  throw Error(ErrorKind::kBadInput, line);
}

void refuse_too_many_triangles(const std::string& name, std::size_t triangles) {
  if (triangles <= kMostTriangles) return;
  refuse_model(name, std::to_string(triangles) + " triangles are too many: at most " +
                         std::to_string(kMostTriangles) + " can be read");
}

std::string rounded(double value) {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::general, 6);
  return std::string(digits.data(), end);
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text(1, '\'');
  text += word.substr(0, kLongest);
  text += word.size() > kLongest ? "...'" : "'";
  return text;
}

std::string counted(std::size_t count, const char* noun) {
  return std::to_string(count) + ' ' + noun + (count == 1 ? "" : "s");
}

}  // namespace routebench::models
