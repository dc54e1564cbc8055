#include "routebench/harness/gcode_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>
#include <utility>
#include <vector>

#include "fixed_point.hpp"
#include "gcode/near_boundary.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/version.hpp"

namespace routebench {
namespace {

constexpr int kFilamentDecimals = 5;
constexpr int kHeightDecimals = 5;
constexpr int kSpeedDecimals = 3;
constexpr double kEndLiftMm = 5;

constexpr std::array<std::string_view, 4> kTypeNames = {"External perimeter", "Perimeter",
                                                        "Solid infill", "Internal infill"};

}  // namespace

/// What tells the flavours apart.
struct GcodeDialect {
  std::string_view flavour;
  bool volumetric;  ///< E is absolute and counts mm3; the printer itself knows how to retract
  std::string_view head;
  std::string_view fan_off;
  std::string_view end;
};

namespace {

constexpr std::array<GcodeDialect, 4> kDialects = {{
    {"marlin", false, "", "M107", "M84 ; motors off"},
    {"klipper", false, "", "M107", "M84 ; motors off"},
    {"reprap", false, "", "M106 S0", "M84 ; motors off"},
    {"ultigcode", true, ";FLAVOR:UltiGCode", "M107", ""},
}};

const GcodeDialect& dialect_of(const std::string& flavour) {
  std::string known;
  for (const GcodeDialect& dialect : kDialects) {
    if (dialect.flavour == flavour) return dialect;
    known += (known.empty() ? "" : ", ") + std::string(dialect.flavour);
  }
  throw Error(ErrorKind::kBadInput,
              "printer: flavour = '" + flavour + "' cannot be written; it must be one of " + known);
}

/// Where a coordinate is on the paper.
struct WrittenPlace {
  std::int64_t x;
  std::int64_t y;
  friend bool operator==(const WrittenPlace&, const WrittenPlace&) = default;
};
WrittenPlace written(Point2 p) {
  return {to_units(p.x, kGridDecimals), to_units(p.y, kGridDecimals)};
}
/// Whether a move vanishes in rounding.
bool written_alike(Point2 a, Point2 b) {
  constexpr double kApartMm = 1e-6;  // ten units
  if (std::abs(a.x - b.x) > kApartMm || std::abs(a.y - b.y) > kApartMm) return false;
  return written(a) == written(b);
}

/// Counts what strokes need of the filament.
class FilamentCounter {
 public:
  FilamentCounter(const Task& task, const Printer& printer, const GcodeDialect& dialect,
                  double length, std::int64_t units)
      : task_(task),
        section_mm2_(dialect.volumetric
                         ? 1
                         : std::numbers::pi / 4 * printer.filament_mm * printer.filament_mm),
        length_(length),
        units_(units) {}

  /// Calls visit(end of the move, units for it, units in all) for every move of a stroke.
  template <typename Visit>
  void count(const Stroke& stroke, Visit&& visit) {
    const double share =
        task_.mean_width_mm(stroke.width_mm) * task_.layer_height_mm / section_mm2_;
    for (std::size_t i = 1; i < stroke.points.size(); ++i) {
      const Point2 from = stroke.points[i - 1];
      const Point2 to = stroke.points[i];
      length_ += share * distance(from, to);
      if (written_alike(from, to)) continue;
      // A move that extrudes says so, however short it is; the sum catches up with the next moves.
      const std::int64_t units =
          std::max<std::int64_t>(1, to_units(length_, kFilamentDecimals) - units_);
      units_ += units;
      visit(to, units, units_);
    }
  }

  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] std::int64_t units() const noexcept { return units_; }

 private:
  const Task& task_;
  double section_mm2_;  // of the filament; 1 where it is counted in mm3
  double length_;       // mm or mm3
  std::int64_t units_;
};

/// A text that grows by pieces of bounded length, without asking for room at every number.
class TextBuffer {
 public:
  /// Makes room for so many more characters to be put.
  void make_room(std::size_t count) {
    if (text_.size() - used_ < count) text_.resize(std::max(2 * text_.size(), used_ + count));
  }
  void put(char c) { text_[used_++] = c; }
  void put(std::string_view piece) {
    piece.copy(text_.data() + used_, piece.size());
    used_ += piece.size();
  }
  void put_number(std::int64_t units, int decimals) {
    used_ =
        static_cast<std::size_t>(put_units(text_.data() + used_, units, decimals) - text_.data());
  }
  [[nodiscard]] std::string take() && {
    text_.resize(used_);
    return std::move(text_);
  }

 private:
  std::string text_;
  std::size_t used_ = 0;
};

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

/// The text of one layer, or of the end block. It knows what is before it, so that layers can be
/// formatted in any order.
class LayerText {
 public:
  LayerText(const Task& task, const Printer& printer, const GcodeDialect& dialect,
            const GcodeProgress& before)
      : task_(task),
        printer_(printer),
        dialect_(dialect),
        before_(before),
        filament_(task, printer, dialect, before.filament, before.filament_units),
        nozzle_(before.nozzle),
        z_mm_(before.z_mm) {}

