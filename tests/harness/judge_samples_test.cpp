/// Sets of samples, and the beads that are drawn into them, against every point.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "judge/bit_plane.hpp"
#include "judge/capsule.hpp"
#include "judge/sample_grid.hpp"
#include "judge/samples_left.hpp"
#include "random_polygons.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

/// All points within radius_mm of segment ab.
void draw(judging::BitPlane& plane, Point2 a, Point2 b, double radius_mm,
          judging::BitPlane* again = nullptr) {
  const judging::SampleGrid& grid = plane.grid();
  const judging::Capsule capsule(judging::Segment(grid.to_steps(a), grid.to_steps(b)),
                                 grid.to_steps(radius_mm));
  if (again != nullptr)
    plane.add_counting(capsule, *again);
  else
    plane.add(capsule);
}

TEST(JudgeSamples, PlanesHoldWhatIsDrawnOnceAndMore) {
  const Polygons polygons = test::random_polygons(4, 3, 5);
  const judging::SampleGrid grid(polygons, 0.5, 0.05, 1e6);
  const Box2 box = bounding_box(polygons);
  std::mt19937_64 random(17);
  // Some reach beyond the grid.
  std::uniform_real_distribution<double> x(box.lower.x - 2, box.upper.x + 2);
  std::uniform_real_distribution<double> y(box.lower.y - 2, box.upper.y + 2);
  judging::BitPlane added(grid);
  judging::BitPlane once(grid);
  judging::BitPlane more(grid);
  std::vector<int> times(grid.columns() * grid.rows());
  std::size_t count_once = 0;
  std::size_t count_more = 0;
  for (int i = 0; i < 40; ++i) {
    const Point2 a{x(random), y(random)};
    const Point2 b{x(random), y(random)};
    const double radius_mm = i % 10 == 0 ? 2.5 : 0.2;
    judging::BitPlane one(grid);
    draw(one, a, b, radius_mm);
    draw(added, a, b, radius_mm);
    draw(once, a, b, radius_mm, &more);
    for (std::size_t row = 0; row < grid.rows(); ++row)
      for (std::size_t column = 0; column < grid.columns(); ++column)
        if (one.test(column, row)) ++times[row * grid.columns() + column];
  }
  for (std::size_t row = 0; row < grid.rows(); ++row)
    for (std::size_t column = 0; column < grid.columns(); ++column) {
      const int drawn = times[row * grid.columns() + column];
      EXPECT_EQ(added.test(column, row), drawn > 0);
      EXPECT_EQ(once.test(column, row), drawn > 0);
      EXPECT_EQ(more.test(column, row), drawn > 1);
      count_once += drawn > 0 ? 1 : 0;
      count_more += drawn > 1 ? 1 : 0;
    }
  EXPECT_GT(count_more, 0U);
  EXPECT_GT(count_once, count_more);
  EXPECT_EQ(once.count(), count_once);
  EXPECT_EQ(more.count(), count_more);
  EXPECT_EQ(added.count_in(more), count_more);
  EXPECT_EQ(added.count_in(once, more), count_once - count_more);
}

TEST(JudgeSamples, CapsulesTakeAwayWhatTheyWouldAdd) {
  const Polygons polygons = test::random_polygons(3, 6, 10);
  const judging::SampleGrid grid(polygons, 0.5, 0.05, 1e6);
  const judging::BitPlane all(grid, polygons);
  std::mt19937_64 random(7);
  const Box2 box = bounding_box(polygons);
  std::uniform_real_distribution<double> x(box.lower.x, box.upper.x);
  std::uniform_real_distribution<double> y(box.lower.y, box.upper.y);
  constexpr int kEnoughForAll = 20000;
  using Word = judging::BitPlane::Word;
  for (const int count : {1, 300, kEnoughForAll}) {
    judging::BitPlane added(grid);
    judging::SamplesLeft left(judging::BitPlane(all, [](Word p) { return p; }));
    judging::SamplesLeft by_paths(judging::BitPlane(all, [](Word p) { return p; }));
    std::vector<Point2> path;
    for (int i = 0; i < count; ++i) {
      const Point2 a = path.empty() ? Point2{x(random), y(random)} : path.back();
      const Point2 b = lerp(a, {x(random), y(random)}, 0.05);
      draw(added, a, b, 0.4);
      EXPECT_EQ(left.empty(), left.count() == 0);
      left.remove(a, b, 0.4);
      if (path.empty()) path.push_back(a);
      path.push_back(b);
      if (path.size() < 8 && i + 1 < count) continue;
      by_paths.remove(path, 0.4);
      path.clear();
    }
    EXPECT_EQ(by_paths.count(), left.count());
    EXPECT_EQ(left.empty(), left.count() == 0);
    EXPECT_EQ(left.count(), all.count() - all.count_in(added)) << count;
    EXPECT_EQ(left.count() == 0, count == kEnoughForAll);
  }
}

