#pragma once
/// Whether rings meet anywhere, by stretches that cannot meet themselves.

#include <cstdint>
#include <vector>

#include "overlay/grid_rings.hpp"

namespace routebench::overlay {

/// True if it is certain that no ring meets itself or another one. Rings are taken apart into runs
/// that go one way along x and one way along y: a run does not meet itself, its ends are its box,
/// and two runs whose boxes overlap are halved until the boxes of their parts do not. Says no, too,
/// where that would take longer than to cut the rings, as it does where edges are few.
///
/// Cost   linear for rings of long runs; never more than a fixed number of steps an edge.
/// Source the monotone chains of the JTS Topology Suite (M. Davis, 2001).
[[nodiscard]] bool meet_nowhere(const GridRings& rings);

}  // namespace routebench::overlay
