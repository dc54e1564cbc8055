#pragma once
/// CGAL's straight skeleton, which is a library of its own: few runs ask for it, and it needs MPFR,
/// for which all others would wait when they start.

#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/planning/planner.hpp"

/// The insets of one polygon by step_mm, 2 step_mm, ... until nothing is left; none if CGAL fails,
/// as it may where the construction is inexact. Throws what it throws, and Error{kStopped}.
extern "C" void routebench_skeleton_insets(const routebench::Polygon& polygon, double step_mm,
                                           const routebench::PlanContext& context,
                                           std::vector<routebench::Polygons>& insets);