TEST(JudgeSamples, PlanesHoldExactlyThePointsInside) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Polygons polygons = test::random_polygons(seed, 6, 10);
    const EdgeGrid edges(polygons);
    // From two strips of columns to ten: some lie inside from end to end.
    const judging::SampleGrid grid(polygons, 0.5, seed % 2 == 0 ? 0.13 : 0.02, 1e6);
    const judging::BitPlane plane(grid, polygons);
    std::size_t inside = 0;
    std::mt19937_64 random(seed);
    const Box2 box = bounding_box(polygons);
    std::uniform_real_distribution<double> x(box.lower.x, box.upper.x);
    std::uniform_real_distribution<double> y(box.lower.y, box.upper.y);
    for (int i = 0; i < 2000; ++i) {
      // The sample nearest to a random point, if no boundary runs between the two.
      const Point2 p{x(random), y(random)};
      const Point2 step = grid.to_steps(p);
      if (edges.distance_to_edge_mm(p, 0.2) || step.x < 0 || step.y < 0 ||
          step.x >= static_cast<double>(grid.columns() - 1) ||
          step.y >= static_cast<double>(grid.rows() - 1))
        continue;
      const bool set = plane.test(static_cast<std::size_t>(std::round(step.x)),
                                  static_cast<std::size_t>(std::round(step.y)));
      EXPECT_EQ(set, edges.contains(p));
      inside += set ? 1 : 0;
    }
    EXPECT_GT(inside, 100U);
    EXPECT_NEAR(static_cast<double>(plane.count()) * grid.sample_mm2(), area_mm2(polygons),
                0.01 * area_mm2(polygons));
  }
}

TEST(JudgeSamples, PlanesHoldTheInsideOfEdgesAlongTheirRows) {
  // No row crosses two sides of such a rectangle.
  for (const double turn : {0.3, 0.3 + 1e-12, 0.3 + 1e-4}) {
    const Point2 along = 20 * Point2{std::cos(turn), std::sin(turn)};
    const Point2 across = 5 * Point2{-std::sin(turn), std::cos(turn)};
    const Polygons polygons{{.outer = {{0, 0}, along, along + across, across}, .holes = {}}};
    const judging::SampleGrid grid(polygons, 1, 0.05, 1e6);
    const judging::BitPlane plane(grid, polygons);
    EXPECT_NEAR(static_cast<double>(plane.count()) * grid.sample_mm2(), 100, 1) << turn;
    const Point2 middle = grid.to_steps(0.5 * (along + across));
    EXPECT_TRUE(plane.test(static_cast<std::size_t>(middle.x), static_cast<std::size_t>(middle.y)));
  }
}

TEST(JudgeSamples, ABoxHoldsASampleIfOneOfItsPlacesIsSet) {
  const Polygons polygons = test::random_polygons(2, 6, 10);
  const judging::SampleGrid grid(polygons, 0.5, 0.1, 1e6);
  const judging::BitPlane plane(grid, polygons);
  const auto columns = static_cast<std::int64_t>(grid.columns());
  const auto rows = static_cast<std::int64_t>(grid.rows());
  const auto any_by_one = [&](judging::Span box_rows, judging::Span box_columns) {
    for (std::int64_t row = std::max<std::int64_t>(box_rows.left, 0);
         row <= std::min(box_rows.right, rows - 1); ++row)
      for (std::int64_t column = std::max<std::int64_t>(box_columns.left, 0);
           column <= std::min(box_columns.right, columns - 1); ++column)
        if (plane.test(static_cast<std::size_t>(column), static_cast<std::size_t>(row)))
          return true;
    return false;
  };
  std::mt19937_64 random(11);
  std::uniform_int_distribution<std::int64_t> size(-1, 80);
  std::size_t with_samples = 0;
  constexpr std::size_t kBoxes = 2000;
  for (std::size_t i = 0; i < kBoxes; ++i) {
    // Some reach beyond the grid, lie there as a whole or hold no place at all.
    const std::int64_t row = std::uniform_int_distribution<std::int64_t>(-90, rows + 10)(random);
    const std::int64_t column =
        std::uniform_int_distribution<std::int64_t>(-90, columns + 10)(random);
    const judging::Span box_rows{row, row + size(random) / 8};
    const judging::Span box_columns{column, column + size(random)};
    EXPECT_EQ(plane.any(box_rows, box_columns), any_by_one(box_rows, box_columns));
    if (plane.any(box_rows, box_columns)) ++with_samples;
  }
  EXPECT_GT(with_samples, kBoxes / 10);
  EXPECT_LT(with_samples, kBoxes * 9 / 10);
}

TEST(JudgeSamples, PlanesBeginEmptyWhateverThoseBeforeHeld) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Polygons polygons = test::random_polygons(seed, 6, 10);
    // Without a margin: rows that are inside up to their ends.
    const judging::SampleGrid grid(polygons, 0, 0.11 / static_cast<double>(seed), 1e6);
    const judging::BitPlane empty(grid);
    EXPECT_EQ(empty.count(), 0U);
    for (std::size_t strip = 0; strip < empty.strips(); ++strip)
      for (std::size_t row = 0; row < grid.rows(); ++row) EXPECT_EQ(empty.word(strip, row), 0U);
    judging::BitPlane plane(grid, polygons);
    judging::BitPlane twice(grid);
    const Box2 box = bounding_box(polygons);
    draw(plane, box.lower, box.upper, 3, &twice);
    EXPECT_GT(twice.count(), 0U);
  }
}

}  // namespace
}  // namespace routebench
