#pragma once
/// Routes as G-code for a printer.

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/task.hpp"

namespace routebench {

struct GcodeDialect;
struct LayerPart;

/// How far a print has come between two layers.
struct GcodeProgress {
  std::optional<Point2> nozzle;     ///< nothing before the first stroke
  std::optional<double> z_mm;       ///< height of the nozzle
  int layers = 0;                   ///< with strokes
  double filament = 0;              ///< that the strokes so far need, mm or mm3
  std::int64_t filament_units = 0;  ///< that was written for them
};

/// What GcodeWriter writes a layer from. Both must outlive the call.
struct RoutedLayer {
  const Layer* layer;
  const PlannedLayer* planned;
};

/// Writes layers of routes, one after the other, as they come.
///
/// X, Y, Z absolute, millimetres. Coordinates have the seven decimals that the grid needs, so that
/// a reader gets the very points of the route; E carries its rounding along, so that sums are right
/// to 0.00001. The filament is pulled back on exactly the travels on which the judge counts a
/// retraction; the way to the first stroke of the print comes before the first layer mark and is no
/// travel. Moves that vanish in rounding are dropped. Layer, type and width marks are comments in
/// the manner of PrusaSlicer; every layer begins with its own type, width and speeds.
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

  /// Layers come in ascending order, in one call or in several; a layer without strokes writes
  /// nothing. They are formatted at the same time and written in their order: the bytes depend
  /// neither on the loop nor on how layers are spread over calls.
  /// Cost linear in the points; parts that equal layers share (PlannedPart::shared) are formatted
  ///      once. The text of some layers, and of such parts, is in memory at a time.
  void write_layers(std::span<const RoutedLayer> layers,
                    const ParallelFor& parallel_for = serial_for);

  /// Writes the end block.
  void finish();

 private:
  /// Moves the progress on behind a layer with strokes.
  void go_on_by(const Layer& layer, std::span<const LayerPart> parts);
  void write(std::string_view text);

  std::ostream& out_;
  Task task_;
  Printer printer_;
  const GcodeDialect* dialect_;
  GcodeProgress progress_;
};

}  // namespace routebench
