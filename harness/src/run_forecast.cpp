#include "run_forecast.hpp"

#include <algorithm>

#include "routebench/geometry/region.hpp"

namespace routebench {
namespace {

/// Fitted to cells of the quickstart; other planners and machines may be out by a factor of five.
constexpr double kMmPerVertex = 4;
constexpr double kMmPerLayer = 50;
constexpr double kCellSecondsPerMm = 3e-6;
/// What planning takes of a cell's time, judging has the rest.
constexpr double kPlanningShare = 0.3;
/// A process for itself, whatever it does.
constexpr double kProcessSeconds = 0.01;

std::size_t vertices_of(const Polygons& polygons) {
  std::size_t count = 0;
  for (const Polygon& polygon : polygons) {
    count += polygon.outer.size();
    for (const Ring& hole : polygon.holes) count += hole.size();
  }
  return count;
}

}  // namespace

double work_of(const PreparedModel& model, const Task& task) {
  double mm = 0;
  for (const auto& demand : model.demands) {
    const double walls_mm2 = area_mm2(demand->outline) - area_mm2(demand->inside);
    const double lines_mm2 = area_mm2(demand->dense) + task.density * area_mm2(demand->sparse);
    mm += (walls_mm2 + lines_mm2) / task.spacing_mm();
    mm += kMmPerVertex * static_cast<double>(vertices_of(demand->outline)) + kMmPerLayer;
  }
  return mm;
}

void Forecast::Rate::add(double more_work, const Times& more) {
  work += more_work;
  times.cell_s += more.cell_s;
  times.sample_s += more.sample_s;
}

Forecast::Times Forecast::Rate::of(double cell_work) const {
  return {times.cell_s / work * cell_work, times.sample_s / work * cell_work};
}

Forecast::Forecast(const std::vector<CellState>& states, const KnownCells& known,
                   const std::map<const PlannedCell*, Predecessor>& predecessors) {
  for (const CellState& state : states) {
    const KnownCell* cell = nullptr;
    if (state.cell_id != 0)
      cell = &known.at(state.cell->key);
    else if (const auto found = predecessors.find(state.cell); found != predecessors.end())
      cell = found->second.cell;
    if (cell == nullptr) continue;
    const Times times{cell->cell_wall_s, kProcessSeconds + cell->plan_wall_s.value_or(
                                                               kPlanningShare * cell->cell_wall_s)};
    times_[state.cell] = times;
    // How long a cell that went wrong takes says nothing about others.
    if (cell->outcome != Outcome::kValid && cell->outcome != Outcome::kOffTask) continue;
    const double work = state.cell->model->work;
    contender_rates_[state.cell->contender].add(work, times);
    rate_.add(work, times);
  }
}

Forecast::Times Forecast::times_of(const PlannedCell& cell) const {
  if (const auto found = times_.find(&cell); found != times_.end()) return found->second;
  const double work = cell.model->work;
  const auto rate = contender_rates_.find(cell.contender);
  if (rate != contender_rates_.end()) return rate->second.of(work);
  if (rate_.work > 0) return rate_.of(work);
  const double cell_s = kProcessSeconds + kCellSecondsPerMm * work;
  return {cell_s, kProcessSeconds + kPlanningShare * kCellSecondsPerMm * work};
}

double Forecast::cell_s(const PlannedCell& cell) const { return times_of(cell).cell_s; }

double Forecast::sample_s(const PlannedCell& cell) const { return times_of(cell).sample_s; }

}  // namespace routebench
