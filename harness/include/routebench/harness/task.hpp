#pragma once
/// What every contender has to deposit, and how the printer behaves: the same for all.

#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// The gate's limits: what a route may miss or overdo and still count as having done the task.
struct GateLimits {
  double covered_min = 0.95;
  double skipped_max = 0.008;
  double worst_layer_max = 0.4;
  double deposit_min = 0.85;
  double deposit_max = 1.15;
  double outline_covered_min = 0.95;  ///< only if walls are asked for
  double spilled_max = 0.02;
  double doubled_max = 0.25;
  double hollow_share_max = 0.001;  ///< of extrude_mm
};

/// Which parts of a layer must be dense, besides what lies below the task's base height.
enum class SkinRule {
  kDifference,  ///< what has air within skin_layers layers (see find_solid)
  kSlope,       ///< whole layers about facets that rise by less than a fifth (De Keyser, 2016)
  kNear,        ///< whole layers near level facets (De Keyser, 2016, an earlier rule)
};

/// Mean width of a bead, section / height: of a rectangle with round ends or, where it is narrower
/// than high, of an ellipse.
[[nodiscard]] inline double mean_bead_width_mm(double width_mm, double height_mm) noexcept {
  return width_mm >= height_mm ? width_mm - height_mm * (1 - std::numbers::pi / 4)
                               : width_mm * std::numbers::pi / 4;
}

struct Task {
  double layer_height_mm = 0.2;
  double line_width_mm = 0.45;
  int perimeters = 2;
  double density = 0.2;  ///< of what is neither wall nor skin; 0 leaves it empty
  int skin_layers = 3;
  SkinRule skin_rule = SkinRule::kDifference;
  double base_mm = 0;     ///< layers cut below this height are dense as a whole
  double join_mm = 0.01;  ///< strokes whose gap is no longer than this count as one
  Point2 start_mm;  ///< where the nozzle is when a layer's planning begins; the same for all layers
  GateLimits gate;

  /// Between the centres of neighbouring lines at density 1: a bead is a rectangle with round ends,
  /// and lines that far apart fill the layer exactly. w - h (1 - pi/4).
  [[nodiscard]] double spacing_mm() const noexcept {
    return line_width_mm - layer_height_mm * (1 - std::numbers::pi / 4);
  }
  /// Section of a bead, mm2: (w - h) h + pi h^2 / 4 = spacing x height.
  [[nodiscard]] double bead_section_mm2() const noexcept { return spacing_mm() * layer_height_mm; }
  /// Mean width of a bead of any width: of the task's own width its spacing.
  [[nodiscard]] double mean_width_mm(double width_mm) const noexcept {
    return mean_bead_width_mm(width_mm, layer_height_mm);
  }
};

/// When a travel is made with the filament pulled back.
enum class RetractPolicy {
  kLength,             ///< travel of retract_over_mm or more
  kLengthAndCrossing,  ///< and it leaves the layer's polygons
  kManhattan,          ///< |dx| + |dy| of retract_over_mm or more (De Keyser, 2016)
};

struct Printer {
  RetractPolicy retract_policy = RetractPolicy::kLength;
  double retract_over_mm = 2.0;
  double retract_mm = 0.8;
  double retract_mm_s = 40;
  double lift_mm = 0;
  double extrude_mm_s = 60;
  double travel_mm_s = 150;
  double accel_mm_s2 = 1000;
  double junction_mm = 0.013;      ///< junction deviation
  double jerk_mm_s = 0;            ///< classic jerk; 0: corners go by junction deviation
  double filament_mm = 1.75;       ///< diameter
  std::string flavour = "marlin";  ///< of G-code; see GcodeWriter
};

/// A bound key of a [task] or [printer] table: set by name from a config or a command line, listed
/// for help and record. Throws Error{kBadInput} naming the key, the value, what would be right and
/// the nearest known key.
void set_task_value(Task& task, std::string_view key, std::string_view value);
void set_printer_value(Printer& printer, std::string_view key, std::string_view value);

/// Checks what keys ask of each other; to be called once all are set, since no order of setting
/// them may matter. Throws Error{kBadInput} if a bead would be higher than wide or the gate's
/// limits exclude each other.
void check_task(const Task& task);

/// Key and value, in the order of the struct; values as a config would have them. Gate limits are
/// keys of the task, named gate_covered_min and so on; start_mm is written "x,y".
struct KeyValue {
  std::string key;
  std::string value;
};
[[nodiscard]] std::vector<KeyValue> task_values(const Task& task);
[[nodiscard]] std::vector<KeyValue> printer_values(const Printer& printer);

}  // namespace routebench
