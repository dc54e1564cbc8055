#pragma once
/// The middle of a polygon as a graph: the chords of a triangulation and the triangles between
/// them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "routebench/geometry/types.hpp"

namespace routebench {

/// Triangles of a polygon whose boundary is sampled, and the chords that two of them share. Chord
/// middles run along the middle of the polygon.
struct ChordalAxis {
  struct Chord {
    Point2 middle;
    std::array<std::uint32_t, 2> triangles{};
  };
  struct Triangle {
    Point2 centre;
    std::array<std::uint32_t, 3> chords{};  ///< the first `count` of them
    std::uint32_t count = 0;
  };
  std::vector<Chord> chords;
  std::vector<Triangle> triangles;
};

/// Samples the boundary so that no edge is longer than step_mm, and triangulates.
/// Takes   a polygon near the origin: what is computed depends on where it stands.
/// Cost    O(n log n) typical, in samples.
[[nodiscard]] ChordalAxis chordal_axis(const Polygon& polygon, double step_mm);

}  // namespace routebench
