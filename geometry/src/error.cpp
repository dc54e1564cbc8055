#include "routebench/geometry/error.hpp"

#include <algorithm>

namespace routebench {

Error::~Error() = default;

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace routebench
