/// The rows of beads, against every point and on every kind of processor there is here.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "judge/capsule.hpp"
#include "judge/cell_field.hpp"
#include "judge/row_loops.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

using judging::Capsule;
using judging::CapsuleShape;
using judging::GridPart;
using judging::GridSize;
using judging::kWordBits;
using judging::RowLoops;
using judging::Segment;

/// Samples of a grid, strip by strip as in StripWords.
struct Samples {
  GridSize grid;
  std::vector<std::uint64_t> words;

  explicit Samples(GridSize size)
      : grid(size),
        words((size.columns + kWordBits - 1) / kWordBits * size.rows + judging::StripWords::kRoom) {
  }

  [[nodiscard]] bool test(std::size_t column, std::size_t row) const {
    return (words[column / kWordBits * grid.rows + row] >> (column % kWordBits) & 1U) != 0;
  }

  /// Adds a capsule's samples, each of which is to be in one part of the grid only.
  void add(const Capsule& capsule, const RowLoops& loops) {
    std::size_t next = 0;
    capsule.visit(grid, [&](const CapsuleShape& shape, const GridPart& part) {
      EXPECT_GE(part.first_row, next);
      EXPECT_LT(part.first_row, part.end_row);
      EXPECT_LT(part.first_word, part.end_word);
      next = part.end_row;
      ASSERT_LE(next, grid.rows);
      ASSERT_LE(part.end_word * grid.rows + judging::StripWords::kRoom, words.size());
      loops.add(shape, part, words.data(), grid.rows);
    });
  }
};

/// A segment of some kind or other: any, upright, level, a point, all but a point, short.
struct TestCapsule {
  Point2 a;
  Point2 b;
  double radius = 0;
};

TestCapsule random_capsule(std::mt19937_64& random, int kind, GridSize grid) {
  std::uniform_real_distribution<double> x(-30, static_cast<double>(grid.columns) + 30);
  std::uniform_real_distribution<double> y(-10, static_cast<double>(grid.rows) + 10);
  std::uniform_real_distribution<double> size(0.2, 12);
  TestCapsule capsule{{x(random), y(random)}, {x(random), y(random)}, size(random)};
  switch (kind % 7) {
    case 1:
      capsule.b.x = capsule.a.x;
      break;
    case 2:
      capsule.b.y = capsule.a.y;
      break;
    case 3:
      capsule.b = capsule.a;
      break;
    case 4:
      capsule.b = capsule.a + 1e-9 * (capsule.b - capsule.a);
      break;
    case 5:
      capsule.b = lerp(capsule.a, capsule.b, 0.05);
      break;
    case 6:
      capsule.radius *= 8;
      break;
    default:
      break;
  }
  return capsule;
}

TEST(JudgeCapsules, HoldExactlyThePointsInReach) {
  constexpr GridSize kGrid{100, 300};
  std::mt19937_64 random(3);
  for (int round = 0; round < 1400; ++round) {
    const auto [a, b, radius] = random_capsule(random, round, kGrid);
    for (const RowLoops* loops : judging::runnable_row_loops()) {
      Samples met(kGrid);
      met.add(Capsule(Segment(a, b), radius), *loops);
      for (std::size_t row = 0; row < kGrid.rows; ++row)
        for (std::size_t column = 0; column < kGrid.columns; ++column) {
          const Point2 p{static_cast<double>(column), static_cast<double>(row)};
          const double away = distance(p, nearest_on_segment(p, a, b));
          if (std::abs(away - radius) > 1e-6) {
            EXPECT_EQ(met.test(column, row), away < radius) << loops->name;
          }
        }
    }
  }
}

TEST(JudgeCapsules, WithoutTheirStartHoldAllBeyondTheDiscThere) {
  constexpr GridSize kGrid{100, 300};
  std::mt19937_64 random(9);
  for (int round = 0; round < 1400; ++round) {
    const auto [a, b, radius] = random_capsule(random, round, kGrid);
    for (const RowLoops* loops : judging::runnable_row_loops()) {
      Capsule capsule(Segment(a, b), radius);
      capsule.leave_start();
      Samples left_whole(kGrid);
      left_whole.add(capsule, *loops);
      capsule.cut_start();
      Samples met(kGrid);
      met.add(capsule, *loops);
      for (std::size_t row = 0; row < kGrid.rows; ++row)
        for (std::size_t column = 0; column < kGrid.columns; ++column) {
          const Point2 p{static_cast<double>(column), static_cast<double>(row)};
          const double away = distance(p, nearest_on_segment(p, a, b));
          if (std::abs(away - radius) < 1e-6 || std::abs(distance(p, a) - radius) < 1e-6) continue;
          EXPECT_EQ(met.test(column, row), away < radius && distance(p, a) > radius) << loops->name;
          // Rows that are left out lie in the disc.
          if (distance(p, a) > radius) {
            EXPECT_EQ(left_whole.test(column, row), away < radius) << loops->name;
          }
        }
    }
  }
}

