/// Slic3r 1.3.

#include "slicers/slic3r_family.hpp"

namespace routebench::slicers {

Settings slic3r_settings(const Task& task, const Printer& printer) {
  Settings settings = slic3r_family_settings(task, printer);
  for (const char* key : {"top_infill_pattern", "bottom_infill_pattern"})
    settings.emplace_back(key, "rectilinear");
  for (const char* key : {"fill_gaps", "adaptive_slicing", "interior_brim_width"})
    settings.emplace_back(key, "0");
  settings.emplace_back("gcode_flavor", "reprap");
  return settings;
}

SlicerCall slic3r_call(const SliceJob& job) {
  const std::filesystem::path ini = job.folder / "settings.ini";
  write_ini(ini, slic3r_settings(job.task, job.printer));
  return {{"--no-gui", "--datadir", job.folder / "data", "--load", ini, "--dont-arrange",
           "--threads", "1", "--output", job.gcode, job.model},
          {}};
}

}  // namespace routebench::slicers
