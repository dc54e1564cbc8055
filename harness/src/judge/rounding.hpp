#pragma once
/// Whole numbers next to steps.

#include <cstdint>

namespace routebench::judging {

// By conversion: std::ceil and std::floor are calls on plain processors. By way of signed numbers:
// to unsigned ones it is several instructions. For steps up to 2^62.

[[nodiscard]] inline std::int64_t rounded_up(double steps) noexcept {
  const auto whole = static_cast<std::int64_t>(steps);
  return static_cast<double>(whole) < steps ? whole + 1 : whole;
}

[[nodiscard]] inline std::int64_t rounded_down(double steps) noexcept {
  const auto whole = static_cast<std::int64_t>(steps);
  return static_cast<double>(whole) > steps ? whole - 1 : whole;
}

}  // namespace routebench::judging
