#include "gcode/layer_text.hpp"

#include <array>
#include <ostream>
#include <utility>

#include "gcode/near_boundary.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/judge.hpp"

namespace routebench {
namespace {

/// Room for any line but a type's mark: some numbers, each with a letter.
constexpr std::size_t kLongestLine = 8 * kLongestNumber;

constexpr std::array<std::string_view, 4> kTypeNames = {"External perimeter", "Perimeter",
                                                        "Solid infill", "Internal infill"};

Point2 middle_of_longest_segment(const Stroke& stroke) {
  double longest = -1;
  Point2 middle{};
  for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
    const double length = squared_distance(stroke.points[i], stroke.points[i + 1]);
    if (length <= longest) continue;
    longest = length;
    middle = lerp(stroke.points[i], stroke.points[i + 1], 0.5);
  }
  return middle;
}

}  // namespace

LayerText::LayerText(const Task& task, const Printer& printer, const GcodeDialect& dialect,
                     const GcodeProgress& before, const Layer& layer, std::vector<LayerPart> parts)
    : task_(task),
      printer_(printer),
      dialect_(dialect),
      layer_(layer),
      before_(before),
      parts_(std::move(parts)),
      layer_z_mm_(height_mm(layer)) {}

void LayerText::make_part_texts() {
  look();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i].makes_text) continue;
    const Stroke& first = parts_[i].strokes.front();
    nozzle_ = first.points[1];
    z_mm_ = layer_z_mm_;
    marks_ = {printer_.extrude_mm_s, types_[i].front(), first.width_mm};
    write_after_first_move(i, 0);
    PartText& made = *parts_[i].text;
    made.text = text_.take();
    made.first_type = types_[i].front();
    made.marks_after = marks_;
  }
}

void LayerText::format() {
  look();
  nozzle_ = before_.nozzle;
  z_mm_ = before_.z_mm;
  marks_ = {};
  filament_ = {before_.filament, before_.filament_units};
  if (!nozzle_) approach(parts_.front().strokes.front().points.front());
  mark_layer();
  if (before_.layers == 1) line("M106 S255");
  for (std::size_t i = 0; i < parts_.size(); ++i) write_part(i);
}

void LayerText::write(std::ostream& out) const {
  const auto put = [&out](std::string_view text) {
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
  };
  const std::string_view own = text_.view();
  std::size_t written = 0;
  for (const Copy& copy : copies_) {
    put(own.substr(written, copy.place - written));
    put(copy.text->text);
    written = copy.place;
  }
  put(own.substr(written));
}

void LayerText::look() {
  if (std::exchange(has_looked_, true)) return;
  if (printer_.retract_policy == RetractPolicy::kLengthAndCrossing)
    outline_.emplace(layer_.polygons);
  find_types();
}

void LayerText::find_types() {
  types_.resize(parts_.size());
  std::vector<MoveType*> walls;
  std::vector<NearQuery> middles;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const LayerPart& part = parts_[i];
    if (part.text && !part.makes_text) continue;
    types_[i].resize(part.strokes.size());
    for (std::size_t k = 0; k < part.strokes.size(); ++k) {
      const Stroke& stroke = part.strokes[k];
      types_[i][k] =
          part.kinds[k] == StrokeKind::kDense ? MoveType::kSolidInfill : MoveType::kInternalInfill;
      if (part.kinds[k] != StrokeKind::kWall) continue;
      // The outermost wall runs half a line inside the outline, the next one a spacing further in;
      // corners are misleading, the middle of a straight piece is not.
      walls.push_back(&types_[i][k]);
      middles.push_back(
          {middle_of_longest_segment(stroke), (stroke.width_mm + task_.spacing_mm()) / 2});
    }
  }
  if (walls.empty()) return;
  const std::vector<bool> outermost = near_boundary(layer_.polygons, middles);
  for (std::size_t i = 0; i < walls.size(); ++i)
    *walls[i] = outermost[i] ? MoveType::kExternalPerimeter : MoveType::kPerimeter;
}

void LayerText::write_part(std::size_t i) {
  const LayerPart& part = parts_[i];
  const Stroke& first = part.strokes.front();
  travel(first.points.front());
  mark_stroke(part.text ? *part.text->first_type : types_[i].front(), first.width_mm);
  FilamentCounter filament(task_, printer_, dialect_.volumetric, filament_);
  extrude(first, 1, 2, filament, 0);
  filament_ = filament.filament();
  if (part.text) {
    copies_.push_back({text_.view().size(), part.text});
    marks_ = part.text->marks_after;
    nozzle_ = part.strokes.back().points.back();
    filament_ += part.text->filament;
  } else {
    filament_ += write_after_first_move(i, filament_.units);
  }
}

