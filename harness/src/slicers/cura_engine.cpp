/// CuraEngine 4.13.
///
/// The engine alone does not evaluate the formulas of its definition file: it takes each setting's
/// default. So every setting that would follow from another one is given its value here.

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <system_error>

#include "slicers/slicer_kind.hpp"

namespace routebench::slicers {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSearchPath = "CURA_ENGINE_SEARCH_PATH";
constexpr const char* kDefinitions = "fdmprinter.def.json";
constexpr const char* kExtruder = "fdmextruder.def.json";
/// Where Debian's package cura has its resources, below the root that it is unpacked in.
constexpr const char* kResources = "usr/share/cura/resources";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : value;
}

/// Where experiments/install_slicers.sh unpacks the package.
fs::path cache_root() {
  const std::string cache = variable("XDG_CACHE_HOME");
  return (cache.empty() ? fs::path(variable("HOME")) / ".cache" : fs::path(cache)) / "routebench" /
         "cura";
}

struct Definitions {
  fs::path printer;         ///< the file
  std::string search_path;  ///< folders, separated by colons
};

std::optional<Definitions> find_definitions() {
  std::error_code error;
  const std::string given = variable(kSearchPath);
  std::istringstream folders(given);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (fs::exists(fs::path(folder) / kDefinitions, error))
      return Definitions{fs::path(folder) / kDefinitions, given};
  for (const fs::path& root : {fs::path("/"), cache_root()}) {
    const fs::path resources = root / kResources;
    const fs::path file = resources / "definitions" / kDefinitions;
    if (fs::exists(file, error) && fs::exists(resources / "definitions" / kExtruder, error))
      return Definitions{
          file, (resources / "definitions").string() + ":" + (resources / "extruders").string()};
  }
  return std::nullopt;
}

}  // namespace

