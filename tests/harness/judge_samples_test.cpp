/// Sets of samples, and the beads that are drawn into them, against every point.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

TEST(JudgeSamples, CapsuleRowsHoldExactlyThePointsInReach) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-5, 45);
  std::uniform_real_distribution<double> size(0.2, 12);
  for (int round = 0; round < 200; ++round) {
    Point2 a{place(random), place(random)};
    Point2 b{place(random), place(random)};
    if (round % 5 == 1) b.x = a.x;
    if (round % 5 == 2) b.y = a.y;
    if (round % 5 == 3) b = a;
    if (round % 5 == 4) b = a + 1e-9 * (b - a);
    const double radius = size(random);
    std::vector<judging::Span> rows(40);
    std::size_t next = 0;
    judging::visit_capsule_rows(a, b, radius, rows.size(),
                                [&](std::size_t row, judging::Span span) {
                                  EXPECT_GE(row, next);  // each once, upwards
                                  next = row + 1;
                                  rows.at(row) = span;
                                });
    for (std::size_t row = 0; row < rows.size(); ++row)
      for (int x = -20; x < 60; ++x) {
        const Point2 p{static_cast<double>(x), static_cast<double>(row)};
        const double away = distance(p, nearest_on_segment(p, a, b));
        if (std::abs(away - radius) > 1e-6) {
          EXPECT_EQ(rows[row].left <= x && x <= rows[row].right, away < radius);
        }
        if (std::abs(distance(p, a) - radius) > 1e-6) {
          const judging::Span disc = judging::disc_row(a.x, p.y - a.y, radius);
          EXPECT_EQ(disc.left <= x && x <= disc.right, distance(p, a) < radius);
        }
      }
  }
}

TEST(JudgeSamples, LongCapsulesHaveStraightSides) {
  // However long, steep, nearly level or far away: no error adds up along the sides.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t sides = 0;
  for (int round = 0; round < 400; ++round) {
    const double scale = std::pow(10.0, 1 + round % 7);
    const Point2 a{scale * unit(random), 4000 * unit(random)};
    const Point2 b{scale * unit(random), round % 3 == 0 ? a.y + unit(random) : 4000 * unit(random)};
    const double radius = 2 + 6 * unit(random);
    const Point2 run = b - a;
    judging::visit_capsule_rows(a, b, radius, 4000, [&](std::size_t row, judging::Span span) {
      const double share = (static_cast<double>(row) - a.y) / run.y;
      const double half_width = radius * distance(a, b) / std::abs(run.y);
      const double rise = radius * std::abs(run.x) / distance(a, b) / std::abs(run.y);
      if (share < rise || share > 1 - rise) return;  // on an arc
      const Point2 middle = lerp(a, b, share);
      const double off = 1e-12 * (scale + half_width) + 1e-9;
      EXPECT_GE(static_cast<double>(span.left), middle.x - half_width - off);
      EXPECT_LT(static_cast<double>(span.left), middle.x - half_width + 1 + off);
      EXPECT_LE(static_cast<double>(span.right), middle.x + half_width + off);
      EXPECT_GT(static_cast<double>(span.right), middle.x + half_width - 1 - off);
      ++sides;
    });
  }
  EXPECT_GT(sides, 100000U);
}

TEST(JudgeSamples, CapsulesBeyondAllMeasureCoverTheirRows) {
  constexpr double kFar = 2e10;  // steps in 1e9 mm
  for (const double rise : {0.0, 1e-10, 1e-6, 1.0, 100.0, kFar}) {
    int rows = 0;
    judging::visit_capsule_rows({-kFar, 50.5 - rise / 2}, {kFar, 50.5 + rise / 2}, kFar / 2, 101,
                                [&](std::size_t, judging::Span span) {
                                  EXPECT_LE(span.left, 0) << rise;
                                  EXPECT_GE(span.right, 4000000) << rise;
                                  ++rows;
                                });
    EXPECT_EQ(rows, 101) << rise;
  }
}

TEST(JudgeSamples, ATipIsInTheDiscThere) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> place(5, 35);
  for (int round = 0; round < 200; ++round) {
    const Point2 a{place(random), place(random)};
    Point2 b{place(random), place(random)};
    if (round % 4 == 1) b.x = a.x;
    if (round % 4 == 2) b.y = a.y;
    if (round % 4 == 3) b = lerp(a, b, 0.05);
    const double radius = 0.2 + 5 * place(random) / 35;
    std::vector<judging::Span> all(40);
    std::vector<judging::Span> rest(40);
    judging::CapsuleRows rows(a, b, radius);
    rows.visit(40, [&](std::size_t row, judging::Span span) { all[row] = span; });
    rows.leave_tip(a);
    rows.visit(40, [&](std::size_t row, judging::Span span) { rest[row] = span; });
    for (std::size_t row = 0; row < all.size(); ++row) {
      const double dy = static_cast<double>(row) - a.y;
      const judging::Span left = rest[row].empty() ? judging::disc_row(a.x, dy, radius) : rest[row];
      if (all[row].empty()) {
        EXPECT_TRUE(left.empty());
      } else {
        EXPECT_EQ(left.left, all[row].left);
        EXPECT_EQ(left.right, all[row].right);
      }
    }
  }
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
    for (int i = 0; i < count; ++i) {
      const Point2 a{x(random), y(random)};
      const Point2 b = lerp(a, {x(random), y(random)}, 0.05);
      judging::visit_capsule_rows(
          grid.to_steps(a), grid.to_steps(b), grid.to_steps(0.4), grid.rows(),
          [&](std::size_t row, judging::Span span) { added.add(row, span.left, span.right); });
      left.remove(a, b, 0.4);
    }
    EXPECT_EQ(left.count(), all.count([](Word p, Word q) { return p & ~q; }, added)) << count;
    EXPECT_EQ(left.count() == 0, count == kEnoughForAll);
  }
}

TEST(JudgeSamples, PlanesHoldExactlyThePointsInside) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Polygons polygons = test::random_polygons(seed, 6, 10);
    const EdgeGrid edges(polygons);
    const judging::SampleGrid grid(polygons, 0.5, 0.13, 1e6);
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
    EXPECT_EQ(empty.count([](auto) { return ~judging::BitPlane::Word{0}; }), 0U);
    for (std::size_t row = 0; row < grid.rows(); ++row)
      EXPECT_TRUE(std::all_of(empty.row(row), empty.row(row) + (grid.columns() + 63) / 64,
                              [](auto word) { return word == 0; }));
    judging::BitPlane plane(grid, polygons);
    judging::BitPlane twice(grid);
    for (std::size_t row = 0; row < grid.rows(); ++row) {
      plane.add(row, 3, 90);
      plane.add_counting(row, 40, 1e9, twice);
    }
    EXPECT_GT(twice.count(), 0U);
  }
}

}  // namespace
}  // namespace routebench
