#pragma once
/// Solids of upright walls and level floors.

#include <cstddef>
#include <functional>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench::shapes {

/// An upright wall over a ring, with the material on the left of the ring.
struct Wall {
  Ring ring;
  double lower_mm = 0;
  double upper_mm = 0;
};

/// Closes walls by floors and ceilings wherever some begin or end.
///
/// Takes  walls whose rings neither touch nor cross at any height that they share, such that at
/// every
///        height outer rings run counter-clockwise and holes clockwise. Where one wall goes on
///        above another over the same ring it must be one wall.
/// Returns a closed mesh of few triangles.
[[nodiscard]] Mesh stack(const std::vector<Wall>& walls);

/// Makes a mesh of about so many triangles from a solid with curved walls: first the curves become
/// finer, then every triangle is cut.
///
/// Takes  `build`, which makes the solid with arcs cut into pieces of at most so many mm, and the
///        length that it has by default.
[[nodiscard]] Mesh refined(std::size_t triangles, double arc_mm,
                           const std::function<Mesh(double arc_mm)>& build);

/// Counter-clockwise rings; curves are cut into pieces of at most arc_mm.
[[nodiscard]] Ring circle(Point2 centre, double radius_mm, double arc_mm);
[[nodiscard]] Ring rectangle(Point2 lower, Point2 upper);
[[nodiscard]] Ring rounded_rectangle(Point2 lower, Point2 upper, double radius_mm, double arc_mm);

/// The same ring run the other way: a hole.
[[nodiscard]] Ring reversed(Ring ring);

}  // namespace routebench::shapes
