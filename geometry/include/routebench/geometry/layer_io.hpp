#pragma once
/// Layers as files: WKT (lossless) and SVG.

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// One layer a line: `MULTIPOLYGON Z (((x y z, ...), (hole)), ...)` with every digit that the grid
/// needs; an empty layer is `MULTIPOLYGON Z EMPTY` and keeps its place. Comment lines begin with
/// '#'; the first ones state height, index and repair marks.
void write_wkt(std::ostream& out, const std::vector<Layer>& layers);

/// Reads what write_wkt writes, and plain WKT of other tools: MULTIPOLYGON or POLYGON, with or
/// without Z, one a line. Rings are turned the right way round and put on the grid. Without z
/// values layers are numbered upwards by layer_height_mm.
/// Takes  where to add a line if rings crossed or overlapped, or holes lay outside, so that the
///        layers are not those of the file to the letter; null if nobody wants to know.
/// Throws Error{kBadInput} naming file, line and column.
[[nodiscard]] std::vector<Layer> read_wkt(const std::filesystem::path& file, double layer_height_mm,
                                          std::vector<std::string>* warnings = nullptr);

/// How large a picture is shown unless its viewer is told otherwise, px.
struct PictureSize {
  double width_px;
  double height_px;
};
/// The size at which details can be seen, whatever the size of the part: 800 px for the longer
/// side.
[[nodiscard]] PictureSize picture_size(double width_mm, double height_mm);

/// One SVG document for one layer: material grey, solid part darker, y upwards, a unit is a
/// millimetre, shown in picture_size; data-* attributes with index, z and repair mark; coordinates
/// keep every digit that the grid needs.
void write_svg(std::ostream& out, const Layer& layer);

/// Reads what write_svg writes.
/// Throws Error{kBadInput} naming file and place.
[[nodiscard]] Layer read_svg(const std::filesystem::path& file);

}  // namespace routebench
