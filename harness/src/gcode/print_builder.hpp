#pragma once
/// Beads, travels and marks, as they come, into layers of strokes.

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/place.hpp"
#include "routebench/harness/gcode_reader.hpp"

namespace routebench::gcode {

/// What a type mark says of the strokes after it.
struct StrokeType {
  bool excluded = false;  ///< no part of the model
  std::optional<StrokeKind> kind;
};

/// Filament by E: as long as a piece of it, or by volume.
struct Filament {
  double length_mm = 0;
  double volume_mm3 = 0;
};

/// A straight piece of material. Both ends lie on the grid and differ.
struct Bead {
  Point2 from;
  Point2 to;
  double from_z_mm = 0;
  double to_z_mm = 0;
  Filament filament;
};

/// Builds a GcodePrint by the rules of read_gcode. Calls come in the order of the file.
class PrintBuilder {
 public:
  explicit PrintBuilder(const GcodeOptions& options) : options_(options) {}

  void mark_layer();
  void mark_type(std::string_view name);
  /// Nothing: from now on widths follow from E.
  void mark_width(std::optional<double> width_mm);
  void mark_height(double height_mm);
  /// `others_differ`: other tools than the first have filament of another diameter.
  void state_filament(double diameter_mm, bool others_differ) {
    filament_mm_ = diameter_mm;
    filaments_differ_ = others_differ;
  }
  /// All E of the file counts mm3, whatever was understood before.
  void state_volumetric_e() { volumetric_e_ = true; }
  void state_time(double time_s) { print_.stated_time_s = time_s; }
  void ignore(std::string_view command);

  void bead(const Bead& bead, const Place& place);
  void travel(double length_mm);
  void pull();

  /// Throws Error{kBadInput} if there is no material, or a bead wider than a metre.
  [[nodiscard]] GcodePrint finish(const Place& end);

 private:
  /// What a stroke is made of, until its width is known.
  struct Body {
    Filament filament;
    double length_mm = 0;
    std::size_t line = 0;
  };
  struct RawLayer {
    double z_mm = 0;
    std::optional<double> height_mm;
    GcodeLayer layer;
    std::vector<Body> bodies;  ///< one a stroke
  };

  void enter_layer(const Bead& bead);
  void enter_spiral(const Bead& bead);
  [[nodiscard]] bool fits_stroke(const Bead& bead, double length_mm) const;
  void begin_stroke(Point2 from, const Place& place);
  [[nodiscard]] std::optional<double> width_mm() const;
  void exclude(const Bead& bead);
  void drop_priming();
  void warn();
  [[nodiscard]] double volume_mm3(const Filament& filament) const;
  void set_heights();
  void set_widths(RawLayer& layer, Place place);

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  GcodeOptions options_;
  GcodePrint print_;
  std::vector<RawLayer> layers_;                ///< in the order in which they were begun
  std::map<double, std::size_t> layer_of_z_;    ///< the flat ones
  std::map<std::string, std::size_t> unknown_;  ///< type marks, and how often
  std::size_t layer_ = kNone;                   ///< that was printed last
  bool layer_marks_ = false;                    ///< one has been seen
  bool type_marks_ = false;
  bool stroke_open_ = false;                ///< the next bead may go on with the last stroke
  bool excluded_open_ = false;              ///< the last bead was excluded and may go on
  bool climbing_ = false;                   ///< the last bead was part of a spiral and may go on
  std::optional<double> spiral_from_z_mm_;  ///< where the layer began, if it is a spiral
  bool returned_ = false;                   ///< to a lower layer
  std::size_t guessed_heights_ = 0;         ///< layers that are as high as the options say
  double first_guessed_z_mm_ = 0;
  bool guesses_bed_layer_ = false;  ///< the lowest one is among them
  StrokeType type_;
  std::optional<double> width_mark_mm_;
  std::optional<double> height_mark_mm_;        ///< of the strokes
  std::optional<double> layer_height_mark_mm_;  ///< the first one after the layer's mark
  bool layer_height_open_ = true;               ///< that one is still to come
  std::optional<double> filament_mm_;
  bool filaments_differ_ = false;
  bool volumetric_e_ = false;
  double waiting_travel_mm_ = 0;  ///< since the last stroke; counts if another one follows
  std::size_t waiting_pulls_ = 0;
  Filament pushed_;  ///< by all strokes
};

}  // namespace routebench::gcode
