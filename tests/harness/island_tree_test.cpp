#include "island_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "random_polygons.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

double squared_distance_to(const Polygon& island, Point2 p) {
  double best = std::numeric_limits<double>::infinity();
  const auto look = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      best = std::min(
          best, squared_distance(p, nearest_on_segment(p, ring[i], ring[(i + 1) % ring.size()])));
  };
  look(island.outer);
  for (const Ring& hole : island.holes) look(hole);
  return best;
}

/// Islands within islands' holes, beside each other and of many sizes.
Polygons crowd(std::uint64_t seed) {
  Polygons crowd = test::random_polygons(seed, 12, 60);
  for (int i = 0; i < 40; ++i)
    crowd.push_back({test::rectangle(85 + 3 * (i % 8), 3 * (i / 8), 87 + 3 * (i % 8),
                                     3 * (i / 8) + 0.1 + 0.04 * i),
                     {}});
  crowd.push_back({test::rectangle(-30, -30, 120, 120),
                   {{{-29, -29}, {-29, 119}, {119, 119}, {119, -29}}}});  // a frame around all
  return crowd;
}

TEST(IslandTree, TakesIslandsInTheOrderOfAPlainSearch) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Polygons islands = crowd(seed);
    IslandTree tree(islands);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-20, 120);
    std::vector<std::size_t> left(islands.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
    while (!left.empty()) {
      const Point2 nozzle{place(random), place(random)};
      const auto expected = std::min_element(left.begin(), left.end(), [&](auto i, auto k) {
        return squared_distance_to(islands[i], nozzle) < squared_distance_to(islands[k], nozzle);
      });
      ASSERT_EQ(tree.nearest(nozzle), *expected) << "seed " << seed;
      tree.take(*expected);
      left.erase(expected);
    }
    EXPECT_FALSE(tree.nearest({0, 0}));
  }
}

TEST(IslandTree, OfEquallyNearIslandsTheFirstIsTaken) {
  Polygons islands;
  for (const double x : {20.0, -30.0, 20.0, -30.0})
    islands.push_back(
        {test::rectangle(x, islands.size() > 1 ? 5 : -15, x + 10, islands.size() > 1 ? 15 : -5),
         {}});
  IslandTree tree(islands);
  for (const std::size_t expected : {0u, 1u, 2u, 3u}) {
    ASSERT_EQ(tree.nearest({0, 0}), expected);
    tree.take(expected);
  }
}

TEST(IslandTree, PutsEveryRegionOnTheIslandItIsPartOf) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Polygons islands = crowd(seed);
    const IslandTree tree(islands);
    for (std::size_t i = 0; i < islands.size(); ++i) {
      EXPECT_EQ(tree.island_of(islands[i]), i) << "an island is part of itself, seed " << seed;
      for (const Polygon& part : offset({islands[i]}, -0.04)) EXPECT_EQ(tree.island_of(part), i);
      const Box2 box = bounding_box(islands[i]);
      const double middle = (box.lower.x + box.upper.x) / 2;
      const Polygons left =
          intersect({islands[i]}, {{test::rectangle(-100, -100, middle, 200), {}}});
      for (const Polygon& part : left) EXPECT_EQ(tree.island_of(part), i) << "seed " << seed;
    }
  }
}

TEST(IslandTree, TouchingIslandsAreToldApart) {
  // A checkerboard: islands that meet in corners.
  Polygons islands;
  for (int row = 0; row < 6; ++row)
    for (int column = row % 2; column < 6; column += 2)
      islands.push_back({test::rectangle(column, row, column + 1, row + 1), {}});
  const IslandTree tree(islands);
  for (std::size_t i = 0; i < islands.size(); ++i) EXPECT_EQ(tree.island_of(islands[i]), i);
}

TEST(IslandTree, OfNoIslandsNoneIsNearest) { EXPECT_FALSE(IslandTree({}).nearest({1, 2})); }

}  // namespace
}  // namespace routebench
