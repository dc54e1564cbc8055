#pragma once
/// Which shell lies in which.

#include <cstdint>
#include <span>
#include <vector>

#include "model/bounds.hpp"
#include "routebench/geometry/types.hpp"

namespace routebench::models {

/// For every shell the shells that enclose it, by rising number: their bounds contain its bounds,
/// and they wind round its lowest point.
///
/// Takes  the shell of each triangle and the bounds of each shell; shells with empty bounds take no
///        part.
/// Cost   one pass over the triangles, each meeting the shells whose lowest point is over or under
///        its bounds.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> enclosing_shells(
    const Mesh& mesh, std::span<const std::uint32_t> shell_of_triangle,
    std::span<const Bounds> shell_bounds);

}  // namespace routebench::models
