#include "routebench/harness/judge.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

#include "judge/coverage.hpp"
#include "judge/layer_samples.hpp"
#include "judge/outline.hpp"
#include "judge/print_time.hpp"
#include "judge/run.hpp"
#include "judge/skipped.hpp"
#include "judge/strays.hpp"
#include "judge/travel.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using judging::Run;
using judging::Travel;

/// One value a metric, set by name.
class ScoreSheet {
 public:
  void set(std::string_view name, double value) { scores_.at(metric_index(name)) = value; }
  void set_count(std::string_view name, std::size_t count) {
    set(name, static_cast<double>(count));
  }
  [[nodiscard]] Scores take() && { return std::move(scores_); }

 private:
  Scores scores_ = Scores(metric_table().size());
};

/// Sets what is measured on travels. The entry, if there is one, has its length counted in any case
/// and is a travel if it is longer than join_mm.
void score_travels(ScoreSheet& sheet, const std::optional<Travel>& entry,
                   const std::vector<Travel>& between, double join_mm) {
  double length = entry ? entry->length_mm : 0;
  sheet.set("entry_travel_mm", length);
  double outside = 0;
  double longest = 0;
  std::size_t count = 0;
  std::size_t retractions = 0;
  std::size_t crossings = 0;
  const auto add = [&](const Travel& travel) {
    ++count;
    outside += travel.outside_mm;
    longest = std::max(longest, travel.length_mm);
    if (travel.retracted) ++retractions;
    if (travel.crosses) ++crossings;
  };
  if (entry && entry->length_mm > join_mm) add(*entry);
  for (const Travel& travel : between) {
    length += travel.length_mm;
    add(travel);
  }
  sheet.set("travel_mm", length);
  sheet.set("travel_outside_mm", outside);
  sheet.set("max_travel_mm", longest);
  sheet.set_count("travels", count);
  sheet.set_count("retractions", retractions);
  sheet.set_count("crossings", crossings);
}

void score_time(ScoreSheet& sheet, const std::optional<Travel>& entry, const std::vector<Run>& runs,
                const std::vector<Travel>& between, const Printer& printer) {
  std::vector<judging::Move> moves;
  std::size_t points = 1;
  for (const Run& run : runs) points += run.points.size();
  moves.reserve(points);  // one after each at most, and the entry
  const auto travel = [&moves](const Travel& way) {
    moves.push_back({way.from, way.to, false, way.retracted});
  };
  if (entry) travel(*entry);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (r > 0) travel(between[r - 1]);
    for (std::size_t i = 1; i < runs[r].points.size(); ++i)
      moves.push_back({runs[r].points[i - 1], runs[r].points[i], true, false});
  }
  const judging::PrintTime time = judging::print_time(moves, printer);
  sheet.set("print_time_s", time.extrude_s + time.travel_s + time.retract_s);
  sheet.set("print_extrude_s", time.extrude_s);
  sheet.set("print_travel_s", time.travel_s);
  sheet.set("print_retract_s", time.retract_s);
}

/// Sets what is measured along the beads; returns their volume.
double score_beads(ScoreSheet& sheet, const std::vector<Run>& runs, const Task& task) {
  double length = 0;
  double volume = 0;
  judging::visit_beads(runs, [&](Point2 a, Point2 b, double width_mm) {
    const double bead = distance(a, b);
    length += bead;
    volume += bead * task.mean_width_mm(width_mm) * task.layer_height_mm;
  });
  sheet.set("extrude_mm", length);
  sheet.set("filament_mm3", volume);
  sheet.set_count("strokes", runs.size());
  sheet.set_count("sharp_turns", judging::sharp_turns(runs));
  return volume;
}

/// Share of a layer's area that was left out: what is skipped inside the walls, or what is not
/// covered less all that is narrower than two lines and so may be hard to fill.
double left_out(const LayerScore& layer, const Demand& demand, double covered, double skipped,
                const Task& task) {
  // Narrow places explain most of the little that is usually missing; to measure them is dear.
  constexpr double kUsual = 0.1;
  if (1 - covered <= std::max(skipped, kUsual)) return skipped;
  const double wide_mm2 = area_mm2(without_thin_parts(demand.outline, 2 * task.line_width_mm));
  const double narrow = 1 - wide_mm2 / layer.area_mm2;
  return std::max(skipped, 1 - covered - narrow);
}

