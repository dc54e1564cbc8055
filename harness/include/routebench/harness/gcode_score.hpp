#pragma once
/// A file of G-code before the judge: put in its place on the model, layer by layer.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "routebench/geometry/parallel.hpp"
#include "routebench/geometry/types.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/harness/pipeline.hpp"

namespace routebench {

/// Which layer of a file belongs to which of a model.
struct LayerPairs {
  std::vector<std::optional<std::size_t>> file_layers;  ///< one for each layer of the model
  std::vector<std::size_t> unpaired;                    ///< of the file, ascending
  /// How many of these places in the model have a pair.
  [[nodiscard]] std::size_t count(std::span<const std::size_t> places) const;
};

/// Pairs layers by height. The model's are cut at mid-slab, the file's have the height of the
/// nozzle, the top of the slab. A pair's tops differ by no more than half of the model's layer;
/// where two layers of a file compete, the nearer one wins, and of equals the lower one.
/// Takes the layers of both, ascending. Cost   linear.
[[nodiscard]] LayerPairs pair_layers(std::span<const Layer> model,
                                     std::span<const GcodeLayer> file);

/// What has to be added to the file's coordinates so that it lies on the model.
///
/// For each pair, the middle of the bounding box of the file's walls (of all its strokes if no
/// stroke is marked as a wall) is put on that of the layer; the median over the layers counts, for
/// x and for y. So what stands beside the part on some layers does no harm. A shift of less than
/// half a line in both directions is taken for none. Returns a point on the grid; zero if no pair
/// has material in both.
[[nodiscard]] Point2 offset_to_model(std::span<const Layer> model, std::span<const GcodeLayer> file,
                                     const LayerPairs& pairs, double line_width_mm);

/// Says in one line how far above or below a model's lowest layer that of a file lies; nothing if
/// they pair. Takes the layers of both, ascending.
[[nodiscard]] std::optional<std::string> misplaced_in_z(std::span<const Layer> model,
                                                        std::span<const GcodeLayer> file);

/// A file's strokes as the routes of a model's layers: what a contender's planners would have
/// returned.
struct PlacedPrint {
  std::vector<PlannedLayer> layers;  ///< one for each chosen layer; without times
  LayerPairs pairs;
  Point2 offset_mm;                     ///< that was added
  std::optional<double> stated_time_s;  ///< see GcodePrint
  /// What could not be paired, in one line; empty if nothing.
  std::string unpaired;
  /// Material by E and by the marks of widths and heights, where the file has such marks.
  double filament_mm3 = 0;
  std::optional<double> marked_mm3;
};

/// Puts a file's strokes where they belong on a model. A layer of the model that has no counterpart
/// has no stroke; what the file lays on layers without counterpart is left out.
///
/// A stroke whose kind the file does not tell is for that region of the demand in which the longest
/// part of it lies: dense or sparse inside, or the walls.
///
/// Takes  places of the model's layers, ascending, and the offset, if it is known.
[[nodiscard]] PlacedPrint place_print(const GcodePrint& print, const PreparedModel& model,
                                      std::span<const std::size_t> chosen,
                                      std::optional<Point2> offset_mm, double line_width_mm,
                                      const ParallelFor& parallel_for);

/// Judges placed strokes as if a contender had planned them, but for plan times, of which there are
/// none. A file that lays material on layers of its own is off task, and so says the reason; so is
/// one whose E makes so much less or more than its marks of widths, which the scores believe, that
/// the gate's limits of the deposit would be missed.
[[nodiscard]] JudgedCell judge_print(const Judge& judge, const PreparedModel& model,
                                     std::span<const std::size_t> chosen, const PlacedPrint& placed,
                                     const ParallelFor& parallel_for);

/// A file's scores.
struct GcodeScore {
  JudgedCell cell;  ///< without plan times; without a model the verdict means nothing
  LayerPairs pairs;
  Point2 offset_mm;
};

/// Judges a file against a model: place_print, then judge_print.
[[nodiscard]] GcodeScore score_gcode(const Judge& judge, const PreparedModel& model,
                                     std::span<const std::size_t> chosen, const GcodePrint& print,
                                     std::optional<Point2> offset_mm,
                                     const ParallelFor& parallel_for);

/// Judges a file alone: what needs the layers' polygons is left empty, among it, with a policy that
/// asks for crossings, retractions and times.
[[nodiscard]] GcodeScore score_gcode(const Judge& judge, const GcodePrint& print,
                                     const ParallelFor& parallel_for);

}  // namespace routebench
