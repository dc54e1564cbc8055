#include "routebench/harness/gcode_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/metrics.hpp"

namespace routebench {
namespace {

/// Heights that were written as text may differ by this much more.
constexpr double kHeightToleranceMm = 1e-4;

constexpr std::array<std::string_view, 2> kPlanMetrics = {"plan_wall_ns", "plan_cpu_ns"};
constexpr std::array<std::string_view, 3> kOutlineMetrics = {"crossings", "travel_outside_mm",
                                                             "hollow_mm"};
constexpr std::array<std::string_view, 4> kPolicyMetrics = {"retractions", "print_time_s",
                                                            "print_travel_s", "print_retract_s"};

double top_mm(const Layer& layer) { return layer.z_mm + layer.height_mm / 2; }

void add_to_box(std::optional<Box2>& box, Point2 p) {
  if (!box) box = Box2{p, p};
  box->lower = {std::min(box->lower.x, p.x), std::min(box->lower.y, p.y)};
  box->upper = {std::max(box->upper.x, p.x), std::max(box->upper.y, p.y)};
}

Point2 middle(const Box2& box) { return lerp(box.lower, box.upper, 0.5); }

/// The box around a layer's walls, or around all of its strokes.
Box2 box_of(const GcodeLayer& layer) {
  std::optional<Box2> walls, all;
  for (std::size_t i = 0; i < layer.route.strokes.size(); ++i) {
    for (const Point2 p : layer.route.strokes[i].points) {
      add_to_box(all, p);
      if (layer.kinds[i] == StrokeKind::kWall) add_to_box(walls, p);
    }
  }
  return walls ? *walls : all.value_or(Box2{});
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Route shifted(const Route& route, Point2 by) {
  Route result = route;
  if (by == Point2{}) return result;
  for (Stroke& stroke : result.strokes)
    for (Point2& p : stroke.points) p = snap(p + by);
  return result;
}

/// What each stroke is for: by the file, else by where most of it lies.
std::vector<StrokeKind> kinds_of(const Route& route,
                                 const std::vector<std::optional<StrokeKind>>& told,
                                 const Demand& demand) {
  std::optional<EdgeGrid> dense, sparse;
  std::vector<StrokeKind> kinds;
  kinds.reserve(route.strokes.size());
  for (std::size_t i = 0; i < route.strokes.size(); ++i) {
    if (told[i]) {
      kinds.push_back(*told[i]);
      continue;
    }
    if (!dense) {
      dense.emplace(demand.dense);
      sparse.emplace(demand.sparse);
    }
    double length_mm = 0, dense_mm = 0, sparse_mm = 0;
    const std::vector<Point2>& points = route.strokes[i].points;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double piece_mm = distance(points[k - 1], points[k]);
      length_mm += piece_mm;
      dense_mm += piece_mm - dense->outside_length_mm(points[k - 1], points[k]);
      sparse_mm += piece_mm - sparse->outside_length_mm(points[k - 1], points[k]);
    }
    const double wall_mm = length_mm - dense_mm - sparse_mm;
    kinds.push_back(wall_mm >= std::max(dense_mm, sparse_mm) ? StrokeKind::kWall
                    : dense_mm >= sparse_mm                  ? StrokeKind::kDense
                                                             : StrokeKind::kSparse);
  }
  return kinds;
}

/// Which layers of a file have no place on the model, in one line.
std::string unpaired_text(const GcodePrint& print, const LayerPairs& pairs) {
  if (pairs.unpaired.empty()) return {};
  return std::to_string(pairs.unpaired.size()) + " of " + std::to_string(print.layers.size()) +
         " layers of the G-code are none of the model's, the first at z = " +
         to_string(ParamValue(print.layers[pairs.unpaired.front()].z_mm)) + " mm";
}

/// A volume as a message shows it.
std::string rounded(double mm3) { return to_string(ParamValue(std::round(1e3 * mm3) / 1e3)); }

/// Whether a file's E tells another story than its marks, in one line.
std::string contradiction_text(const PlacedPrint& placed, const GateLimits& gate) {
  if (!placed.marked_mm3) return {};
  const double by_marks_mm3 = *placed.marked_mm3;
  if (placed.filament_mm3 >= gate.deposit_min * by_marks_mm3 &&
      placed.filament_mm3 <= gate.deposit_max * by_marks_mm3)
    return {};
  return "its E makes " + rounded(placed.filament_mm3) + " mm3 of material, its marks of widths " +
         rounded(by_marks_mm3) + " mm3";
}

/// Takes metrics out of a cell's scores.
void forget(JudgedCell& cell, std::span<const std::string_view> metrics) {
  for (const std::string_view metric : metrics) {
    const std::size_t place = metric_index(metric);
    for (LayerScore& layer : cell.layers) layer.scores[place].reset();
    cell.totals[place].reset();
  }
}

}  // namespace

std::size_t LayerPairs::count(std::span<const std::size_t> places) const {
  return static_cast<std::size_t>(
      std::count_if(places.begin(), places.end(),
                    [this](std::size_t place) { return file_layers[place].has_value(); }));
}

LayerPairs pair_layers(std::span<const Layer> model, std::span<const GcodeLayer> file) {
  LayerPairs pairs;
  pairs.file_layers.resize(model.size());
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < file.size(); ++i) {
    const auto off_mm = [&](std::size_t layer, std::size_t of) {
      return std::abs(top_mm(model[layer]) - file[of].z_mm);
    };
    while (nearest + 1 < model.size() && off_mm(nearest + 1, i) < off_mm(nearest, i)) ++nearest;
    if (model.empty() || off_mm(nearest, i) > model[nearest].height_mm / 2 + kHeightToleranceMm) {
      pairs.unpaired.push_back(i);
      continue;
    }
    std::optional<std::size_t>& pair = pairs.file_layers[nearest];
    if (!pair) {
      pair = i;
    } else if (off_mm(nearest, i) < off_mm(nearest, *pair)) {
      pairs.unpaired.push_back(*pair);
      pair = i;
    } else {
      pairs.unpaired.push_back(i);
    }
  }
  return pairs;
}