  [[nodiscard]] std::string layer(const Layer& layer, const PlannedLayer& planned) && {
    layer_z_mm_ = height_mm(layer);
    if (printer_.retract_policy == RetractPolicy::kLengthAndCrossing)
      outline_.emplace(layer.polygons);
    const std::vector<Type> types = types_of(layer, planned);
    if (!nozzle_) approach(planned.route.strokes.front().points.front());
    mark_layer(layer);
    if (before_.layers == 1) line("M106 S255");
    for (std::size_t i = 0; i < planned.route.strokes.size(); ++i) {
      const Stroke& stroke = planned.route.strokes[i];
      travel(stroke.points.front());
      mark_stroke(types[i], stroke.width_mm);
      extrude(stroke);
    }
    return std::move(text_).take();
  }

  [[nodiscard]] std::string end() && {
    line("; end of the print");
    if (z_mm_) move_to_height(*z_mm_ + kEndLiftMm);
    line(dialect_.fan_off);
    if (!dialect_.end.empty()) line(dialect_.end);
    return std::move(text_).take();
  }

  /// Of the nozzle while it prints a layer: layers are cut at half their height.
  [[nodiscard]] static double height_mm(const Layer& layer) {
    return layer.z_mm + layer.height_mm / 2;
  }

 private:
  enum class Type { kExternalPerimeter, kPerimeter, kSolidInfill, kInternalInfill };

  /// Room for any line but a type's mark: some numbers, each with a letter.
  static constexpr std::size_t kLongestLine = 8 * kLongestNumber;

  /// Of each stroke.
  [[nodiscard]] std::vector<Type> types_of(const Layer& layer, const PlannedLayer& planned) const {
    const std::vector<Stroke>& strokes = planned.route.strokes;
    std::vector<Type> types;
    std::vector<std::size_t> walls;
    std::vector<NearQuery> middles;
    for (std::size_t i = 0; i < strokes.size(); ++i) {
      types.push_back(planned.kinds[i] == StrokeKind::kDense ? Type::kSolidInfill
                                                             : Type::kInternalInfill);
      if (planned.kinds[i] != StrokeKind::kWall) continue;
      // The outermost wall runs half a line inside the outline, the next one a spacing further in;
      // corners are misleading, the middle of a straight piece is not.
      walls.push_back(i);
      middles.push_back(
          {middle_of_longest_segment(strokes[i]), (strokes[i].width_mm + task_.spacing_mm()) / 2});
    }
    const std::vector<bool> outermost = near_boundary(layer.polygons, middles);
    for (std::size_t i = 0; i < walls.size(); ++i)
      types[walls[i]] = outermost[i] ? Type::kExternalPerimeter : Type::kPerimeter;
    return types;
  }

  void approach(Point2 first) {
    move_to_height(layer_z_mm_);
    begin_line("G0");
    put_place(first);
    end_move(printer_.travel_mm_s);
    nozzle_ = first;
  }

  void mark_layer(const Layer& layer) {
    line(";LAYER_CHANGE");
    mark(";Z:", layer_z_mm_, kHeightDecimals);
    mark(";HEIGHT:", layer.height_mm, kHeightDecimals);
  }

  void mark_stroke(Type type, double width_mm) {
    if (type_ != type) line(";TYPE:", kTypeNames[static_cast<std::size_t>(type)]);
    type_ = type;
    if (width_mm_ != width_mm) mark(";WIDTH:", width_mm, kGridDecimals);
    width_mm_ = width_mm;
  }