Filament LayerText::write_after_first_move(std::size_t i, std::int64_t units_before) {
  const std::span<const Stroke> strokes = parts_[i].strokes;
  FilamentCounter filament(task_, printer_, dialect_.volumetric, {});
  extrude(strokes[0], 2, strokes[0].points.size(), filament, units_before);
  for (std::size_t k = 1; k < strokes.size(); ++k) {
    travel(strokes[k].points.front());
    mark_stroke(types_[i][k], strokes[k].width_mm);
    extrude(strokes[k], 1, strokes[k].points.size(), filament, units_before);
  }
  return filament.filament();
}

void LayerText::approach(Point2 first) {
  move_to_height(layer_z_mm_);
  begin_line("G0");
  put_place(first);
  end_move(printer_.travel_mm_s);
  nozzle_ = first;
}

void LayerText::mark_layer() {
  line(";LAYER_CHANGE");
  mark(";Z:", layer_z_mm_, kHeightDecimals);
  mark(";HEIGHT:", layer_.height_mm, kHeightDecimals);
}

void LayerText::mark_stroke(MoveType type, double width_mm) {
  if (marks_.type != type) line(";TYPE:", kTypeNames[static_cast<std::size_t>(type)]);
  marks_.type = type;
  if (marks_.width_mm != width_mm) mark(";WIDTH:", width_mm, kGridDecimals);
  marks_.width_mm = width_mm;
}

void LayerText::travel(Point2 to) {
  const double gap_mm = distance(*nozzle_, to);
  const bool retracting =
      gap_mm > task_.join_mm &&
      retracts(printer_, *nozzle_, to, outline_ ? outline_->outside_length_mm(*nozzle_, to) : 0);
  if (retracting) pull_back();
  move_to_height(layer_z_mm_ + (retracting ? printer_.lift_mm : 0));
  if (!written_alike(*nozzle_, to)) {
    begin_line("G0");
    put_place(to);
    end_move(printer_.travel_mm_s);
  }
  move_to_height(layer_z_mm_);
  if (retracting) push_again();
  nozzle_ = to;
}

void LayerText::extrude(const Stroke& stroke, std::size_t begin, std::size_t end,
                        FilamentCounter& filament, std::int64_t units_before) {
  filament.count(stroke, begin, end, [&](Point2 to, std::int64_t units, std::int64_t all_units) {
    begin_line("G1");
    put_place(to);
    text_.put(" E");
    text_.put_number(dialect_.volumetric ? units_before + all_units : units, kFilamentDecimals);
    end_move(printer_.extrude_mm_s);
  });
  nozzle_ = stroke.points[end - 1];
}

void LayerText::pull_back() {
  if (dialect_.volumetric)
    line("G10");
  else
    move_filament(-printer_.retract_mm);
}

void LayerText::push_again() {
  if (dialect_.volumetric)
    line("G11");
  else
    move_filament(printer_.retract_mm);
}

void LayerText::move_filament(double mm) {
  const std::int64_t units = to_units(mm, kFilamentDecimals);
  if (units == 0) return;
  begin_line("G1 E");
  text_.put_number(units, kFilamentDecimals);
  end_move(printer_.retract_mm_s);
}

void LayerText::move_to_height(double z_mm) {
  if (z_mm_ == z_mm) return;
  begin_line("G1 Z");
  text_.put_number(to_units(z_mm, kHeightDecimals), kHeightDecimals);
  end_move(printer_.travel_mm_s);
  z_mm_ = z_mm;
}

void LayerText::begin_line(std::string_view word) {
  text_.make_room(kLongestLine);
  text_.put(word);
}

void LayerText::put_place(Point2 p) {
  const WrittenPlace place = written(p);
  text_.put(" X");
  text_.put_number(place.x, kGridDecimals);
  text_.put(" Y");
  text_.put_number(place.y, kGridDecimals);
}

void LayerText::end_move(double speed_mm_s) {
  if (marks_.speed_mm_s != speed_mm_s) {
    text_.put(" F");
    text_.put_number(to_units(60 * speed_mm_s, kSpeedDecimals), kSpeedDecimals);
    marks_.speed_mm_s = speed_mm_s;
  }
  text_.put('\n');
}

void LayerText::mark(std::string_view name, double value, int decimals) {
  begin_line(name);
  text_.put_number(to_units(value, decimals), decimals);
  text_.put('\n');
}

void LayerText::line(std::string_view text, std::string_view more) {
  text_.make_room(text.size() + more.size() + 1);
  text_.put(text);
  text_.put(more);
  text_.put('\n');
}

}  // namespace routebench
