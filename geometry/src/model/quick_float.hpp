#pragma once
/// Decimal numbers as meshes have them, faster than the general way.

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace routebench::models {

/// Reads the number that begins at `at` and ends before a blank: sign, digits with or without a
/// point, exponent.
///
/// Returns where it ends, with `value` set to what std::from_chars says; nullptr, and `value`
///         untouched, if it is no such number, or one that this way cannot be sure of (many digits,
///         large exponents, halfway between two floats): ask std::from_chars then.
/// Source  W. Clinger, 1990: digits below 2^53 times or over a power of ten up to 10^22 is rounded
///         once. Rounding that to single precision errs only if it lies halfway between two floats.
[[nodiscard]] inline const char* quick_float(const char* at, const char* end,
                                             float& value) noexcept {
  static constexpr std::array<double, 23> kPowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr std::uint64_t kMostExact = std::uint64_t{1} << 53U;
  constexpr std::uint64_t kBelowFloat = (std::uint64_t{1} << 29U) - 1;  // bits that a float lacks
  constexpr std::uint64_t kHalfway = std::uint64_t{1} << 28U;
  constexpr int kMostDigits = 18;  // fit 64 bits in any case

  const bool negative = at < end && *at == '-';
  if (negative) ++at;
  const auto digit_at = [&] { return static_cast<unsigned>(*at) - unsigned{'0'}; };
  std::uint64_t digits = 0;
  const char* const first = at;
  while (at < end && digit_at() < 10) digits = digits * 10 + digit_at(), ++at;
  auto count = at - first;
  int exponent = 0;
  if (at < end && *at == '.') {
    const char* const point = at++;
    while (at < end && digit_at() < 10) digits = digits * 10 + digit_at(), ++at;
    exponent = static_cast<int>(point + 1 - at);
    count -= exponent;
  }
  if (count == 0 || count > kMostDigits) return nullptr;
  if (at < end && (*at == 'e' || *at == 'E')) {
    ++at;
    const bool small = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+')) ++at;
    const char* const power = at;
    int number = 0;
    while (at < end && digit_at() < 10 && at - power < 3)
      number = number * 10 + static_cast<int>(digit_at()), ++at;
    if (at == power) return nullptr;
    exponent += small ? -number : number;
  }
  const bool ends = at < end && *at >= 0 && *at <= ' ';
  if (!ends || digits >= kMostExact || exponent < -22 || exponent > 22) return nullptr;

  const auto whole = static_cast<double>(digits);
  const double exact = exponent < 0 ? whole / kPowers[static_cast<std::size_t>(-exponent)]
                                    : whole * kPowers[static_cast<std::size_t>(exponent)];
  if ((std::bit_cast<std::uint64_t>(exact) & kBelowFloat) == kHalfway) return nullptr;
  const bool normal = exact >= static_cast<double>(std::numeric_limits<float>::min()) &&
                      exact <= static_cast<double>(std::numeric_limits<float>::max());
  if (!normal && digits != 0) return nullptr;
  value = static_cast<float>(negative ? -exact : exact);
  return at;
}

}  // namespace routebench::models