TEST(JudgeCapsules, HaveStraightSidesHoweverLong) {
  // However long, steep, nearly level or far away: no error adds up along the sides, seen where
  // they cross a window.
  constexpr GridSize kGrid{200, 400};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t sides = 0;
  for (int round = 0; round < 1400; ++round) {
    const double scale = std::pow(10.0, 1 + round % 7);
    const Point2 run{scale * (unit(random) - 0.5),
                     round % 3 == 0 ? 200 * unit(random) : scale * unit(random)};
    const double radius = 2 + 6 * unit(random);
    const double length = distance({0, 0}, run);
    const double half_width = radius * length / run.y;
    // A place on a side, somewhere along it, comes into the window.
    const double share_there = unit(random);
    const double side = round % 2 == 0 ? half_width : -half_width;
    const Point2 there{400 * unit(random) - side, 200 * unit(random)};
    const Point2 a = there - share_there * run;
    const Point2 b = a + run;
    Samples met(kGrid);
    met.add(Capsule(Segment(a, b), radius), judging::row_loops());
    const double rise = radius * std::abs(run.x) / length / run.y;
    const double off = 1e-12 * (scale + half_width) + 1e-9;
    for (std::size_t row = 0; row < kGrid.rows; ++row) {
      const double share = (static_cast<double>(row) - a.y) / (b - a).y;
      if (share < rise || share > 1 - rise) continue;  // on an arc
      const double middle = lerp(a, b, share).x;
      for (std::size_t column = 0; column < kGrid.columns; ++column) {
        const double away = std::abs(static_cast<double>(column) - middle);
        if (std::abs(away - half_width) > off) {
          EXPECT_EQ(met.test(column, row), away < half_width);
        }
      }
      for (const double x : {middle - half_width, middle + half_width})
        if (x > 0 && x < static_cast<double>(kGrid.columns)) ++sides;
    }
  }
  EXPECT_GT(sides, 20000U);
}

TEST(JudgeCapsules, CoverTheirRowsBeyondAllMeasure) {
  constexpr double kFar = 2e10;  // steps in 1e9 mm
  constexpr GridSize kGrid{101, 100001};
  for (const double rise : {0.0, 1e-10, 1e-6, 1.0, 100.0, kFar}) {
    const Segment segment({-kFar, 50.5 - rise / 2}, {kFar, 50.5 + rise / 2});
    Samples met(kGrid);
    met.add(Capsule(segment, kFar / 2), judging::row_loops());
    std::size_t count = 0;
    for (const std::uint64_t word : met.words)
      count += static_cast<std::size_t>(std::popcount(word));
    EXPECT_EQ(count, kGrid.rows * kGrid.columns) << rise;
  }
}

/// The loops of this processor beside the plain ones.
std::vector<const RowLoops*> other_loops() {
  std::vector<const RowLoops*> loops = judging::runnable_row_loops();
  loops.erase(loops.begin());
  return loops;
}

/// Any numbers: no capsule need have them.
CapsuleShape random_shape(std::mt19937_64& random, int round) {
  const auto number = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  CapsuleShape shape{.low_x = number(-100, 600),
                     .low_y = number(-10, 70),
                     .high_x = number(-100, 600),
                     .high_y = number(-10, 70),
                     .radius = number(0, round % 2 == 0 ? 6 : 200),
                     .slope = number(-10, 10),
                     .half_width = number(0, round % 5 == 0 ? 1000 : 10),
                     .left = {number(-10, 70), number(-10, 70)},
                     .right = {number(-10, 70), number(-10, 70)},
                     .begins_low = random() % 2 == 0,
                     .is_cut = random() % 2 == 0};
  if (round % 3 == 0)  // ties
    for (double* tied :
         {&shape.low_x, &shape.low_y, &shape.half_width, &shape.slope, &shape.radius})
      *tied = std::round(*tied);
  return shape;
}

GridPart random_part(std::mt19937_64& random, GridSize grid) {
  GridPart part;
  part.columns = grid.columns;
  part.first_row = random() % grid.rows;
  part.end_row = part.first_row + 1 + random() % (grid.rows - part.first_row);
  const std::size_t strips = (grid.columns + kWordBits - 1) / kWordBits;
  part.first_word = random() % strips;
  part.end_word = part.first_word + 1 + random() % (strips - part.first_word);
  return part;
}

