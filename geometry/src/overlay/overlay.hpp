#pragma once
/// Booleans and fill rules: which of the faces that rings make belong together.

#include <cstdint>
#include <optional>
#include <vector>

#include "overlay/grid_rings.hpp"
#include "overlay/planar_edges.hpp"

namespace routebench::overlay {

/// Which places are inside, by how often the rings of the two sets run round them.
enum class Inside { kFirstPositive, kFirstNonZero, kFirstOdd, kEither, kBoth, kFirstOnly };

[[nodiscard]] bool is_inside(Winding winding, Inside inside);

using GridRing = std::pmr::vector<GridPoint>;

/// Outer ring counter-clockwise, holes clockwise; rings may touch in points.
struct GridPolygon {
  GridRing outer;
  std::vector<GridRing> holes;
};

/// The polygons that hold all that is inside. Rings may cross, overlap and repeat. No three
/// consecutive points lie on a line.
///
/// Returns nothing if the rings cannot be cut; see PlanarEdges. Rings lie where the given ones do.
/// Cost    about linear where edges are spread evenly.
[[nodiscard]] std::optional<std::vector<GridPolygon>> overlay(const GridRings& rings,
                                                              Inside inside);

/// The first set's area, divided by the second's.
struct Divided {
  std::vector<GridPolygon> within;
  std::vector<GridPolygon> beyond;
};

/// overlay() for both Inside::kBoth and Inside::kFirstOnly.
/// Cost  little more than that of one of them.
[[nodiscard]] std::optional<Divided> divide(const GridRings& rings);

/// The rings of polygons, to their left the inside.
[[nodiscard]] GridRings rings_of(
    const std::vector<GridPolygon>& polygons,
    std::pmr::memory_resource* memory = std::pmr::get_default_resource());

}  // namespace routebench::overlay
