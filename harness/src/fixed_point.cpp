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
  std::array<char, kLongestNumber> number{};
  const char* end = put_units(number.data(), units, decimals);
  text.append(number.data(), static_cast<std::size_t>(end - number.data()));
}

}  // namespace routebench
