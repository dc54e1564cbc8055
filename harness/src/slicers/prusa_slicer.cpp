/// PrusaSlicer 2.5.

#include <cmath>

#include "slicers/slic3r_family.hpp"

namespace routebench::slicers {

Settings prusa_slicer_settings(const Task& task, const Printer& printer) {
  Settings settings = slic3r_family_settings(task, printer);
  const auto set_all = [&settings](std::initializer_list<const char*> keys,
                                   const std::string& value) {
    for (const char* key : keys) settings.emplace_back(key, value);
  };
  set_all({"gcode_flavor"}, "marlin");
  set_all({"perimeter_generator"}, "classic");
  set_all({"top_fill_pattern", "bottom_fill_pattern"}, "rectilinear");
  set_all({"gap_fill_enabled", "ensure_vertical_shell_thickness", "thick_bridges",
           "top_solid_min_thickness", "bottom_solid_min_thickness", "elefant_foot_compensation"},
          "0");
  set_all({"max_layer_height"}, number(task.layer_height_mm));
  set_all({"max_print_height"}, "1200");

  // For the program's own estimate of the print time. It knows Marlin's classic jerk alone; the
  // jerk that lets a right-angled corner pass as the junction deviation does is Marlin's own rule.
  constexpr double kDeviationOfJerk = 0.4;
  constexpr const char* kUnlimited = "100000";
  set_all({"machine_limits_usage"}, "time_estimate_only");
  set_all({"machine_max_acceleration_x", "machine_max_acceleration_y", "machine_max_acceleration_z",
           "machine_max_acceleration_extruding", "machine_max_acceleration_travel"},
          number(printer.accel_mm_s2));
  set_all({"machine_max_acceleration_e", "machine_max_acceleration_retracting",
           "machine_max_feedrate_x", "machine_max_feedrate_y", "machine_max_feedrate_z",
           "machine_max_feedrate_e", "machine_max_jerk_e"},
          kUnlimited);
  set_all({"machine_max_jerk_x", "machine_max_jerk_y", "machine_max_jerk_z"},
          number(std::sqrt(printer.junction_mm * printer.accel_mm_s2 / kDeviationOfJerk)));
  return settings;
}

SlicerCall prusa_slicer_call(const SliceJob& job) {
  const std::filesystem::path ini = job.folder / "settings.ini";
  write_ini(ini, prusa_slicer_settings(job.task, job.printer));
  return {{"--datadir", job.folder / "data", "--load", ini, "--loglevel", "1", "--dont-arrange",
           "--export-gcode", "--output", job.gcode, job.model},
          {}};
}

}  // namespace routebench::slicers
