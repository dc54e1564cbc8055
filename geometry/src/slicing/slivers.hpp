#pragma once
/// What rounding and mending leave behind: areas too narrow to mean anything.

#include "routebench/geometry/types.hpp"

namespace routebench::slicing {

/// Takes away polygons and holes that are narrower than width_mm on average (a strip's average
/// width is twice its area over its perimeter).
[[nodiscard]] Polygons without_slivers(Polygons polygons, double width_mm);

}  // namespace routebench::slicing
