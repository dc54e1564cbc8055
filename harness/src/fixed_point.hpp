#pragma once
/// Decimal numbers as text through integers: several times faster than printing floating point,
/// and there is no "-0".

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace routebench {

/// Decimals at which every coordinate of the grid (2^-20 mm) keeps a text of its own.
inline constexpr int kGridDecimals = 7;

/// Room that put_units needs at most.
inline constexpr std::size_t kLongestNumber = 24;

/// Whole multiples of 10^-decimals nearest to a value. Takes decimals from 0 to 9 and a value whose
/// result fits.
[[nodiscard]] inline std::int64_t to_units(double value, int decimals) {
  constexpr std::array<double, 10> kPowers = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
  assert(decimals >= 0 && static_cast<std::size_t>(decimals) < kPowers.size());
  return std::llrint(value * kPowers[static_cast<std::size_t>(decimals)]);
}

/// 00 to 99, for two digits at once.
inline constexpr std::array<char, 200> kDigitPairs = [] {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

/// Writes units x 10^-decimals without trailing zeros: 12.5, -0.04, 3. Takes decimals from 0 to 9;
/// fastest for a constant. Returns the end of what was written.
inline char* put_units(char* at, std::int64_t units, int decimals) {
  constexpr std::array<std::uint64_t, 10> kPowers = {
      1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000, 1000000000};
  // Unsigned, so that the lowest integer has a magnitude too.
  auto rest = static_cast<std::uint64_t>(units);
  if (units < 0) {
    *at++ = '-';
    rest = ~rest + 1;
  }
  const std::uint64_t power = kPowers[static_cast<std::size_t>(decimals)];
  if (const std::uint64_t whole = rest / power; whole < 10)
    *at++ = static_cast<char>('0' + whole);
  else if (whole < 100)
    at = std::copy_n(kDigitPairs.data() + 2 * whole, 2, at);
  else
    at = std::to_chars(at, at + kLongestNumber, whole).ptr;
  auto fraction = static_cast<std::uint32_t>(rest % power);
  if (fraction == 0) return at;
  *at++ = '.';
  int place = decimals;
  for (; place >= 2; place -= 2, fraction /= 100)
    std::copy_n(kDigitPairs.data() + std::size_t{2} * (fraction % 100), 2, at + place - 2);
  if (place == 1) *at = static_cast<char>('0' + fraction);
  at += decimals;
  while (*(at - 1) == '0') --at;
  return at;
}

/// Appends the same to a text.
void append_units(std::string& text, std::int64_t units, int decimals);

/// Appends a value rounded to decimals, without trailing zeros.
inline void append_fixed(std::string& text, double value, int decimals) {
  append_units(text, to_units(value, decimals), decimals);
}

}  // namespace routebench
