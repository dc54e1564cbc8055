#include "fixed_point.hpp"

#include <array>
#include <cassert>
#include <cmath>

namespace routebench {
namespace {

constexpr std::array<double, 10> kPowers = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};

}  // namespace

std::int64_t to_units(double value, int decimals) {
  assert(decimals >= 0 && static_cast<std::size_t>(decimals) < kPowers.size());
  return std::llrint(value * kPowers[static_cast<std::size_t>(decimals)]);
}

void append_units(std::string& text, std::int64_t units, int decimals) {
  std::array<char, 32> digits{};
  std::size_t at = digits.size();
  // Unsigned, so that the lowest integer has a magnitude too.
  std::uint64_t rest =
      units < 0 ? ~static_cast<std::uint64_t>(units) + 1 : static_cast<std::uint64_t>(units);
  bool significant = false;
  for (int place = 0; place < decimals; ++place, rest /= 10) {
    const auto digit = static_cast<char>('0' + rest % 10);
    significant = significant || digit != '0';
    if (significant) digits[--at] = digit;
  }
  if (significant) digits[--at] = '.';
  do {
    digits[--at] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest != 0);
  if (units < 0) digits[--at] = '-';
  text.append(digits.data() + at, digits.size() - at);
}

}  // namespace routebench
