#include "eulerian/quadtree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "planning.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench::eulerian {
namespace {

using Kind = Quadtree::Kind;

constexpr double kLeafMm = 0.7;

struct Trial {
  Polygons polygons;
  std::vector<Ring> rings = rings_of(polygons);
  Quadtree tree{rings, {-3.1, -2.3}, 40, kLeafMm};
};

std::vector<Trial> trials() {
  std::vector<Trial> trials;
  trials.push_back({test::blob()});
  // Islands in holes of islands.
  Polygons nested;
  for (const double radius : {14.0, 8.0, 3.0})
    nested.push_back({test::circle({16, 16}, radius, 50),
                      {test::reversed(test::circle({16, 16}, radius - 2.4, 50))}});
  trials.push_back({nested});
  for (std::uint64_t seed = 1; seed <= 12; ++seed) trials.push_back({test::random_polygons(seed)});
  return trials;
}

/// Length of the part of segment ab in a closed box, or 0 where it only touches; -1 if it does not.
double length_in(Point2 a, Point2 b, Point2 lower, Point2 upper) {
  double enter = 0, leave = 1;
  const auto clip = [&](double from, double run, double low, double high) {
    if (run == 0) {
      if (from < low || from > high) enter = 2;
      return;
    }
    const auto [first, last] = std::minmax({(low - from) / run, (high - from) / run});
    enter = std::max(enter, first);
    leave = std::min(leave, last);
  };
  clip(a.x, b.x - a.x, lower.x, upper.x);
  clip(a.y, b.y - a.y, lower.y, upper.y);
  return enter > leave ? -1 : (leave - enter) * distance(a, b);
}

double outline_in(const Trial& trial, std::uint32_t cell, double grow_mm) {
  const double side = trial.tree.side_mm(Quadtree::level(cell));
  const Point2 lower = trial.tree.lower(cell) - Point2{grow_mm, grow_mm};
  const Point2 upper = trial.tree.lower(cell) + Point2{side + grow_mm, side + grow_mm};
  double longest = -1;
  for (const Ring& ring : trial.rings)
    for (std::size_t i = 0; i < ring.size(); ++i)
      longest = std::max(longest, length_in(ring[i], ring[(i + 1) % ring.size()], lower, upper));
  return longest;
}

TEST(Quadtree, NumbersAreArithmetic) {
  for (std::uint32_t cell = 0; cell < Quadtree::first_of_level(6); ++cell) {
    const Quadtree::Position at = Quadtree::position(cell);
    ASSERT_EQ(Quadtree::number(at), cell);
    ASSERT_EQ(Quadtree::level(cell), at.level);
    ASSERT_LT(at.column, 1U << at.level);
    ASSERT_LT(at.row, 1U << at.level);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t child = Quadtree::first_child(cell) + k;
      ASSERT_EQ(Quadtree::parent(child), cell);
      ASSERT_EQ(Quadtree::position(child),
                (Quadtree::Position{at.level + 1, 2 * at.column + k % 2, 2 * at.row + k / 2}));
    }
  }
  const std::uint32_t last = Quadtree::first_of_level(Quadtree::kDeepest + 1) - 1;
  constexpr std::uint32_t kLast = (1U << Quadtree::kDeepest) - 1;
  EXPECT_EQ(Quadtree::position(last), (Quadtree::Position{Quadtree::kDeepest, kLast, kLast}));
}

TEST(Quadtree, TheRootHasWholeLevels) {
  const Quadtree tree({}, {1, 2}, 10, 1.5);
  EXPECT_EQ(tree.levels(), 3U);  // 8 x 1.5 >= 10
  EXPECT_EQ(tree.side_mm(0), 12);
  EXPECT_EQ(tree.leaves(), std::vector<std::uint32_t>{0});
  EXPECT_EQ(tree.centre(0), (Point2{7, 8}));
}

