#include "routebench/planning/loop_trees.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/planning/ring_path.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

constexpr double kStepMm = 0.4;

std::vector<Polygons> insets_of(const Polygons& polygons) {
  std::vector<Polygons> insets;
  for (Polygons inner = offset(polygons, -kStepMm / 2); !inner.empty();
       inner = offset(insets.back(), -kStepMm))
    insets.push_back(std::move(inner));
  return insets;
}

Ring circle(Point2 centre, double radius_mm, bool clockwise = false) {
  Ring ring;
  for (int i = 0; i < 64; ++i) {
    const double angle = (clockwise ? -1 : 1) * 2 * std::numbers::pi * i / 64;
    ring.push_back(snap(
        Point2{centre.x + radius_mm * std::cos(angle), centre.y + radius_mm * std::sin(angle)}));
  }
  return ring;
}

Polygons plate_with_holes() {
  return {{{{0, 0}, {30, 0}, {30, 20}, {0, 20}},
           {circle({8, 10}, 3, true), circle({20, 8}, 4, true), circle({26, 16}, 1, true)}}};
}

std::size_t roots_of(const std::vector<InsetLoop>& loops) {
  return static_cast<std::size_t>(
      std::count_if(loops.begin(), loops.end(), [](const InsetLoop& l) { return l.is_root; }));
}

TEST(LoopTrees, HoldEveryRingOnce) {
  const std::vector<Polygons> insets = insets_of(plate_with_holes());
  const std::vector<InsetLoop> loops = loop_trees(insets, kStepMm, {});
  std::size_t at = 0;
  for (const Polygons& inset : insets)
    for (const Ring& ring : rings_of(inset)) EXPECT_EQ(loops.at(at++).ring, ring);
  EXPECT_EQ(at, loops.size());
}

TEST(LoopTrees, AreTrees) {
  const std::vector<InsetLoop> loops = loop_trees(insets_of(plate_with_holes()), kStepMm, {});
  std::vector<int> parents(loops.size(), 0);
  for (const InsetLoop& loop : loops)
    for (const std::uint32_t child : loop.children) ++parents.at(child);
  for (std::size_t i = 0; i < loops.size(); ++i)
    EXPECT_EQ(parents[i], loops[i].is_root ? 0 : 1) << i;
}

TEST(LoopTrees, JoinOnlyWhatLiesSideBySide) {
  const std::vector<InsetLoop> loops = loop_trees(insets_of(plate_with_holes()), kStepMm, {});
  for (const InsetLoop& loop : loops)
    for (const std::uint32_t child : loop.children) {
      double least = 1e9;
      for (const RingPlace& place : spread_places(loops[child].ring, 500))
        least = std::min(least, nearest_place(loop.ring, place.point).distance_mm);
      EXPECT_LE(least, 2.1 * kStepMm);
    }
}

TEST(LoopTrees, OneForEachIslandHolesIncluded) {
  Polygons polygons = plate_with_holes();
  EXPECT_EQ(roots_of(loop_trees(insets_of(polygons), kStepMm, {})), 1U);
  polygons.push_back({circle({40, 10}, 5), {circle({40, 10}, 2, true)}});
  polygons.push_back({circle({60, 10}, 5), {}});
  EXPECT_EQ(roots_of(loop_trees(insets_of(polygons), kStepMm, {})), 3U);
  EXPECT_TRUE(loop_trees({}, kStepMm, {}).empty());
}

TEST(LoopTrees, PutTheLargestBranchFirst) {
  // Two chambers of different size behind one neck each.
  const Polygons polygons{
      {{{0, 0}, {30, 0}, {30, 12}, {14, 12}, {14, 5}, {12, 5}, {12, 8}, {0, 8}}, {}}};
  const std::vector<InsetLoop> loops = loop_trees(insets_of(polygons), kStepMm, {});
  const auto below = [&](const auto& self, std::uint32_t loop) -> std::size_t {
    std::size_t sum = 1;
    for (const std::uint32_t child : loops[loop].children) sum += self(self, child);
    return sum;
  };
  bool forks = false;
  for (const InsetLoop& loop : loops) {
    forks |= loop.children.size() > 1;
    for (std::size_t i = 1; i < loop.children.size(); ++i)
      EXPECT_GE(below(below, loop.children[i - 1]), below(below, loop.children[i]));
  }
  EXPECT_TRUE(forks);
}

}  // namespace
}  // namespace routebench