TEST(JudgeRowLoops, DrawTheSameOnEveryProcessor) {
  constexpr GridSize kGrid{64, 500};
  std::mt19937_64 random(21);
  for (const RowLoops* loops : other_loops())
    for (int round = 0; round < 4000; ++round) {
      const CapsuleShape shape = random_shape(random, round);
      const GridPart part = random_part(random, kGrid);
      const auto drawn = [&](const RowLoops& drawn_by) {
        Samples samples(kGrid);
        drawn_by.add(shape, part, samples.words.data(), kGrid.rows);
        return samples.words;
      };
      EXPECT_EQ(drawn(judging::kPlainLoops), drawn(*loops)) << loops->name;
    }
}

/// Any words, most of them with some bits.
std::vector<std::uint64_t> random_words(std::mt19937_64& random, std::size_t size) {
  std::vector<std::uint64_t> words(size);
  for (std::uint64_t& word : words)
    if (random() % 4 > 0) word = random() & random();
  return words;
}

TEST(JudgeRowLoops, AddAndRemoveTheSameSamples) {
  constexpr GridSize kGrid{64, 500};
  std::mt19937_64 random(25);
  for (const RowLoops* loops : judging::runnable_row_loops())
    for (int round = 0; round < 600; ++round) {
      const CapsuleShape shape = random_shape(random, round);
      const GridPart part = random_part(random, kGrid);
      const std::size_t rows = kGrid.rows;
      Samples meant(kGrid);
      loops->add(shape, part, meant.words.data(), rows);
      for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < kGrid.columns; ++column)
          if (meant.test(column, row)) {
            EXPECT_TRUE(part.first_row <= row && row < part.end_row) << loops->name;
            EXPECT_TRUE(part.first_word <= column / kWordBits && column / kWordBits < part.end_word)
                << loops->name;
          }
      const std::size_t size = meant.words.size();
      const std::vector<std::uint64_t> before = random_words(random, size);
      const std::vector<std::uint64_t> again_before = random_words(random, size);
      std::vector<std::uint64_t> added = before;
      loops->add(shape, part, added.data(), rows);
      std::vector<std::uint64_t> removed = before;
      loops->remove(shape, part, removed.data(), rows);
      std::vector<std::uint64_t> once = before;
      std::vector<std::uint64_t> again = again_before;
      const bool met = loops->add_counting(shape, part, once.data(), again.data(), rows);
      bool any_met = false;
      for (std::size_t i = 0; i < size; ++i) {
        const std::uint64_t mask = meant.words[i];
        any_met = any_met || (before[i] & mask) != 0;
        ASSERT_EQ(added[i], before[i] | mask) << loops->name;
        ASSERT_EQ(removed[i], before[i] & ~mask) << loops->name;
        ASSERT_EQ(once[i], before[i] | mask) << loops->name;
        ASSERT_EQ(again[i], again_before[i] | (before[i] & mask)) << loops->name;
      }
      EXPECT_EQ(met, any_met) << loops->name;
    }
}

TEST(JudgeRowLoops, FlipWordsFromALineOn) {
  std::mt19937_64 random(27);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const RowLoops* loops : judging::runnable_row_loops())
    for (int round = 0; round < 500; ++round) {
      const std::size_t rows = 1 + random() % 70;
      const std::size_t strips = 1 + random() % 5;
      const std::size_t begin = random() % rows;
      const std::size_t end = begin + 1 + random() % (rows - begin);
      const std::size_t first_strip = random() % strips;
      const std::size_t end_strip = first_strip + 1 + random() % (strips - first_strip);
      judging::LineShape line{400 * unit(random) - 50, 70 * unit(random), 20 * unit(random) - 10};
      if (round % 4 == 0) line = {std::round(line.x), std::round(line.y), std::round(line.slope)};
      const std::size_t size = strips * rows + judging::StripWords::kRoom;
      std::vector<std::uint64_t> words = random_words(random, size);
      std::vector<std::uint64_t> expected = words;
      for (std::size_t row = begin; row < end; ++row) {
        const auto column =
            static_cast<std::size_t>(std::ceil(std::max(line.at(static_cast<double>(row)), 0.0)));
        const std::size_t strip = column / kWordBits;
        if (first_strip <= strip && strip < end_strip)
          expected[strip * rows + row] ^= ~std::uint64_t{0} << (column % kWordBits);
      }
      loops->flip(line, begin, end, first_strip, end_strip, words.data(), rows);
      EXPECT_EQ(words, expected) << loops->name;
    }
}

TEST(JudgeRowLoops, FillWordsWhoseCarryIsSet) {
  std::mt19937_64 random(26);
  for (const RowLoops* loops : judging::runnable_row_loops())
    for (std::size_t rows = 0; rows < 40; ++rows) {
      const std::vector<std::uint64_t> flips = random_words(random, rows);
      std::vector<std::uint64_t> carry(rows);
      for (std::uint64_t& word : carry) word = random() % 2 == 0 ? 0 : ~std::uint64_t{0};
      const std::vector<std::uint64_t> before = carry;
      std::vector<std::uint64_t> words = flips;
      loops->fill(words.data(), carry.data(), rows);
      for (std::size_t i = 0; i < rows; ++i) {
        EXPECT_EQ(words[i], flips[i] ^ before[i]) << loops->name;
        EXPECT_EQ(carry[i], words[i] >> 63U == 0 ? 0 : ~std::uint64_t{0}) << loops->name;
      }
    }
}