Settings cura_engine_settings(const Task& task, const Printer& printer) {
  Settings settings;
  const auto set = [&settings](std::initializer_list<const char*> keys, const std::string& value) {
    for (const char* key : keys) settings.emplace_back(key, value);
  };

  // Beads are rectangles here: as wide as their spacing, they lay the same volume.
  const double width_mm = task.spacing_mm();
  const double overlap_mm = 0.25 * width_mm;
  set({"layer_height", "layer_height_0", "infill_sparse_thickness"}, number(task.layer_height_mm));
  set({"machine_nozzle_size", "line_width", "wall_line_width", "wall_line_width_0",
       "wall_line_width_x", "skin_line_width", "infill_line_width"},
      number(width_mm));
  set({"initial_layer_line_width_factor", "material_flow"}, "100");
  set({"material_diameter"}, number(printer.filament_mm));
  set({"slicing_tolerance"}, "middle");

  set({"wall_line_count"}, std::to_string(task.perimeters));
  set({"wall_thickness"}, number(task.perimeters * width_mm));
  set({"wall_0_wipe_dist", "wall_0_inset", "xy_offset", "xy_offset_layer_0", "hole_xy_offset"},
      "0");
  set({"fill_outline_gaps", "filter_out_tiny_gaps", "alternate_extra_perimeter",
       "outer_inset_first", "travel_compensate_overlapping_walls_enabled",
       "travel_compensate_overlapping_walls_0_enabled",
       "travel_compensate_overlapping_walls_x_enabled"},
      "false");
  set({"optimize_wall_printing_order", "meshfix_union_all"}, "true");
  set({"fill_perimeter_gaps"}, "nowhere");
  set({"z_seam_type"}, "shortest");
  set({"meshfix_maximum_resolution", "meshfix_maximum_travel_resolution"}, "0.01");
  set({"meshfix_maximum_deviation"}, "0.002");

  set({"infill_sparse_density"}, number(100 * task.density));
  set({"infill_line_distance"}, task.density > 0 ? number(width_mm / task.density) : "0");
  set({"infill_pattern", "top_bottom_pattern", "top_bottom_pattern_0"}, "zigzag");
  set({"zig_zaggify_infill"}, "true");
  set({"infill_before_walls", "connect_infill_polygons"}, "false");
  set({"infill_angles", "skin_angles"}, "[45,135]");
  set({"infill_overlap", "skin_overlap"}, "25");
  set({"infill_overlap_mm", "skin_overlap_mm"}, number(overlap_mm));
  set({"infill_wipe_dist", "gradual_infill_steps", "min_infill_area", "skin_outline_count",
       "skin_edge_support_layers", "skin_edge_support_thickness", "roofing_layer_count",
       "skin_preshrink", "top_skin_preshrink", "bottom_skin_preshrink",
       "expand_skins_expand_distance", "top_skin_expand_distance", "bottom_skin_expand_distance",
       "min_skin_width_for_expansion"},
      "0");
  set({"top_layers", "bottom_layers", "initial_bottom_layers"}, std::to_string(task.skin_layers));

  set({"retraction_enable"}, "true");
  set({"retraction_amount", "retraction_extrusion_window"}, number(printer.retract_mm));
  set({"retraction_speed", "retraction_retract_speed", "retraction_prime_speed"},
      number(printer.retract_mm_s));
  set({"retraction_min_travel"}, number(printer.retract_over_mm));
  set({"retraction_count_max"}, "100000");
  set({"retraction_hop_enabled"}, printer.lift_mm > 0 ? "true" : "false");
  set({"retraction_hop"}, number(printer.lift_mm));
  set({"retraction_combing"}, "off");
  set({"retraction_extra_prime_amount"}, "0");
  set({"retract_at_layer_change", "travel_avoid_other_parts", "travel_avoid_supports",
       "travel_retract_before_outer_wall"},
      "false");

  set({"speed_print", "speed_infill", "speed_wall", "speed_wall_0", "speed_wall_x", "speed_roofing",
       "speed_topbottom", "speed_layer_0", "speed_print_layer_0"},
      number(printer.extrude_mm_s));
  set({"speed_travel", "speed_travel_layer_0", "speed_z_hop"}, number(printer.travel_mm_s));
  set({"speed_slowdown_layers"}, "0");
  set({"acceleration_enabled", "jerk_enabled"}, "false");

  set({"adhesion_type"}, "none");
  set({"support_enable", "prime_tower_enable", "prime_blob_enable", "magic_spiralize",
       "coasting_enable", "bridge_settings_enabled", "cool_fan_enabled", "cool_lift_head",
       "relative_extrusion", "material_print_temp_prepend", "material_bed_temp_prepend",
       "carve_multiple_volumes", "ironing_enabled"},
      "false");
  set({"small_hole_max_size", "small_feature_max_length", "cool_min_layer_time", "cool_fan_speed"},
      "0");

  // The G-code keeps the model's places.
  set({"machine_center_is_zero"}, "true");
  set({"center_object"}, "false");
  set({"mesh_position_x", "mesh_position_y", "mesh_position_z"}, "0");
  set({"machine_width", "machine_depth", "machine_height"}, "4000");
  set({"machine_gcode_flavor"}, "RepRap (Marlin/Sprinter)");
  set({"machine_start_gcode", "machine_end_gcode"}, "");
  return settings;
}

SlicerCall cura_engine_call(const SliceJob& job) {
  const Definitions definitions = find_definitions().value_or(Definitions{});
  SlicerCall call{{"slice", "-m1", "-j", definitions.printer}, {}};
  // Once for the whole print and once for its extruder: each setting is read at one of them.
  const Settings settings = cura_engine_settings(job.task, job.printer);
  const auto add_settings = [&] {
    for (const auto& [key, value] : settings) {
      call.arguments.emplace_back("-s");
      call.arguments.push_back(key + "=" + value);
    }
  };
  add_settings();
  call.arguments.emplace_back("-e0");
  add_settings();
  for (const std::string& word :
       {std::string("-o"), job.gcode.string(), std::string("-l"), job.model.string()})
    call.arguments.push_back(word);
  call.environment.emplace_back(kSearchPath, definitions.search_path);
  return call;
}

std::string cura_engine_lacks() {
  if (find_definitions()) return {};
  return std::string(kDefinitions) + " of Debian's package cura is neither in " + kSearchPath +
         ", /" + kResources + "/definitions nor " + cache_root().string();
}

}  // namespace routebench::slicers