std::optional<std::string> misplaced_in_z(std::span<const Layer> model,
                                          std::span<const GcodeLayer> file) {
  if (model.empty() || file.empty()) return std::nullopt;
  const double above_mm = file.front().z_mm - top_mm(model.front());
  if (std::abs(above_mm) <= model.front().height_mm / 2 + kHeightToleranceMm) return std::nullopt;
  const double shown_mm = std::round(std::abs(above_mm) * 1000) / 1000;
  return "its lowest layer lies " + to_string(ParamValue(shown_mm)) +
         (above_mm > 0 ? " mm above" : " mm below") +
         " the model's; --z-offset takes a raft's height or the printer's own offset away";
}

Point2 offset_to_model(std::span<const Layer> model, std::span<const GcodeLayer> file,
                       const LayerPairs& pairs, double line_width_mm) {
  std::vector<double> x_mm, y_mm;
  for (std::size_t i = 0; i < model.size(); ++i) {
    if (!pairs.file_layers[i] || model[i].polygons.empty()) continue;
    const Point2 shift =
        middle(bounding_box(model[i].polygons)) - middle(box_of(file[*pairs.file_layers[i]]));
    x_mm.push_back(shift.x);
    y_mm.push_back(shift.y);
  }
  if (x_mm.empty()) return {};
  const Point2 shift{median(std::move(x_mm)), median(std::move(y_mm))};
  if (std::max(std::abs(shift.x), std::abs(shift.y)) < line_width_mm / 2) return {};
  return snap(shift);
}

PlacedPrint place_print(const GcodePrint& print, const PreparedModel& model,
                        std::span<const std::size_t> chosen, std::optional<Point2> offset_mm,
                        double line_width_mm, const ParallelFor& parallel_for) {
  const std::vector<Layer>& layers = model.sliced.layers;
  PlacedPrint placed;
  placed.pairs = pair_layers(layers, print.layers);
  placed.offset_mm =
      offset_mm ? *offset_mm : offset_to_model(layers, print.layers, placed.pairs, line_width_mm);
  placed.unpaired = unpaired_text(print, placed.pairs);
  placed.stated_time_s = print.stated_time_s;
  placed.filament_mm3 = print.filament_mm3;
  if (print.filament_is_known) placed.marked_mm3 = print.marked_mm3;
  placed.layers.resize(chosen.size());
  parallel_for(chosen.size(), [&](std::size_t i) {
    const std::optional<std::size_t> pair = placed.pairs.file_layers[chosen[i]];
    if (!pair) return;
    const GcodeLayer& layer = print.layers[*pair];
    placed.layers[i].route = shifted(layer.route, placed.offset_mm);
    placed.layers[i].kinds =
        kinds_of(placed.layers[i].route, layer.kinds, *model.demands[chosen[i]]);
  });
  return placed;
}

JudgedCell judge_print(const Judge& judge, const PreparedModel& model,
                       std::span<const std::size_t> chosen, const PlacedPrint& placed,
                       const ParallelFor& parallel_for) {
  JudgedCell cell = judge_layers(judge, model, chosen, placed.layers, parallel_for);
  forget(cell, kPlanMetrics);
  cell.totals.at(metric_index("stated_time_s")) = placed.stated_time_s;
  for (const std::string& complaint :
       {placed.unpaired, contradiction_text(placed, judge.task().gate)}) {
    if (complaint.empty()) continue;
    cell.verdict.outcome = Outcome::kOffTask;
    std::string& reason = cell.verdict.reason;
    reason += (reason.empty() ? "" : "; ") + complaint;
  }
  return cell;
}

GcodeScore score_gcode(const Judge& judge, const PreparedModel& model,
                       std::span<const std::size_t> chosen, const GcodePrint& print,
                       std::optional<Point2> offset_mm, const ParallelFor& parallel_for) {
  PlacedPrint placed =
      place_print(print, model, chosen, offset_mm, judge.task().line_width_mm, parallel_for);
  GcodeScore score;
  score.cell = judge_print(judge, model, chosen, placed, parallel_for);
  score.pairs = std::move(placed.pairs);
  score.offset_mm = placed.offset_mm;
  return score;
}

GcodeScore score_gcode(const Judge& judge, const GcodePrint& print,
                       const ParallelFor& parallel_for) {
  PreparedModel bare;
  std::vector<PlannedLayer> printed;
  for (const GcodeLayer& layer : print.layers) {
    bare.sliced.layers.push_back({.index = static_cast<int>(printed.size()),
                                  .z_mm = layer.z_mm - layer.height_mm / 2,
                                  .height_mm = layer.height_mm,
                                  .polygons = {},
                                  .solid = {}});
    printed.push_back({layer.route, {}});
  }
  bare.demands.resize(printed.size(), std::make_shared<const Demand>());
  GcodeScore score;
  score.cell = judge_layers(judge, bare, all_layers(bare.sliced), printed, parallel_for);
  score.cell.totals.at(metric_index("stated_time_s")) = print.stated_time_s;
  forget(score.cell, kPlanMetrics);
  forget(score.cell, kOutlineMetrics);
  if (judge.printer().retract_policy == RetractPolicy::kLengthAndCrossing)
    forget(score.cell, kPolicyMetrics);
  return score;
}

}  // namespace routebench
