#pragma once
/// The cells of a plan beside what a database knows of them: what is done, what is to be done, and
/// in which order.

#include <optional>
#include <string>
#include <vector>

#include "routebench/harness/results.hpp"
#include "run_plan.hpp"

namespace routebench {

/// Foreign slicers do not tell the time that planning takes, so there are no samples of it.
[[nodiscard]] bool is_foreign(const PlannedCell& cell);

/// A cell on its way.
struct CellState {
  const PlannedCell* cell = nullptr;
  std::int64_t cell_id = 0;  ///< 0: not in the database
  Outcome outcome = Outcome::kFailed;
  std::optional<std::string> route_hash;
  std::vector<int> repetitions;  ///< that have been taken, ascending

  [[nodiscard]] bool has_route() const {
    return outcome == Outcome::kValid || outcome == Outcome::kOffTask;
  }
  [[nodiscard]] bool is_to_execute() const { return cell->chosen && cell_id == 0; }
};

/// Cells in the plan's order with what is known of them. One that ran into a limit which has been
/// raised since counts as not known.
[[nodiscard]] std::vector<CellState> states_of(const RunPlan& plan, const KnownCells& known,
                                               const RunOptions& run);

/// The timing samples, of so many, that a cell still lacks.
[[nodiscard]] std::vector<int> missing_repetitions(const CellState& state, int wanted);

/// One timing sample to be taken.
struct Repetition {
  std::size_t cell = 0;  ///< place in the states
  int number = 0;
};

/// The order of samples: rounds, each with every cell in random order, so that a slow moment of the
/// machine hits all contenders alike.
[[nodiscard]] std::vector<Repetition> timing_order(const std::vector<CellState>& states,
                                                   int repetitions, std::uint64_t seed);

}  // namespace routebench
