#include "routebench/harness/metrics.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/nearest_name.hpp"

namespace routebench {

namespace {

using enum Better;
using enum Total;

constexpr std::array kMetrics{
    MetricInfo{"extrude_mm", "Extruded length", "mm", kNeither, kSum, "length of all strokes"},
    MetricInfo{"travel_mm", "Travel", "mm", kLower, kSum,
               "length of the moves without material: gaps between strokes and the way to the "
               "first stroke"},
    MetricInfo{"entry_travel_mm", "Entry travel", "mm", kLower, kSum,
               "of the travel, the way from where the layer below ended to the first stroke"},
    MetricInfo{"travels", "Travels", "", kLower, kSum, "number of moves without material"},
    MetricInfo{"retractions", "Retractions", "", kLower, kSum,
               "travels at which the printer's policy pulls the filament back"},
    MetricInfo{"crossings", "Crossings", "", kLower, kSum,
               "travels that leave the layer's polygons"},
    MetricInfo{"travel_outside_mm", "Travel outside", "mm", kLower, kSum,
               "length of the travels outside the layer's polygons"},
    MetricInfo{"max_travel_mm", "Longest travel", "mm", kLower, kMax, "the longest travel"},
    MetricInfo{"strokes", "Strokes", "", kLower, kSum,
               "runs of material without a stop, strokes that meet joined"},
    MetricInfo{"covered", "Covered", "", kHigher, kArea,
               "share of the area that is filled as the task demands"},
    MetricInfo{"skipped", "Skipped", "", kLower, kArea,
               "share of the area, inside the walls, where too little of the demanded material is "
               "laid round about"},
    MetricInfo{"worst_layer", "Worst layer", "", kLower, kMax,
               "largest share of a layer's area that was left out"},
    MetricInfo{"deposit", "Deposit", "", kNeither, kDemand,
               "deposited volume as a multiple of the demanded volume"},
    MetricInfo{"doubled", "Doubled", "", kLower, kArea,
               "share of the area that lies under two or more passes"},
    MetricInfo{
        "spilled", "Spilled", "", kLower, kArea,
        "area of beads more than half a line outside the polygons, as a share of their area"},
    MetricInfo{"outline_covered", "Outline covered", "", kHigher, kOutline,
               "share of the boundary within a line width of a stroke"},
    MetricInfo{
        "hollow_mm", "Hollow strokes", "mm", kLower, kSum,
        "length of strokes whose centre line lies outside the polygons or that are thinner than "
        "a tenth of a line"},
    MetricInfo{"sharp_turns", "Sharp turns", "", kLower, kSum,
               "turns of more than 90 degrees inside strokes"},
    MetricInfo{"filament_mm3", "Material", "mm3", kNeither, kSum, "deposited volume"},
    MetricInfo{"print_time_s", "Print time", "s", kLower, kSum,
               "time of all moves and retractions by the printer's speeds and accelerations"},
    MetricInfo{"print_extrude_s", "Extruding time", "s", kLower, kSum,
               "of the print time, while material is laid"},
    MetricInfo{"print_travel_s", "Travelling time", "s", kLower, kSum,
               "of the print time, while the nozzle travels"},
    MetricInfo{"print_retract_s", "Retracting time", "s", kLower, kSum,
               "of the print time, while the filament is pulled back, the nozzle lifted, and both "
               "undone"},
    MetricInfo{"stated_time_s", "Print time by the slicer", "s", kNeither, kCell,
               "what a foreign slicer itself says of the print time, by its own model of the "
               "printer"},
    MetricInfo{"plan_wall_ns", "Planning time", "ns", kLower, kSum,
               "time inside the planners' plan(), by the clock on the wall"},
    MetricInfo{"plan_cpu_ns", "Planning CPU time", "ns", kLower, kSum,
               "time inside the planners' plan(), of the processor"},
    MetricInfo{"peak_rss_bytes", "Peak memory", "bytes", kLower, kCell,
               "largest resident memory of the process that planned, or of the foreign slicer"},
    MetricInfo{"job_wall_s", "Whole job", "s", kLower, kCell,
               "time of a foreign slicer from its start to its end, by the clock on the wall: "
               "model read, sliced, planned, G-code written"},
    MetricInfo{"job_cpu_s", "Whole job, CPU time", "s", kLower, kCell,
               "time of a foreign slicer from its start to its end, of the processors"},
};

}  // namespace

std::span<const MetricInfo> metric_table() { return kMetrics; }

bool is_deterministic(std::string_view metric) {
  return metric != "plan_wall_ns" && metric != "plan_cpu_ns" && metric != "peak_rss_bytes" &&
         metric != "job_wall_s" && metric != "job_cpu_s";
}

std::size_t metric_index(std::string_view name) {
  const auto* const found = std::ranges::find(kMetrics, name, &MetricInfo::name);
  if (found != kMetrics.end()) return static_cast<std::size_t>(found - kMetrics.begin());
  std::vector<std::string> names;
  for (const MetricInfo& metric : kMetrics) names.emplace_back(metric.name);
  const std::optional<std::string> near = nearest_name(name, names);
  throw Error(ErrorKind::kBadUsage, "unknown metric '" + std::string(name) + "'" +
                                        (near ? "; did you mean '" + *near + "'?" : ""));
}

}  // namespace routebench
