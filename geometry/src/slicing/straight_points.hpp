#pragma once
/// Points of a contour that only tell where a flat wall is divided into facets.

#include "routebench/geometry/types.hpp"

namespace routebench::slicing {

/// Contours keep this near to the cut facets: ten steps of the grid, and about as much as single
/// precision knows of coordinates of 100 mm, so that what is flat in a model counts as flat.
inline constexpr double kStraightMm = 0.00001;

/// Takes points away that lie on the line between their neighbours, so that the layers of a wall
/// that stands upright have the same contour wherever its facets are divided. The ring begins at
/// its smallest point then. No edge strays further than kStraightMm from the points that it stands
/// for.
/// Cost  linear.
void drop_straight_points(Ring& ring);

}  // namespace routebench::slicing
