#pragma once
/// The one table of what is measured. Records, tables, plots and their axis labels come from it.

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace routebench {

enum class Better { kLower, kHigher, kNeither };

/// How the layers of a cell make its total.
enum class Total {
  kSum,      ///< the sum
  kMax,      ///< the largest
  kArea,     ///< mean weighted by the layer's area
  kOutline,  ///< mean weighted by the length of the layer's boundary
  kDemand,   ///< mean weighted by the demanded volume
  kCell,     ///< measured for the cell, not for a layer
};

struct MetricInfo {
  std::string_view name;   ///< as in JSON, the database and configs
  std::string_view label;  ///< for people, without unit
  std::string_view unit;   ///< empty for counts and shares
  Better better;
  Total total;
  std::string_view meaning;  ///< one line
};

/// In the order in which tables show them.
[[nodiscard]] std::span<const MetricInfo> metric_table();

/// Place in the table. Throws Error{kBadUsage} with the nearest name.
[[nodiscard]] std::size_t metric_index(std::string_view name);

/// Whether equal routes always have equal values: false for times and memory, which are measured.
[[nodiscard]] bool is_deterministic(std::string_view metric);

/// One value a metric, in the table's order; nothing where it does not apply. Zero is a value.
using Scores = std::vector<std::optional<double>>;

}  // namespace routebench
