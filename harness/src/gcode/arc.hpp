#pragma once
/// Arcs as chords.

#include <optional>
#include <vector>

#include "gcode/place.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::gcode {

/// An arc as G2 and G3 give it.
struct Arc {
  Point2 from;
  Point2 to;  ///< equal to `from`: a full circle, if given by its centre
  bool clockwise = false;
  std::optional<Point2> centre;     ///< relative to `from`: the words I and J
  std::optional<double> radius_mm;  ///< the word R: negative for the way longer than half a circle
};

/// Sets `points` to the ends of an arc's chords: the last is the arc's end, its start is not among
/// them. Chords stay within tolerance_mm (a millionth of the radius, if that is more) of the arc
/// and are no longer than a tenth of its radius. Throws Error{kBadInput} for an arc without centre
/// or radius or with both, for a radius of 0, of
///        more than 1 km or that does not reach, and for an end that is off the circle by more than
///        0.05 mm and 1 % of its radius.
void flatten(const Arc& arc, double tolerance_mm, const Place& place, std::vector<Point2>& points);

}  // namespace routebench::gcode