TEST(Quadtree, RefusesMoreLevelsThanItHoldsInMemory) {
  EXPECT_EQ(Quadtree({}, {0, 0}, 2048, 1).levels(), 11U);
  EXPECT_THROW(Quadtree({}, {0, 0}, 2049, 1), Error);
}

TEST(Quadtree, LeavesTileTheRoot) {
  for (const Trial& trial : trials()) {
    const std::vector<std::uint32_t> leaves = trial.tree.leaves();
    const std::set<std::uint32_t> set(leaves.begin(), leaves.end());
    double area = 0;
    for (const std::uint32_t leaf : leaves) {
      area += std::pow(trial.tree.side_mm(Quadtree::level(leaf)), 2);
      for (std::uint32_t above = leaf; above != 0;) {
        above = Quadtree::parent(above);
        ASSERT_FALSE(set.contains(above));
      }
    }
    EXPECT_NEAR(area, std::pow(trial.tree.side_mm(0), 2), 1e-6);
  }
}

TEST(Quadtree, OnlyCellsThatTheOutlineTouchesAreSplit) {
  for (const Trial& trial : trials())
    for (std::uint32_t cell = 0; cell < trial.tree.size(); ++cell) {
      const Kind kind = trial.tree.kind(cell);
      if (kind == Kind::kTouched) {
        ASSERT_GE(outline_in(trial, cell, 1e-9), 0);
      }
      if (kind == Kind::kFree) {
        ASSERT_LT(outline_in(trial, cell, -1e-9), 0);
      }
      if (kind == Kind::kNothing) {
        ASSERT_NE(trial.tree.kind(Quadtree::parent(cell)), Kind::kTouched);
      }
    }
}

TEST(Quadtree, NeighboursAreThoseThatShareAStretch) {
  for (const Trial& trial : trials()) {
    const std::vector<std::uint32_t> leaves = trial.tree.leaves();
    std::set<std::array<std::uint32_t, 2>> found;
    for (const auto& [a, b] : trial.tree.neighbours(leaves))
      ASSERT_TRUE(found.insert({std::min(a, b), std::max(a, b)}).second) << "a pair twice";
    // In whole leaves, so that nothing is rounded.
    const auto square = [&](std::uint32_t leaf) {
      const Quadtree::Position at = Quadtree::position(leaf);
      const std::uint32_t side = 1U << (trial.tree.levels() - at.level);
      return std::array{at.column * side, at.row * side, (at.column + 1) * side,
                        (at.row + 1) * side};
    };
    std::size_t expected = 0;
    for (std::uint32_t i = 0; i < leaves.size(); ++i)
      for (std::uint32_t k = i + 1; k < leaves.size(); ++k) {
        const auto a = square(leaves[i]), b = square(leaves[k]);
        const bool over_x = a[0] < b[2] && b[0] < a[2], over_y = a[1] < b[3] && b[1] < a[3];
        const bool at_x = a[0] == b[2] || b[0] == a[2], at_y = a[1] == b[3] || b[1] == a[3];
        if (!(over_x && at_y) && !(over_y && at_x)) continue;
        ++expected;
        ASSERT_TRUE(found.contains({i, k}));
      }
    EXPECT_EQ(found.size(), expected);
  }
}

TEST(Quadtree, TheFloodIsWhatLiesInThePolygons) {
  for (const Trial& trial : trials()) {
    const EdgeGrid edges(trial.polygons);
    const std::vector<std::uint32_t> leaves = trial.tree.leaves();
    const std::vector<bool> found = inside(trial.tree, trial.rings, leaves);
    std::size_t count = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const Point2 centre = trial.tree.centre(leaves[i]);
      if (edges.distance_to_edge_mm(centre, 1e-6)) continue;
      ASSERT_EQ(found[i], edges.contains(centre)) << centre.x << ", " << centre.y;
      if (found[i]) ++count;
    }
    EXPECT_GT(count, 20U);
  }
}

}  // namespace
}  // namespace routebench::eulerian
