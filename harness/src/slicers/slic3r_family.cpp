#include "slicers/slic3r_family.hpp"

#include <algorithm>
#include <ostream>

#include "routebench/harness/output.hpp"

namespace routebench::slicers {

Settings slic3r_family_settings(const Task& task, const Printer& printer) {
  Settings settings;
  const auto set = [&settings](const char* key, const std::string& value) {
    settings.emplace_back(key, value);
  };
  const auto set_all = [&set](std::initializer_list<const char*> keys, const std::string& value) {
    for (const char* key : keys) set(key, value);
  };

  // Beads. The nozzle only bounds what widths and heights are accepted.
  constexpr double kWidthOfNozzle = 1.125;
  set("nozzle_diameter",
      number(std::max(task.layer_height_mm, task.line_width_mm / kWidthOfNozzle)));
  set("filament_diameter", number(printer.filament_mm));
  set_all({"layer_height", "first_layer_height"}, number(task.layer_height_mm));
  set_all({"extrusion_width", "first_layer_extrusion_width", "perimeter_extrusion_width",
           "external_perimeter_extrusion_width", "infill_extrusion_width",
           "solid_infill_extrusion_width", "top_infill_extrusion_width"},
          number(task.line_width_mm));
  set_all({"extrusion_multiplier", "bridge_flow_ratio"}, "1");

  set("perimeters", std::to_string(task.perimeters));
  set_all({"thin_walls", "extra_perimeters", "overhangs", "external_perimeters_first"}, "0");
  set("seam_position", "nearest");

  set("fill_density", number(100 * task.density) + "%");
  set("fill_pattern", "rectilinear");
  set("fill_angle", "45");
  set("infill_overlap", "25%");
  set_all({"infill_every_layers"}, "1");
  set_all({"solid_infill_below_area", "infill_only_where_needed", "infill_first"}, "0");
  set_all({"top_solid_layers", "bottom_solid_layers"}, std::to_string(task.skin_layers));

  set("retract_length", number(printer.retract_mm));
  set("retract_speed", number(printer.retract_mm_s));
  set("retract_before_travel", number(printer.retract_over_mm));
  set("retract_lift", number(printer.lift_mm));
  set("only_retract_when_crossing_perimeters",
      printer.retract_policy == RetractPolicy::kLengthAndCrossing ? "1" : "0");
  set_all({"retract_layer_change", "retract_restart_extra", "wipe", "avoid_crossing_perimeters"},
          "0");

  set_all({"perimeter_speed", "external_perimeter_speed", "small_perimeter_speed", "infill_speed",
           "solid_infill_speed", "top_solid_infill_speed", "bridge_speed", "gap_fill_speed",
           "first_layer_speed", "max_print_speed"},
          number(printer.extrude_mm_s));
  set("travel_speed", number(printer.travel_mm_s));
  set_all({"max_volumetric_speed", "default_acceleration", "perimeter_acceleration",
           "infill_acceleration", "bridge_acceleration", "first_layer_acceleration"},
          "0");

  set_all({"skirts", "brim_width", "support_material", "raft_layers", "cooling", "complete_objects",
           "use_relative_e_distances"},
          "0");
  set_all({"start_gcode", "end_gcode"}, "");
  // A bed on which every model has room with the places that it has.
  set("bed_shape", "-2000x-2000,2000x-2000,2000x2000,-2000x2000");
  return settings;
}

void write_ini(const std::filesystem::path& file, const Settings& settings) {
  OutputSet outputs;
  outputs.add(file, [&](std::ostream& out) {
    for (const auto& [key, value] : settings) out << key << " = " << value << '\n';
  });
  outputs.commit();
}

}  // namespace routebench::slicers