  void travel(Point2 to) {
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

  void extrude(const Stroke& stroke) {
    filament_.count(stroke, [this](Point2 to, std::int64_t units, std::int64_t all_units) {
      begin_line("G1");
      put_place(to);
      text_.put(" E");
      text_.put_number(dialect_.volumetric ? all_units : units, kFilamentDecimals);
      end_move(printer_.extrude_mm_s);
    });
    nozzle_ = stroke.points.back();
  }

  void pull_back() {
    if (dialect_.volumetric)
      line("G10");
    else
      move_filament(-printer_.retract_mm);
  }

  void push_again() {
    if (dialect_.volumetric)
      line("G11");
    else
      move_filament(printer_.retract_mm);
  }

  void move_filament(double mm) {
    const std::int64_t units = to_units(mm, kFilamentDecimals);
    if (units == 0) return;
    begin_line("G1 E");
    text_.put_number(units, kFilamentDecimals);
    end_move(printer_.retract_mm_s);
  }

  void move_to_height(double z_mm) {
    if (z_mm_ == z_mm) return;
    begin_line("G1 Z");
    text_.put_number(to_units(z_mm, kHeightDecimals), kHeightDecimals);
    end_move(printer_.travel_mm_s);
    z_mm_ = z_mm;
  }

  void begin_line(std::string_view word) {
    text_.make_room(kLongestLine);
    text_.put(word);
  }

  void put_place(Point2 p) {
    const WrittenPlace place = written(p);
    text_.put(" X");
    text_.put_number(place.x, kGridDecimals);
    text_.put(" Y");
    text_.put_number(place.y, kGridDecimals);
  }

  void end_move(double speed_mm_s) {
    if (speed_mm_s_ != speed_mm_s) {
      text_.put(" F");
      text_.put_number(to_units(60 * speed_mm_s, kSpeedDecimals), kSpeedDecimals);
      speed_mm_s_ = speed_mm_s;
    }
    text_.put('\n');
  }

  void mark(std::string_view name, double value, int decimals) {
    begin_line(name);
    text_.put_number(to_units(value, decimals), decimals);
    text_.put('\n');
  }

  void line(std::string_view text, std::string_view more = {}) {
    text_.make_room(text.size() + more.size() + 1);
    text_.put(text);
    text_.put(more);
    text_.put('\n');
  }

  const Task& task_;
  const Printer& printer_;
  const GcodeDialect& dialect_;
  const GcodeProgress& before_;
  FilamentCounter filament_;
  TextBuffer text_;
  std::optional<EdgeGrid> outline_;  // of the layer, if travels are asked whether they leave it
  std::optional<Point2> nozzle_;
  std::optional<double> z_mm_;  // as last written
  double layer_z_mm_ = 0;
  // As last written in this layer.
  std::optional<double> speed_mm_s_;
  std::optional<Type> type_;
  std::optional<double> width_mm_;
};

}  // namespace

GcodeWriter::GcodeWriter(std::ostream& out, const Task& task, const Printer& printer,
                         std::span<const std::string> comments)
    : out_(out), task_(task), printer_(printer), dialect_(&dialect_of(printer.flavour)) {
  const auto line = [this](std::string_view text) {
    write(text);
    write("\n");
  };
  if (!dialect_->head.empty()) line(dialect_->head);
  line("; generated by routebench " + std::string(kVersion));
  for (std::string comment : comments) {
    std::replace_if(
        comment.begin(), comment.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    line("; " + comment);
  }
  for (const KeyValue& entry : task_values(task)) line("; task." + entry.key + " = " + entry.value);
  for (const KeyValue& entry : printer_values(printer))
    line("; printer." + entry.key + " = " + entry.value);
  line("; heating and homing are not part of this file");
  line("G21 ; millimetres");
  line("G90 ; absolute X Y Z");
  line(dialect_->volumetric ? "M82 ; absolute E, mm3 of filament"
                            : "M83 ; relative E, mm of filament");
  line("G92 E0");
  line(dialect_->fan_off);
}

void GcodeWriter::write_layers(std::span<const RoutedLayer> layers,
                               const ParallelFor& parallel_for) {
  // Some layers are formatted at the same time as those before them are written.
  constexpr std::size_t kLayersTogether = 16;
  std::vector<std::string> ready;
  const auto write_ready = [this, &ready] {
    for (const std::string& text : ready) write(text);
  };
  while (!layers.empty()) {
    const std::span<const RoutedLayer> part =
        layers.first(std::min(kLayersTogether, layers.size()));
    layers = layers.subspan(part.size());
    std::vector<GcodeProgress> before(part.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      before[i] = progress_;
      go_on_by(part[i]);
    }
    std::vector<std::string> texts(part.size());
    parallel_for(part.size() + 1, [&](std::size_t item) {
      if (item == 0) return write_ready();
      const RoutedLayer& routed = part[item - 1];
      if (!routed.planned->route.strokes.empty())
        texts[item - 1] = LayerText(task_, printer_, *dialect_, before[item - 1])
                              .layer(*routed.layer, *routed.planned);
    });
    ready = std::move(texts);
  }
  write_ready();
}

void GcodeWriter::go_on_by(const RoutedLayer& routed) {
  const std::vector<Stroke>& strokes = routed.planned->route.strokes;
  if (strokes.empty()) return;
  FilamentCounter filament(task_, printer_, *dialect_, progress_.filament,
                           progress_.filament_units);
  for (const Stroke& stroke : strokes)
    filament.count(stroke, [](Point2, std::int64_t, std::int64_t) {});
  progress_ = {.nozzle = strokes.back().points.back(),
               .z_mm = LayerText::height_mm(*routed.layer),
               .layers = progress_.layers + 1,
               .filament = filament.length(),
               .filament_units = filament.units()};
}

void GcodeWriter::finish() { write(LayerText(task_, printer_, *dialect_, progress_).end()); }

void GcodeWriter::write(std::string_view text) {
  out_.write(text.data(), static_cast<std::streamsize>(text.size()));
}

}  // namespace routebench
