#include "entries.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "model/stl_reader.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/harness/config.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/gcode_score.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench::fuzz {
namespace {

void require(bool promise, const char* what) {
  if (!promise) throw std::logic_error(what);
}

/// Runs something that may refuse its input.
template <typename Read>
void refusing(Read&& read) {
  try {
    read();
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::kBadInput, "refused as something else than bad input");
  }
}

void check(const GcodePrint& print) {
  require(!print.layers.empty(), "no layer");
  require(std::is_sorted(print.layers.begin(), print.layers.end(),
                         [](const auto& a, const auto& b) { return a.z_mm < b.z_mm; }),
          "layers are not sorted");
  require(std::isfinite(print.travel_mm) && print.travel_mm >= 0, "travel");
  require(std::isfinite(print.filament_mm3) && print.filament_mm3 > 0, "filament");
  for (const GcodeLayer& layer : print.layers) {
    require(std::isfinite(layer.z_mm) && layer.height_mm > 0, "height");
    require(!layer.route.strokes.empty(), "a layer without strokes");
    require(layer.kinds.size() == layer.route.strokes.size(), "kinds");
    for (const Stroke& stroke : layer.route.strokes) {
      require(stroke.points.size() >= 2, "a stroke of a point");
      require(stroke.width_mm > 0 && stroke.width_mm <= 1000, "width");
      for (const Point2 p : stroke.points)
        require(p == snap(p) && std::isfinite(p.x) && std::isfinite(p.y), "a point off the grid");
    }
  }
}

}  // namespace

void read_as_gcode(std::span<const char> bytes) {
  refusing([&] {
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    const GcodePrint print = read_gcode(in, "fuzz.gcode", {});
    check(print);
    const GcodeScore score = score_gcode(Judge({}, {}), print, serial_for);
    for (const std::optional<double>& value : score.cell.totals)
      require(!value || (std::isfinite(*value) && *value >= 0), "a score that is none");
  });
}

void read_as_stl(std::span<const char> bytes) {
  for (const bool repair : {false, true})
    refusing([&] {
      const models::RawMesh raw = models::read_stl(bytes, {.name = "fuzz.stl", .repair = repair});
      for (const auto& triangle : raw.mesh.triangles)
        for (const std::uint32_t corner : triangle)
          require(corner < raw.mesh.vertices.size(), "a corner that is not there");
      for (const Point3 p : raw.mesh.vertices)
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "not finite");
    });
}

void read_as_config(std::span<const char> bytes) {
  static const PlannerSet planners = load_planners({});
  refusing([&] {
    const ExperimentConfig config = parse_config({bytes.begin(), bytes.end()}, "fuzz.toml");
    require(config.cell_count() > 0, "no cells");
    check_contenders(config, planners.registry);
    require(!resolved_json(config, planners.registry).empty(), "no document");
  });
}

}  // namespace routebench::fuzz
