#pragma once
/// The grid on which every coordinate of a layer lies: multiples of 2^-20 mm (about 1 nm).
///
/// Points on the grid compare exactly, hash, subtract without rounding and map without loss to the
/// 64-bit integers of polygon clippers.

#include <cmath>
#include <cstdint>

#include "routebench/geometry/types.hpp"

namespace routebench {

inline constexpr double kGridUnitsPerMm = 1048576.0;  // 2^20

/// Grid index nearest to a coordinate. Takes mm, |mm| < 2^42.
[[nodiscard]] inline std::int64_t to_grid(double mm) noexcept {
  return std::llrint(mm * kGridUnitsPerMm);
}

/// Coordinate of a grid index, mm; exact for |units| < 2^53.
[[nodiscard]] inline double from_grid(std::int64_t units) noexcept {
  return static_cast<double>(units) / kGridUnitsPerMm;
}

/// Nearest coordinate on the grid, mm.
[[nodiscard]] inline double snap(double mm) noexcept { return from_grid(to_grid(mm)); }

[[nodiscard]] inline Point2 snap(Point2 p) noexcept { return {snap(p.x), snap(p.y)}; }

}  // namespace routebench
