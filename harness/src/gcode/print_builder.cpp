#include "gcode/print_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gcode/stroke_types.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/task.hpp"

namespace routebench::gcode {
namespace {

/// Heights that differ by no more than this are one layer.
constexpr double kSameHeightMm = 0.005;
/// A climb that is none, only rounding.
constexpr double kLevelMm = 1e-6;

/// E as it was written: one of the two is 0 unless the file changes its mind in between.
double amount(const Filament& filament) { return filament.length_mm + filament.volume_mm3; }

Filament& operator+=(Filament& sum, const Filament& more) {
  sum.length_mm += more.length_mm;
  sum.volume_mm3 += more.volume_mm3;
  return sum;
}

/// The inverse of mean_bead_width_mm, from the section.
double width_of_bead(double section_mm2, double height_mm) {
  constexpr double kQuarterPi = std::numbers::pi / 4;
  const double mean_mm = section_mm2 / height_mm;
  return mean_mm >= height_mm * kQuarterPi ? mean_mm + height_mm * (1 - kQuarterPi)
                                           : mean_mm / kQuarterPi;
}

}  // namespace

void PrintBuilder::mark_layer() {
  if (!layer_marks_) drop_priming();
  layer_marks_ = layer_height_open_ = true;
  stroke_open_ = false;
  spiral_from_z_mm_.reset();
}

void PrintBuilder::mark_type(std::string_view name) {
  type_marks_ = true;
  const std::optional<StrokeType> type = stroke_type(name);
  if (!type) ++unknown_[std::string(name)];
  type_ = type.value_or(StrokeType{});
}

void PrintBuilder::mark_width(std::optional<double> width_mm) { width_mark_mm_ = width_mm; }

void PrintBuilder::mark_height(double height_mm) {
  height_mark_mm_ = height_mm;
  if (layer_marks_ && !layer_height_open_) return;
  layer_height_mark_mm_ = height_mm;
  layer_height_open_ = false;
}

/// The width that the strokes have by their mark. A stroke of another height than its layer's, a
/// bridge, has none: what it would mean in this layer follows from its volume.
std::optional<double> PrintBuilder::width_mm() const {
  return height_mark_mm_ == layer_height_mark_mm_ ? width_mark_mm_ : std::nullopt;
}

void PrintBuilder::ignore(std::string_view command) { ++print_.ignored[std::string(command)]; }

void PrintBuilder::travel(double length_mm) {
  waiting_travel_mm_ += length_mm;
  stroke_open_ = excluded_open_ = climbing_ = false;
}

void PrintBuilder::pull() {
  ++waiting_pulls_;
  stroke_open_ = excluded_open_ = climbing_ = false;
}

void PrintBuilder::bead(const Bead& bead, const Place& place) {
  if (type_.excluded) {
    exclude(bead);
    return;
  }
  if (!layers_.empty()) {
    print_.travel_mm += waiting_travel_mm_;
    print_.retractions += waiting_pulls_;
  }
  waiting_travel_mm_ = 0;
  waiting_pulls_ = 0;
  excluded_open_ = false;
  enter_layer(bead);
  const double length_mm = distance(bead.from, bead.to);
  if (!stroke_open_ || !fits_stroke(bead, length_mm)) begin_stroke(bead.from, place);
  RawLayer& layer = layers_[layer_];
  layer.layer.route.strokes.back().points.push_back(bead.to);
  layer.bodies.back().filament += bead.filament;
  layer.bodies.back().length_mm += length_mm;
  pushed_ += bead.filament;
}

void PrintBuilder::exclude(const Bead& bead) {
  if (!excluded_open_) ++print_.excluded_strokes;
  excluded_open_ = true;
  stroke_open_ = climbing_ = false;
  print_.excluded_mm += distance(bead.from, bead.to);
}

void PrintBuilder::enter_layer(const Bead& bead) {
  const bool climbs = std::abs(bead.to_z_mm - bead.from_z_mm) > kLevelMm;
  if (climbs || climbing_) {
    enter_spiral(bead);
    return;
  }
  const double z_mm = bead.to_z_mm;
  const bool spiral = spiral_from_z_mm_.has_value();
  if (layer_ != kNone && !spiral && std::abs(layers_[layer_].z_mm - z_mm) <= kSameHeightMm) return;
  spiral_from_z_mm_.reset();
  stroke_open_ = false;
  if (!layer_of_z_.empty() && z_mm < layer_of_z_.rbegin()->first - kSameHeightMm) returned_ = true;
  const auto found = layer_of_z_.lower_bound(z_mm - kSameHeightMm);
  if (found != layer_of_z_.end() && found->first <= z_mm + kSameHeightMm) {
    layer_ = found->second;
    return;
  }
  layer_ = layers_.size();
  layer_of_z_.emplace(z_mm, layer_);
  layers_.push_back({z_mm, layer_height_mark_mm_, {}, {}});
}

void PrintBuilder::enter_spiral(const Bead& bead) {
  const double height_mm = layer_height_mark_mm_.value_or(options_.layer_height_mm);
  const bool goes_on = spiral_from_z_mm_ &&
                       (layer_marks_ || bead.to_z_mm - *spiral_from_z_mm_ <= height_mm + kLevelMm);
  if (!goes_on) {
    layer_ = layers_.size();
    layers_.push_back({bead.to_z_mm, height_mm, {}, {}});
    spiral_from_z_mm_ = bead.from_z_mm;
    stroke_open_ = false;
  }
  climbing_ = true;
  layers_[layer_].z_mm = std::max(layers_[layer_].z_mm, bead.to_z_mm);
}

/// True if a bead has the kind and the width of the last stroke.
bool PrintBuilder::fits_stroke(const Bead& bead, double length_mm) const {
  const RawLayer& layer = layers_[layer_];
  if (layer.layer.kinds.back() != type_.kind ||
      layer.layer.route.strokes.back().width_mm != width_mm().value_or(0))
    return false;
  if (width_mm()) return true;
  constexpr double kSameShare = 0.02;
  constexpr double kRounding = 1.5e-4;  // of E with four decimals, at both ends
  const Body& body = layer.bodies.back();
  const double expected = amount(body.filament) / body.length_mm * length_mm;
  return std::abs(amount(bead.filament) - expected) <= kSameShare * expected + kRounding;
}

void PrintBuilder::begin_stroke(Point2 from, const Place& place) {
  RawLayer& layer = layers_[layer_];
  // A width that follows from E is set when all of the stroke and the layer's height are known.
  layer.layer.route.strokes.push_back({{from}, width_mm().value_or(0)});
  layer.layer.kinds.push_back(type_.kind);
  layer.bodies.push_back({{}, 0, place.line});
  stroke_open_ = true;
}

void PrintBuilder::drop_priming() {
  for (const RawLayer& layer : layers_) {
    print_.excluded_strokes += layer.bodies.size();
    for (const Body& body : layer.bodies) print_.excluded_mm += body.length_mm;
  }
  layers_.clear();
  layer_of_z_.clear();
  layer_ = kNone;
  pushed_ = {};
  print_.retractions = 0;
  print_.travel_mm = 0;
  returned_ = climbing_ = false;
}

double PrintBuilder::volume_mm3(const Filament& filament) const {
  if (volumetric_e_) return amount(filament);
  const double diameter_mm = filament_mm_.value_or(options_.filament_mm);
  return filament.volume_mm3 +
         filament.length_mm * diameter_mm * diameter_mm * std::numbers::pi / 4;
}

void PrintBuilder::set_heights() {
  // A step that is much larger than a layer spans a gap between parts. Layers of just that height,
  // such as 0.3 mm where 0.2 mm is expected, must not be told apart by the rounding of their z.
  constexpr double kHighest = 1.5;
  const double highest_mm = kHighest * options_.layer_height_mm + kSameHeightMm;
  double below_mm = 0;
  for (RawLayer& layer : layers_) {
    const double step_mm = layer.z_mm - std::exchange(below_mm, layer.z_mm);
    layer.layer.z_mm = layer.z_mm;
    if (layer.height_mm) {
      layer.layer.height_mm = *layer.height_mm;
    } else if (step_mm > kLevelMm && step_mm <= highest_mm) {
      layer.layer.height_mm = step_mm;
    } else {
      layer.layer.height_mm = options_.layer_height_mm;
      if (guessed_heights_++ == 0) first_guessed_z_mm_ = layer.z_mm;
      if (&layer == &layers_.front()) guesses_bed_layer_ = true;
    }
  }
}

void PrintBuilder::set_widths(RawLayer& layer, Place place) {
  constexpr double kNarrowestMm = 1e-6;
  constexpr double kWidestMm = 1000;
  for (std::size_t i = 0; i < layer.bodies.size(); ++i) {
    const Body& body = layer.bodies[i];
    double& width_mm = layer.layer.route.strokes[i].width_mm;
    if (width_mm > 0) {
      const double height_mm = layer.layer.height_mm;
      print_.marked_mm3 += mean_bead_width_mm(width_mm, height_mm) * height_mm * body.length_mm;
      continue;
    }
    print_.marked_mm3 += volume_mm3(body.filament);
    place.line = body.line;
    width_mm = std::max(kNarrowestMm, width_of_bead(volume_mm3(body.filament) / body.length_mm,
                                                    layer.layer.height_mm));
    if (!(width_mm <= kWidestMm))
      place.refuse("so much is extruded that the bead is over 1 m wide");
  }
}

void PrintBuilder::warn() {
  std::vector<std::string>& warnings = print_.warnings;
  if (returned_)
    warnings.emplace_back(
        "goes back to lower layers (parts printed one by one?); it is judged layer by layer");
  // Gaps here and there do no harm: the other layers show what height is usual.
  if (guesses_bed_layer_ || 2 * guessed_heights_ > layers_.size())
    warnings.push_back("the steps of Z do not tell the height of " +
                       std::to_string(guessed_heights_) + " of " + std::to_string(layers_.size()) +
                       " layers, the first at z = " + to_string(ParamValue(first_guessed_z_mm_)) +
                       " mm: it is taken from layer_height_mm = " +
                       to_string(ParamValue(options_.layer_height_mm)));
  constexpr std::size_t kMostTypes = 10;
  std::size_t shown = 0;
  for (const auto& [name, count] : unknown_) {
    if (shown++ == kMostTypes) break;
    warnings.push_back("unknown type '" + name + "', " + std::to_string(count) +
                       " times; its strokes count as part of the model");
  }
  if (unknown_.size() > kMostTypes)
    warnings.push_back(std::to_string(unknown_.size()) + " unknown types in all");
  if (filaments_differ_)
    warnings.emplace_back(
        "its tools have filaments of different diameters; volumes are those of the first");
  if (!type_marks_) warnings.emplace_back("no type marks: all strokes count as part of the model");
}

GcodePrint PrintBuilder::finish(const Place& end) {
  if (layers_.empty())
    throw Error(ErrorKind::kBadInput,
                end.name + ": lays no material" +
                    (print_.excluded_strokes > 0
                         ? " that is part of a model"
                         : ": no move in X or Y has a word E that pushes filament"));
  std::stable_sort(layers_.begin(), layers_.end(),
                   [](const RawLayer& a, const RawLayer& b) { return a.z_mm < b.z_mm; });
  print_.z_offset_mm = options_.z_offset_mm;
  for (RawLayer& layer : layers_) layer.z_mm += options_.z_offset_mm;
  set_heights();
  for (RawLayer& layer : layers_) {
    set_widths(layer, end);
    print_.layers.push_back(std::move(layer.layer));
  }
  print_.filament_mm3 = volume_mm3(pushed_);
  print_.filament_is_known = !filaments_differ_;
  print_.lines = end.line;
  warn();
  return std::move(print_);
}

}  // namespace routebench::gcode
