#pragma once
/// Routes as G-code for a printer.

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/task.hpp"

namespace routebench {

struct GcodeDialect;

/// Writes layers of routes, one after the other, as they come.
///
/// X, Y, Z absolute, millimetres. Coordinates have the seven decimals that the grid needs, so that
/// a reader gets the very points of the route; E carries its rounding along, so that sums are right
/// to 0.00001. The filament is pulled back on exactly the travels on which the judge counts a
/// retraction; the way to the first stroke of the print comes before the first layer mark and is no
/// travel. Moves that vanish in rounding are dropped. Layer, type and width marks are comments in
/// the manner of PrusaSlicer.
///
/// Flavours. `marlin`, `klipper` and `reprap` have E relative (M83) in mm of filament, and pull it
/// back by retract_mm. `ultigcode` (Ultimaker 2) has E absolute (M82) in mm3 and leaves the amount
/// to the printer (G10, G11). The fan is off on the first layer that is printed and on above it.
/// The end block lifts the nozzle, stops the fan and, but for `ultigcode`, the motors. Heating and
/// homing are the printer's own start code and are not written.
class GcodeWriter {
 public:
  /// Takes  comment lines for the head of the file (model, contender, ...).
  /// Throws Error{kBadInput} for a flavour that is not written.
  GcodeWriter(std::ostream& out, const Task& task, const Printer& printer,
              std::span<const std::string> comments);

  /// Layers come in ascending order; a layer without strokes writes nothing.
  /// Cost linear in the points.
  void write_layer(const Layer& layer, const PlannedLayer& planned);

  /// Writes the end block.
  void finish();

 private:
  enum class Type { kExternalPerimeter, kPerimeter, kSolidInfill, kInternalInfill };

  [[nodiscard]] Type type_of(const Stroke& stroke, StrokeKind kind, const EdgeGrid& outline) const;
  void approach(Point2 first);
  void mark_layer(const Layer& layer);
  void mark_stroke(Type type, double width_mm);
  void travel(Point2 to, const EdgeGrid& outline);
  void extrude(const Stroke& stroke);
  void pull_back();
  void push_again();
  void move_filament(double mm);
  void move_to_height(double z_mm);
  void append_place(Point2 p);
  void end_move(double speed_mm_s);
  void write_line(std::string_view text);

  std::ostream& out_;
  Task task_;
  Printer printer_;
  const GcodeDialect* dialect_;
  std::string line_;
  std::optional<Point2> nozzle_;  ///< nothing before the first stroke
  double layer_z_mm_ = 0;         ///< of the nozzle while it prints this layer
  std::optional<double> z_mm_;    ///< as last written
  std::optional<double> speed_mm_s_;
  std::optional<Type> type_;  ///< as last marked
  std::optional<double> width_mm_;
  int layers_begun_ = 0;
  double filament_ = 0;              ///< that the strokes so far need, mm or mm3
  std::int64_t filament_units_ = 0;  ///< that was written for them
};

}  // namespace routebench
