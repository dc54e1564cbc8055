#pragma once
/// Decimal numbers as text through integers: several times faster than printing floating point,
/// and there is no "-0".

#include <cstdint>
#include <string>

namespace routebench {

/// Decimals at which every coordinate of the grid (2^-20 mm) keeps a text of its own.
inline constexpr int kGridDecimals = 7;

/// Whole multiples of 10^-decimals nearest to a value. Takes decimals from 0 to 9 and a value whose
/// result fits.
[[nodiscard]] std::int64_t to_units(double value, int decimals);

/// Appends units x 10^-decimals without trailing zeros: 12.5, -0.04, 3.
void append_units(std::string& text, std::int64_t units, int decimals);

/// Appends a value rounded to decimals, without trailing zeros.
inline void append_fixed(std::string& text, double value, int decimals) {
  append_units(text, to_units(value, decimals), decimals);
}

}  // namespace routebench