void score_areas(ScoreSheet& sheet, const LayerScore& layer, const Demand& demand,
                 const std::vector<Run>& runs, const std::vector<judging::Bead>& strays,
                 const Task& task) {
  if (const std::optional<double> share =
          judging::outline_covered(demand.outline, runs, task.line_width_mm))
    sheet.set("outline_covered", *share);
  const judging::LayerSamples samples(demand, task);
  const std::size_t outline_samples = samples.outline.count();
  if (outline_samples == 0) return;
  const judging::Coverage coverage =
      judging::measure_coverage(samples, outline_samples, demand, runs, strays, task);
  const double skipped = judging::skipped_area_mm2(samples, demand, runs, task) /
                         (static_cast<double>(outline_samples) * samples.grid.sample_mm2());
  sheet.set("covered", coverage.covered);
  sheet.set("doubled", coverage.doubled);
  sheet.set("spilled", coverage.spilled);
  sheet.set("skipped", skipped);
  sheet.set("worst_layer", left_out(layer, demand, coverage.covered, skipped, task));
}

double demanded_mm3(const Demand& demand, const Task& task) {
  const double walls = area_mm2(demand.outline) - area_mm2(demand.inside);
  return (walls + area_mm2(demand.dense) + task.density * area_mm2(demand.sparse)) *
         task.layer_height_mm;
}

/// What a layer weighs in the mean of its cell.
double weight(const LayerScore& layer, Total rule) {
  switch (rule) {
    case Total::kArea:
      return layer.area_mm2;
    case Total::kOutline:
      return layer.outline_mm;
    case Total::kDemand:
      return layer.demanded_mm3;
    default:
      return 1;
  }
}

std::optional<double> total_of(std::span<const LayerScore> layers, std::size_t metric) {
  const Total rule = metric_table()[metric].total;
  double sum = 0;
  double weights = 0;
  double largest = 0;
  bool any = false;
  for (const LayerScore& layer : layers) {
    const std::optional<double> value = layer.scores.at(metric);
    if (!value || rule == Total::kCell) continue;
    largest = any ? std::max(largest, *value) : *value;
    sum += weight(layer, rule) * *value;
    weights += weight(layer, rule);
    any = true;
  }
  if (!any) return std::nullopt;
  if (rule == Total::kSum) return sum;
  if (rule == Total::kMax) return largest;
  if (weights <= 0) return std::nullopt;
  return sum / weights;
}

}  // namespace

Judge::Judge(Task task, Printer printer) : task_(std::move(task)), printer_(std::move(printer)) {
  check_task(task_);
}

LayerScore Judge::score(const Layer& layer, const Demand& demand, const Route& route,
                        std::optional<Point2> previous_end) const {
  const std::vector<Run> runs = judging::runs_of(route, task_.join_mm);
  const EdgeGrid outline(demand.outline);
  LayerScore result{.layer_index = layer.index,
                    .z_mm = layer.z_mm,
                    .repaired = layer.repaired,
                    .scores = {},
                    .area_mm2 = area_mm2(demand.outline),
                    .outline_mm = perimeter_mm(demand.outline),
                    .demanded_mm3 = demanded_mm3(demand, task_),
                    .end = std::nullopt};
  if (!runs.empty()) result.end = runs.back().points.back();

  ScoreSheet sheet;
  std::optional<Travel> entry;
  if (previous_end && !runs.empty()) {
    entry = judging::travel_to(*previous_end, runs.front().points.front(), outline, printer_);
    if (entry->length_mm <= task_.join_mm) entry->retracted = false;
  }
  const std::vector<Travel> between = judging::travels_between(runs, outline, printer_);
  score_travels(sheet, entry, between, task_.join_mm);
  score_time(sheet, entry, runs, between, printer_);
  const double filament_mm3 = score_beads(sheet, runs, task_);
  if (result.demanded_mm3 > 0) sheet.set("deposit", filament_mm3 / result.demanded_mm3);
  const judging::Strays strays = judging::strays_of(runs, outline, task_.line_width_mm);
  sheet.set("hollow_mm", strays.hollow_mm);
  score_areas(sheet, result, demand, runs, strays.beads, task_);
  result.scores = std::move(sheet).take();
  return result;
}

Scores Judge::total(std::span<const LayerScore> layers) const {
  Scores totals(metric_table().size());
  for (std::size_t metric = 0; metric < totals.size(); ++metric)
    totals[metric] = total_of(layers, metric);
  return totals;
}

}  // namespace routebench
