#pragma once
/// Scores routes from what they are: planners cannot reach this code.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/metrics.hpp"
#include "routebench/harness/task.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

/// One layer's scores with the weights that its cell's totals need.
struct LayerScore {
  int layer_index = 0;
  double z_mm = 0;
  bool repaired = false;
  Scores scores;
  double area_mm2 = 0;    ///< of the layer's polygons
  double outline_mm = 0;  ///< length of their boundary
  double demanded_mm3 = 0;
  std::optional<Point2>
      end;  ///< where the nozzle is afterwards; nothing if the layer has no stroke

  friend bool operator==(const LayerScore&, const LayerScore&) = default;
};

/// How a cell ended.
enum class Outcome {
  kValid,
  kOffTask,
  kFailed,
  kCrashed,
  kTimedOut,
  kOutOfMemory,
  kNotInstalled,  ///< the foreign slicer is not on this machine: no cell that went wrong
};
/// All of them, in this order.
[[nodiscard]] std::span<const Outcome> outcomes();
[[nodiscard]] std::string_view to_string(Outcome outcome);  ///< "valid", "off_task", ...

struct Verdict {
  Outcome outcome = Outcome::kValid;
  std::string reason;  ///< "covered 0.91 < 0.95; ...": every limit that is missed, with the figure;
                       ///< empty if valid
};

/// The judge of one task on one printer. Immutable; safe from any thread.
class Judge {
 public:
  Judge(Task task, Printer printer);

  /// Scores one layer's route.
  ///
  /// Takes   what demand_of makes of the layer, and where the layer below really ended (nothing for
  ///         the first layer: its entry travel is 0).
  /// Returns every metric of the table that a layer has; plan_*_ns and peak_rss_bytes are left
  ///         empty, and so are shares of an area too small to be sampled.
  /// Throws  Error{kBadInput} for a stroke that is none: see the message.
  /// Cost    linear in strokes and in samples of coverage (0.05 mm grid, rotated: an axis-aligned
  ///         one is wrong by up to 5 %).
  [[nodiscard]] LayerScore score(const Layer& layer, const Demand& demand, const Route& route,
                                 std::optional<Point2> previous_end) const;

  /// Totals of a cell, by each metric's rule.
  [[nodiscard]] Scores total(std::span<const LayerScore> layers) const;

  /// Whether the contender did the task at all, by the task's gate.
  ///
  /// What is covered and deposited on the whole would let pass a route that leaves out thin slices
  /// of a sparse filling, or one layer of many. Hence two limits more: on what is `skipped` (see
  /// there; a planner that leaves out 5 % of the area misses it by far, an honest one keeps well
  /// within it), and on the `worst_layer`.
  [[nodiscard]] Verdict verdict(const Scores& totals) const;

  [[nodiscard]] const Task& task() const noexcept { return task_; }
  [[nodiscard]] const Printer& printer() const noexcept { return printer_; }

 private:
  Task task_;
  Printer printer_;
};

/// True if the printer retracts on a travel. `outside_mm` is the travel's length outside the layer.
[[nodiscard]] bool retracts(const Printer& printer, Point2 from, Point2 to, double outside_mm);

}  // namespace routebench