TEST(JudgeRowLoops, CountUsedWords) {
  std::mt19937_64 random(22);
  for (const RowLoops* loops : judging::runnable_row_loops())
    for (int round = 0; round < 200; ++round) {
      const std::size_t rows = 1 + random() % 400;
      const std::size_t strips = 1 + random() % 6;
      const std::size_t size = strips * rows + judging::StripWords::kRoom;
      std::vector<std::uint64_t> words(size);
      const std::vector<std::uint64_t> with = random_words(random, size);
      const std::vector<std::uint64_t> without = random_words(random, size);
      std::vector<judging::StripWords::Rows> used(strips);
      std::size_t all = 0;
      std::size_t both = 0;
      std::size_t rest = 0;
      for (std::size_t strip = 0; strip < strips; ++strip) {
        used[strip] = {random() % rows, random() % (rows + 1)};  // some have none
        for (std::size_t row = used[strip].first; row < used[strip].end; ++row) {
          const std::size_t i = strip * rows + row;
          words[i] = round % 3 == 0 ? ~std::uint64_t{0} : random();
          const auto bits = [](std::uint64_t word) {
            return static_cast<std::size_t>(std::popcount(word));
          };
          all += bits(words[i]);
          both += bits(words[i] & with[i]);
          rest += bits(words[i] & with[i] & ~without[i]);
        }
      }
      const judging::StripWords plane{words.data(), rows, strips, used.data()};
      EXPECT_EQ(loops->count(plane, nullptr, nullptr), all) << loops->name;
      EXPECT_EQ(loops->count(plane, with.data(), nullptr), both) << loops->name;
      EXPECT_EQ(loops->count(plane, with.data(), without.data()), rest) << loops->name;
    }
}

TEST(JudgeRowLoops, AddWeightedRowsInTheirOrder) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<float> number(0, 1000);
  for (const RowLoops* loops : judging::runnable_row_loops())
    for (std::size_t count = 0; count < 50; ++count) {
      const std::size_t terms = random() % 12;
      std::vector<std::vector<float>> rows(terms);
      std::vector<const float*> from;
      std::vector<float> weights;
      for (std::vector<float>& row : rows) {
        row.resize(count + RowLoops::kFloatRoom);
        for (float& value : row) value = number(random);
        from.push_back(row.data());
        weights.push_back(number(random));
      }
      std::vector<float> sums(count + RowLoops::kFloatRoom);
      loops->weighted_sum(from.data(), weights.data(), terms, sums.data(), count);
      for (std::size_t i = 0; i < count; ++i) {
        float expected = 0;
        for (std::size_t term = 0; term < terms; ++term) expected += weights[term] * from[term][i];
        EXPECT_EQ(sums[i], expected) << loops->name;
      }
    }
}

TEST(JudgeCellField, MeansAreWeightedByATent) {
  std::mt19937_64 random(24);
  std::uniform_real_distribution<float> number(0, 100);
  for (std::size_t round = 0; round < 60; ++round) {
    const std::size_t columns = 1 + random() % 40;
    const std::size_t rows = 1 + random() % 30;
    const std::size_t reach = 1 + random() % 8;
    judging::CellField field(columns, rows);
    std::vector<judging::Columns> wanted(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column)
        field.at(column, row) = random() % 3 == 0 ? 0 : number(random);
      if (random() % 4 > 0) wanted[row] = {random() % columns, random() % (columns + 1)};
    }
    judging::NeighbourhoodMeans means(field, reach, wanted);
    for (std::size_t row = 0; row < rows; ++row) {
      const std::span<const float> found = means.row(row);
      ASSERT_EQ(found.size(), wanted[row].empty() ? 0 : wanted[row].end - wanted[row].first);
      for (std::size_t i = 0; i < found.size(); ++i) {
        const std::size_t column = wanted[row].first + i;
        double sum = 0;
        for (std::size_t y = 0; y < rows; ++y)
          for (std::size_t x = 0; x < columns; ++x) {
            const auto weight = [reach](std::size_t p, std::size_t q) {
              const std::size_t away = p < q ? q - p : p - q;
              return away < reach ? static_cast<double>(reach - away) : 0.0;
            };
            sum += weight(x, column) * weight(y, row) * static_cast<double>(field.at(x, y));
          }
        EXPECT_NEAR(static_cast<double>(found[i]), sum / std::pow(static_cast<double>(reach), 4),
                    1e-3);
      }
    }
  }
}

}  // namespace
}  // namespace routebench
