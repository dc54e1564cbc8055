#include "fixed_point.hpp"

#include <array>

namespace routebench {

void append_units(std::string& text, std::int64_t units, int decimals) {
  std::array<char, kLongestNumber> number{};
  const char* end = put_units(number.data(), units, decimals);
  text.append(number.data(), static_cast<std::size_t>(end - number.data()));
}

}  // namespace routebench
