#pragma once
/// Executing an experiment once more from its database, and what differs.

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "routebench/harness/config.hpp"
#include "routebench/harness/results.hpp"
#include "routebench/harness/runner.hpp"

namespace routebench {

/// What is needed to execute a database's last run again.
struct Reproduction {
  ExperimentConfig config;           ///< the stored one; its paths begin where they did
  std::vector<std::string> plugins;  ///< files of all plugins, the config's among them
  bool repair = false;
  std::set<CellName> cells;  ///< that the database holds of that config
};

/// Reads it from a database.
/// Takes  another folder for the relative paths of the config, if its own is not here any more.
/// Throws Error{kBadInput} for a file that is no results database of this version or has no cells.
[[nodiscard]] Reproduction read_reproduction(const std::filesystem::path& file,
                                             const std::optional<std::filesystem::path>& base);

/// How two databases of one experiment differ in what must not depend on time and place.
struct Comparison {
  std::size_t cells = 0;                 ///< that both hold
  std::vector<std::string> differences;  ///< "shape:gear · lines: travel_mm 12 -> 13"
  std::vector<std::string> provenance;   ///< "compiler GCC 12.2.0 -> GCC 13.1.0": no difference of
                                         ///< results, but perhaps the reason for one
  double time_ratio = 0;  ///< geometric mean of plan_wall_ns, second to first; 0: none is known
};

/// Compares the current cells: their presence, layers, plugins, outcomes, routes and all metrics
/// but times and memory, which must be equal to the bit.
[[nodiscard]] Comparison compare_results(const std::filesystem::path& before,
                                         const std::filesystem::path& after);

/// For people: what is equal, what differs, what was different about the machine.
void write_comparison(std::ostream& out, const Comparison& comparison);

}  // namespace routebench
