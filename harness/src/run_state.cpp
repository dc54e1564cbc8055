#include "run_state.hpp"

#include <algorithm>

namespace routebench {
namespace {

/// A cell that ran into a limit which has been raised since gets another chance.
bool may_go_further(const KnownCell& known, const RunOptions& run) {
  return (known.outcome == Outcome::kTimedOut && run.timeout_s > known.timeout_s) ||
         (known.outcome == Outcome::kOutOfMemory && run.memory_mb > known.memory_mb);
}

}  // namespace

bool is_foreign(const PlannedCell& cell) {
  return std::holds_alternative<Slicer>(cell.contender->worker);
}

std::vector<CellState> states_of(const RunPlan& plan, const KnownCells& known,
                                 const RunOptions& run) {
  std::vector<CellState> states;
  for (const PlannedCell& cell : plan.cells) {
    CellState state{&cell, 0, Outcome::kFailed, {}, {}};
    const auto found = known.find(cell.key);
    if (found != known.end() && !(cell.chosen && may_go_further(found->second, run)))
      state = {&cell, found->second.cell_id, found->second.outcome, found->second.route_hash,
               found->second.repetitions};
    states.push_back(std::move(state));
  }
  return states;
}

std::vector<int> missing_repetitions(const CellState& state, int wanted) {
  std::vector<int> missing;
  if (!state.cell->chosen || !state.has_route() || is_foreign(*state.cell)) return missing;
  for (int i = 0; i < wanted; ++i)
    if (!std::binary_search(state.repetitions.begin(), state.repetitions.end(), i))
      missing.push_back(i);
  return missing;
}

std::vector<Repetition> timing_order(const std::vector<CellState>& states, int repetitions,
                                     std::uint64_t seed) {
  // splitmix64: the same order everywhere, which std::shuffle does not promise.
  const auto next = [&seed] {
    std::uint64_t z = (seed += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  };
  std::vector<std::vector<Repetition>> rounds(static_cast<std::size_t>(repetitions));
  for (std::size_t i = 0; i < states.size(); ++i)
    for (const int number : missing_repetitions(states[i], repetitions))
      rounds[static_cast<std::size_t>(number)].push_back({i, number});
  std::vector<Repetition> order;
  for (std::vector<Repetition>& round : rounds) {
    for (std::size_t left = round.size(); left > 1; --left)
      std::swap(round[left - 1], round[next() % left]);
    order.insert(order.end(), round.begin(), round.end());
  }
  return order;
}

}  // namespace routebench
