#pragma once
/// Layers that need not be judged for themselves.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "routebench/geometry/types.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/planning/planner.hpp"

namespace routebench::judging {

/// All that a layer's scores depend on. What is pointed to must outlive it.
struct LayerCase {
  const Demand* demand = nullptr;
  const Route* route = nullptr;
  std::optional<Point2> entered_from;
};

/// For each case the place of the first one that is equal, its own if there is none before. The
/// straight walls of a part give equal layers in turn, each entered from where the one below ended.
/// Cost linear in what the cases hold.
[[nodiscard]] std::vector<std::size_t> first_alike(std::span<const LayerCase> cases);

}  // namespace routebench::judging
