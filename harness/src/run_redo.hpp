#pragma once
/// Why cells are executed although cells of the same name are in the database.

#include <map>
#include <string>
#include <vector>

#include "run_state.hpp"

namespace routebench {

/// A cell that stood where another one is now to be executed.
struct Predecessor {
  const KnownCell* cell = nullptr;
  std::string changed;  ///< "fill.angle_deg 0 -> 45; the model has changed": what is different now
};

/// For each cell that is to be executed and has one: the cell of the same model, contender,
/// setting and seed that the plan does not ask for any more; else one that differs in its
/// contender's name or in its seed alone. Refers to what `known` holds.
[[nodiscard]] std::map<const PlannedCell*, Predecessor> predecessors_of(
    const std::vector<CellState>& states, const KnownCells& known, const RunOptions& run);

}  // namespace routebench
