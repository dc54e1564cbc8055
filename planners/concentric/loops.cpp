#include "loops.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"

namespace routebench::concentric {
namespace {

bool overlap(const Box2& a, const Box2& b, double margin_mm) {
  return a.lower.x <= b.upper.x + margin_mm && b.lower.x <= a.upper.x + margin_mm &&
         a.lower.y <= b.upper.y + margin_mm && b.lower.y <= a.upper.y + margin_mm;
}

/// One polygon of an inset, and which loops are its rings.
struct Region {
  const Polygon* polygon;
  Box2 box;
  std::uint32_t first_loop;
  std::uint32_t loops;
};

/// The region of the inset before that a region lies in.
const Region* region_around(const Region& inner, const std::vector<Region>& outside) {
  const Region* only = nullptr;
  std::size_t candidates = 0;
  for (const Region& outer : outside)
    if (overlap(outer.box, inner.box, 0)) {
      only = &outer;
      ++candidates;
    }
  if (candidates <= 1) return only;
  for (const Region& outer : outside)
    if (overlap(outer.box, inner.box, 0) &&
        EdgeGrid({*outer.polygon}).contains(inner.polygon->outer.front()))
      return &outer;
  return nullptr;
}

}  // namespace

LoopForest loop_forest(const std::vector<Polygons>& insets, double step_mm,
                       const PlanContext& context) {
  LoopForest forest;
  std::vector<Region> outside;
  std::uint32_t regions = 0;
  std::vector<Box2> boxes;  // of loops
  for (const Polygons& inset : insets) {
    std::vector<Region> here;
    for (const Polygon& polygon : inset) {
      stop_if_asked(context);
      Region region{&polygon, bounding_box(polygon),
                    static_cast<std::uint32_t>(forest.loops.size()),
                    static_cast<std::uint32_t>(1 + polygon.holes.size())};
      const Region* around = region_around(region, outside);
      for (std::uint32_t i = 0; i < region.loops; ++i) {
        Loop loop{i == 0 ? polygon.outer : polygon.holes[i - 1], kNoLoop, {}, regions};
        boxes.push_back(i == 0 ? region.box : bounding_box(loop.ring));
        const auto own = static_cast<std::uint32_t>(forest.loops.size());
        double least = std::numeric_limits<double>::infinity();
        std::vector<std::uint32_t> near;
        for (std::uint32_t k = 0; around != nullptr && k < around->loops; ++k)
          if (overlap(boxes[around->first_loop + k], boxes[own], 2 * step_mm))
            near.push_back(around->first_loop + k);
        for (const std::uint32_t candidate : near) {
          const double mm =
              near.size() == 1 ? 0 : distance_of(loop.ring, forest.loops[candidate].ring);
          if (mm >= least) continue;
          least = mm;
          loop.parent = candidate;
        }
        (loop.parent == kNoLoop ? forest.roots : forest.loops[loop.parent].children).push_back(own);
        forest.loops.push_back(std::move(loop));
      }
      ++regions;
      here.push_back(region);
    }
    outside = std::move(here);
  }
  return forest;
}

}  // namespace routebench::concentric
