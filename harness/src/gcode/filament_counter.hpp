#pragma once
/// How much filament the moves of a print are given.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "fixed_point.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

inline constexpr int kFilamentDecimals = 5;

/// Where a coordinate is on the paper.
struct WrittenPlace {
  std::int64_t x;
  std::int64_t y;
  friend bool operator==(const WrittenPlace&, const WrittenPlace&) = default;
};
inline WrittenPlace written(Point2 p) {
  return {to_units(p.x, kGridDecimals), to_units(p.y, kGridDecimals)};
}
/// Whether a move vanishes in rounding.
inline bool written_alike(Point2 a, Point2 b) {
  constexpr double kApartMm = 1e-6;  // ten units
  if (std::abs(a.x - b.x) > kApartMm || std::abs(a.y - b.y) > kApartMm) return false;
  return written(a) == written(b);
}

/// What some moves need of the filament, and what was written for them.
struct Filament {
  double length = 0;  ///< mm; mm3 where it is counted so
  std::int64_t units = 0;
  Filament& operator+=(const Filament& more) {
    length += more.length;
    units += more.units;
    return *this;
  }
};

/// Counts what strokes need of the filament.
class FilamentCounter {
 public:
  FilamentCounter(const Task& task, const Printer& printer, bool volumetric, const Filament& so_far)
      : task_(task),
        section_mm2_(volumetric ? 1
                                : std::numbers::pi / 4 * printer.filament_mm * printer.filament_mm),
        filament_(so_far) {}

  /// Calls visit(end of the move, units for it, units in all) for the moves of a stroke to its
  /// points [begin, end), begin > 0.
  template <typename Visit>
  void count(const Stroke& stroke, std::size_t begin, std::size_t end, Visit&& visit) {
    const double share =
        task_.mean_width_mm(stroke.width_mm) * task_.layer_height_mm / section_mm2_;
    for (std::size_t i = begin; i < end; ++i) {
      const Point2 from = stroke.points[i - 1];
      const Point2 to = stroke.points[i];
      filament_.length += share * distance(from, to);
      if (written_alike(from, to)) continue;
      // A move that extrudes says so, however short it is; the sum catches up with the next moves.
      const std::int64_t units = std::max<std::int64_t>(
          1, to_units(filament_.length, kFilamentDecimals) - filament_.units);
      filament_.units += units;
      visit(to, units, filament_.units);
    }
  }

  [[nodiscard]] const Filament& filament() const noexcept { return filament_; }

 private:
  const Task& task_;
  double section_mm2_;  // of the filament; 1 where it is counted in mm3
  Filament filament_;
};

}  // namespace routebench
