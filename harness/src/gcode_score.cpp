#include "routebench/harness/gcode_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

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

GcodeScore score_gcode(const Judge& judge, const PreparedModel& model,
                       std::span<const std::size_t> chosen, const GcodePrint& print,
                       std::optional<Point2> offset_mm, const ParallelFor& parallel_for) {
  const std::vector<Layer>& layers = model.sliced.layers;
  GcodeScore score;
  score.pairs = pair_layers(layers, print.layers);
  score.offset_mm =
      offset_mm ? *offset_mm
                : offset_to_model(layers, print.layers, score.pairs, judge.task().line_width_mm);
  std::vector<PlannedLayer> printed(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (const std::optional<std::size_t> pair = score.pairs.file_layers[chosen[i]])
      printed[i].route = shifted(print.layers[*pair].route, score.offset_mm);
  score.cell = judge_layers(judge, model, chosen, printed, parallel_for);
  forget(score.cell, kPlanMetrics);
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
  bare.demands.resize(printed.size());
  GcodeScore score;
  score.cell = judge_layers(judge, bare, all_layers(bare.sliced), printed, parallel_for);
  forget(score.cell, kPlanMetrics);
  forget(score.cell, kOutlineMetrics);
  if (judge.printer().retract_policy == RetractPolicy::kLengthAndCrossing)
    forget(score.cell, kPolicyMetrics);
  return score;
}

}  // namespace routebench
