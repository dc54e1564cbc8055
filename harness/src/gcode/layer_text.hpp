#pragma once
/// The text of one layer of G-code.

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/filament_counter.hpp"
#include "gcode/text_buffer.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/harness/gcode_writer.hpp"

namespace routebench {

inline constexpr int kHeightDecimals = 5;
inline constexpr int kSpeedDecimals = 3;

/// What tells the flavours apart.
struct GcodeDialect {
  std::string_view flavour;
  bool volumetric;  ///< E is absolute and counts mm3; the printer itself knows how to retract
  std::string_view head;
  std::string_view fan_off;
  std::string_view end;
};

/// What moves print, as marks in the file say.
enum class MoveType { kExternalPerimeter, kPerimeter, kSolidInfill, kInternalInfill };

/// What lines of a layer rely on: what was last written in it.
struct GcodeMarks {
  std::optional<double> speed_mm_s;
  std::optional<MoveType> type;
  std::optional<double> width_mm;
};

/// What a part of a layer's strokes writes after its first move: the same on all equal layers, for
/// the first move evens out what rounding owes.
struct PartText {
  Filament filament;  ///< that it takes
  std::string text;
  std::optional<MoveType> first_type;
  GcodeMarks marks_after;
};

/// A part of a layer's strokes: what one call of a planner made, or all of them.
struct LayerPart {
  std::span<const Stroke> strokes;
  std::span<const StrokeKind> kinds;
  std::shared_ptr<PartText> text;  ///< if it may come on several equal layers
  bool makes_text = false;         ///< the first of them does, the others copy
};

/// Formats one layer. It knows what is before it, so that layers can be formatted in any order.
class LayerText {
 public:
  /// What is given by reference must outlive it.
  LayerText(const Task& task, const Printer& printer, const GcodeDialect& dialect,
            const GcodeProgress& before, const Layer& layer, std::vector<LayerPart> parts);

  /// Makes the texts that are for other layers too; before format() of any of these.
  void make_part_texts();

  void format();
  /// Writes what was formatted.
  void write(std::ostream& out) const;

  /// Of the nozzle while it prints a layer: layers are cut at half their height.
  [[nodiscard]] static double height_mm(const Layer& layer) {
    return layer.z_mm + layer.height_mm / 2;
  }

 private:
  /// Asks the layer's outline what has to be known of it.
  void look();
  void find_types();
  void approach(Point2 first);
  void mark_layer();
  void write_part(std::size_t part);
  /// All of a part but the way to it and its first move. Returns the filament that it takes.
  Filament write_after_first_move(std::size_t part, std::int64_t units_before);
  void mark_stroke(MoveType type, double width_mm);
  void travel(Point2 to);
  /// Extrudes to the points [begin, end) of a stroke.
  void extrude(const Stroke& stroke, std::size_t begin, std::size_t end, FilamentCounter& filament,
               std::int64_t units_before);
  void pull_back();
  void push_again();
  void move_filament(double mm);
  void move_to_height(double z_mm);
  void begin_line(std::string_view word);
  void put_place(Point2 p);
  void end_move(double speed_mm_s);
  void mark(std::string_view name, double value, int decimals);
  void line(std::string_view text, std::string_view more = {});

  const Task& task_;
  const Printer& printer_;
  const GcodeDialect& dialect_;
  const Layer& layer_;
  GcodeProgress before_;
  std::vector<LayerPart> parts_;
  double layer_z_mm_;
  bool has_looked_ = false;
  std::vector<std::vector<MoveType>> types_;  // of each part's strokes, but where others tell them
  std::optional<EdgeGrid> outline_;  // of the layer, if travels are asked whether they leave it
  /// A text of a part, and the place in the layer's own text before which it goes.
  struct Copy {
    std::size_t place;
    std::shared_ptr<const PartText> text;
  };

  TextBuffer text_;
  std::vector<Copy> copies_;
  std::optional<Point2> nozzle_;
  std::optional<double> z_mm_;  // as last written
  GcodeMarks marks_;
  Filament filament_;  // of all before
};

}  // namespace routebench
