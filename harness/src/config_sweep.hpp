#pragma once
/// Sweep axes: keys whose value may be a list, and all combinations of them.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "config_table.hpp"

namespace routebench {

/// What kind of value a key takes; a pair is written [x, y].
enum class ValueShape { kSingle, kPair };

/// One key of a sweep.
struct Axis {
  std::string name;                 ///< as in labels: "fill.angle_deg"
  std::vector<ConfigEntry> points;  ///< at least one
  bool swept = false;               ///< written as a list
};

/// The axis that a key spans. Throws Error{kBadInput} for an empty list, for a value that stands in
/// it twice, and for what is no value.
[[nodiscard]] Axis axis_of(const ConfigEntry& entry, std::string name, ValueShape shape);

/// A value as labels and text interfaces have it: 0.2, grid, 1,2.
[[nodiscard]] std::string value_text(const ConfigEntry& point);

/// One point of a sweep: for each axis the place of its value.
using Combination = std::vector<std::size_t>;

/// Calls visit for every combination, the last axis running fastest.
/// Throws Error{kBadInput} at the last swept key if there are more than can be meant.
void for_each_combination(const std::vector<Axis>& axes,
                          const std::function<void(const Combination&)>& visit);

/// "density=0.2, perimeters=3": the swept axes with their values.
[[nodiscard]] std::string sweep_label(const std::vector<Axis>& axes,
                                      const Combination& combination);

}  // namespace routebench
