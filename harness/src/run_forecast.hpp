#pragma once
/// How long cells are going to take: from cells that were executed before, else from their size.

#include <map>
#include <string>

#include "run_redo.hpp"
#include "run_state.hpp"

namespace routebench {

/// Expected times on this machine.
class Forecast {
 public:
  Forecast(const std::vector<CellState>& states, const KnownCells& known,
           const std::map<const PlannedCell*, Predecessor>& predecessors);

  /// Of planning and judging a cell in its process.
  [[nodiscard]] double cell_s(const PlannedCell& cell) const;
  /// Of planning it once more.
  [[nodiscard]] double sample_s(const PlannedCell& cell) const;

  /// Cells of this plan, or their predecessors, whose times are known.
  [[nodiscard]] std::size_t known_cells() const noexcept { return times_.size(); }

 private:
  struct Times {
    double cell_s = 0;
    double sample_s = 0;
  };
  /// Times for so much work, as far as cells are known.
  struct Rate {
    double work = 0;
    Times times;
    void add(double more_work, const Times& more);
    [[nodiscard]] Times of(double cell_work) const;
  };
  [[nodiscard]] Times times_of(const PlannedCell& cell) const;

  std::map<const PlannedCell*, Times> times_;
  std::map<const ReadyContender*, Rate> contender_rates_;
  Rate rate_;
};

/// How much there is to plan and to judge on a model: millimetres that fill what its task demands,
/// and as many for each vertex of a contour and each layer as take about the same time.
[[nodiscard]] double work_of(const PreparedModel& model, const Task& task);

}  // namespace routebench
