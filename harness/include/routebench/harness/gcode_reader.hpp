#pragma once
/// G-code back into routes: what a slicer or our own writer has made, ready for the judge.

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench {

struct GcodeOptions {
  double layer_height_mm =
      0.2;                    ///< of layers whose height neither a mark nor the layer below tells
  double filament_mm = 1.75;  ///< diameter, unless the file states its own
  double arc_tolerance_mm = 0.001;  ///< how far the chords of an arc may stray from it
  /// What is added to all heights: what the printer's own offset or a raft put before them.
  double z_offset_mm = 0;
};

/// The material that lies at one height.
struct GcodeLayer {
  double z_mm = 0;       ///< of the nozzle: the top of the layer
  double height_mm = 0;  ///< by a mark, else by the layer below, else by the options
  Route route;
  /// What each stroke is for, where the file says so.
  std::vector<std::optional<StrokeKind>> kinds;
};

/// What a file of G-code prints.
struct GcodePrint {
  std::vector<GcodeLayer> layers;  ///< lowest first; at least one; none without a stroke
  double z_offset_mm = 0;          ///< that was added to heights

  // Of the strokes that are in `layers`, from the first to the last, as the file has them:
  std::size_t retractions = 0;  ///< times that filament was pulled back before a stroke
  double travel_mm = 0;         ///< XY length of the moves between strokes, detours included
  double filament_mm3 = 0;      ///< volume by E
  double marked_mm3 = 0;  ///< the same by the marks of widths and heights, where there are any
  bool filament_is_known = true;  ///< no other tool has filament of another diameter

  /// How long the print takes by the estimate that PrusaSlicer and its kin write into their files.
  std::optional<double> stated_time_s;

  std::size_t excluded_strokes = 0;  ///< that are no part of the model; see read_gcode
  double excluded_mm = 0;            ///< their length
  std::size_t lines = 0;
  std::map<std::string, std::size_t> ignored;  ///< commands that mean nothing here, and how often
  std::vector<std::string> warnings;           ///< one line each, without the file's name
};

/// Reads G-code of Marlin, Klipper, RepRapFirmware or UltiGCode (Ultimaker 2), from any slicer.
///
/// Moves. G0 and G1 are the same: a move lays material if it goes somewhere in X or Y and pushes
/// filament, else it is a travel. A change of Z alone is neither, so lifting makes no layer. Arcs
/// (G2, G3 with I J or R, in the XY plane) become chords within `arc_tolerance_mm` of the arc and
/// no longer than a tenth of its radius. G20 and G21, G90 and G91, G92 and G28 are followed. E is
/// relative while M83 or G91 is in force.
///
/// Retractions. A run of commands that pull filament back counts as one until some is pushed
/// again; so does G10 until G11 (with a word P, L, R, X, Y or Z it sets offsets or temperatures
/// and is ignored). A push on the spot ends a retraction, whatever its amount. A move that pushes
/// with the filament still pulled back lays what exceeds the amount pulled. What is pulled back is
/// forgotten when another tool is chosen (T): its filament is another one.
///
/// Strokes. Moves that lay material one after another are one stroke as long as kind and width
/// stay the same. The width is the file's mark (`;WIDTH:`); without one it is that of a bead
/// (rectangle with round ends) of the stroke's volume, length and layer height, and a stroke ends
/// where the section changes by more than 2 %. So it is, too, for strokes whose `;HEIGHT:` is not
/// their layer's (bridges).
///
/// E counts mm of filament, whose diameter is the one that the file states, else that of the
/// options. It counts mm3 after `;FLAVOR:UltiGCode` and while M200 with a diameter is in force, and
/// in all of a file that says `; use_volumetric_e = 1`.
///
/// Layers are heights at which material is laid. Material within 0.005 mm of a layer belongs to it,
/// also when the nozzle comes back later; then a warning says so. Where Z climbs while material is
/// laid (a spiral), a layer lasts until the next layer mark, without marks until it has climbed by
/// a layer height; its z is the highest point. Without `;HEIGHT:` a layer is as high as its step
/// from the layer below or the bed, up to 1.5 layer heights of the options; else as high as those
/// say. A warning tells so if that goes for the lowest layer or for more than half of them.
///
/// What is no part of the model is left out and counted: strokes of the types skirt, brim,
/// support, raft, prime or wipe tower, shield, ironing and custom code, and all that comes before
/// the first layer mark in a file that has such marks. Without marks nothing can be told apart, and
/// all strokes count. Unknown types count, with a warning.
///
/// Marks are comments: `;LAYER_CHANGE`, `;TYPE:`, `;WIDTH:`, `;HEIGHT:` (PrusaSlicer and its kin,
/// our own writer), `; FEATURE: `, `; LINE_WIDTH: ` and so on (Bambu), `;LAYER:`, `;TYPE:` (Cura).
///
/// Klipper's SAVE_GCODE_STATE and RESTORE_GCODE_STATE are followed. M and T codes other than M82,
/// M83 and M200, Klipper's other named commands, and G codes that neither move to another place nor
/// change how moves are read are ignored and counted. Nothing else is skipped. M220 and M221 (speed
/// and flow) are corrections of the machine and ignored, too.
///
/// Takes   a stream and a name for messages.
/// Returns points on the grid, where the file has them: no move is shifted.
/// Throws  Error{kBadInput} "NAME:LINE: reason" for what is no such G-code; "NAME: reason" if it
///         lays no material.
/// Cost    linear in the file; holds the strokes, not the text.
[[nodiscard]] GcodePrint read_gcode(std::istream& in, const std::string& name,
                                    const GcodeOptions& options);

/// As above, from a file. Throws Error{kBadInput} if it cannot be read.
[[nodiscard]] GcodePrint read_gcode_file(const std::filesystem::path& file,
                                         const GcodeOptions& options);

}  // namespace routebench
