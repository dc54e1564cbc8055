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
using judging::GridSize;
using judging::kWordBits;
using judging::RowLoops;
using judging::RowSpans;
using judging::Segment;

/// Whether a column is meant by a row.
bool holds(const RowSpans& rows, std::size_t i, std::size_t column) {
  const auto c = static_cast<std::int64_t>(column);
  return rows.left[i] <= c && c < rows.end[i] &&
         !(rows.is_cut && rows.cut_left[i] <= c && c < rows.cut_end[i]);
}

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
    std::vector<std::vector<bool>> met(kGrid.rows, std::vector<bool>(kGrid.columns));
    std::size_t next = 0;
    Capsule(Segment(a, b), radius).visit(kGrid, [&](const RowSpans& rows) {
      EXPECT_GE(rows.first_row, next);  // each once, upwards
      next = rows.first_row + rows.count;
      ASSERT_LE(next, kGrid.rows);
      for (std::size_t i = rows.count; i < rows.count + RowSpans::kRoom; ++i)
        EXPECT_LE(rows.end[i], rows.left[i]);
      for (std::size_t i = 0; i < rows.count; ++i)
        for (std::size_t column = 0; column < kGrid.columns; ++column)
          if (holds(rows, i, column)) {
            met[rows.first_row + i][column] = true;
            EXPECT_GE(column / kWordBits, rows.first_word);
            EXPECT_LT(column / kWordBits, rows.end_word);
          }
    });
    for (std::size_t row = 0; row < kGrid.rows; ++row)
      for (std::size_t column = 0; column < kGrid.columns; ++column) {
        const Point2 p{static_cast<double>(column), static_cast<double>(row)};
        const double away = distance(p, nearest_on_segment(p, a, b));
        if (std::abs(away - radius) > 1e-6) {
          EXPECT_EQ(met[row][column], away < radius);
        }
      }
  }
}

TEST(JudgeCapsules, WithoutTheirStartHoldAllBeyondTheDiscThere) {
  constexpr GridSize kGrid{100, 300};
  std::mt19937_64 random(9);
  for (int round = 0; round < 1400; ++round) {
    const auto [a, b, radius] = random_capsule(random, round, kGrid);
    std::vector<std::vector<bool>> met(kGrid.rows, std::vector<bool>(kGrid.columns));
    std::vector<std::vector<bool>> left_whole = met;
    Capsule capsule(Segment(a, b), radius);
    capsule.leave_start();
    const auto note = [&kGrid](std::vector<std::vector<bool>>& noted, const RowSpans& rows) {
      for (std::size_t i = 0; i < rows.count; ++i)
        for (std::size_t column = 0; column < kGrid.columns; ++column)
          if (holds(rows, i, column)) noted[rows.first_row + i][column] = true;
    };
    capsule.visit(kGrid, [&](RowSpans& rows) {
      note(left_whole, rows);
      capsule.cut_start(rows);
      note(met, rows);
    });
    for (std::size_t row = 0; row < kGrid.rows; ++row)
      for (std::size_t column = 0; column < kGrid.columns; ++column) {
        const Point2 p{static_cast<double>(column), static_cast<double>(row)};
        const double away = distance(p, nearest_on_segment(p, a, b));
        if (std::abs(away - radius) < 1e-6 || std::abs(distance(p, a) - radius) < 1e-6) continue;
        EXPECT_EQ(met[row][column], away < radius && distance(p, a) > radius);
        // Rows that are left out lie in the disc.
        if (distance(p, a) > radius) {
          EXPECT_EQ(left_whole[row][column], away < radius);
        }
      }
  }
}

TEST(JudgeCapsules, HaveStraightSidesHoweverLong) {
  // However long, steep, nearly level or far away: no error adds up along the sides.
  constexpr GridSize kGrid{4000, 20000000};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t sides = 0;
  for (int round = 0; round < 400; ++round) {
    const double scale = std::pow(10.0, 1 + round % 7);
    const Point2 a{scale * unit(random), 4000 * unit(random)};
    const Point2 b{scale * unit(random), round % 3 == 0 ? a.y + unit(random) : 4000 * unit(random)};
    const double radius = 2 + 6 * unit(random);
    const Point2 run = b - a;
    const double half_width = radius * distance(a, b) / std::abs(run.y);
    const double rise = radius * std::abs(run.x) / distance(a, b) / std::abs(run.y);
    Capsule(Segment(a, b), radius).visit(kGrid, [&](const RowSpans& rows) {
      for (std::size_t i = 0; i < rows.count; ++i) {
        const double share = (static_cast<double>(rows.first_row + i) - a.y) / run.y;
        if (share < rise || share > 1 - rise) continue;  // on an arc
        const Point2 middle = lerp(a, b, share);
        const double off = 1e-12 * (scale + half_width) + 1e-9;
        const double left = std::max(middle.x - half_width, 0.0);
        const double right =
            std::min(middle.x + half_width, static_cast<double>(kGrid.columns - 1));
        EXPECT_GE(static_cast<double>(rows.left[i]), left - off);
        EXPECT_LT(static_cast<double>(rows.left[i]), left + 1 + off);
        EXPECT_LE(static_cast<double>(rows.end[i] - 1), right + off);
        EXPECT_GT(static_cast<double>(rows.end[i] - 1), right - 1 - off);
        ++sides;
      }
    });
  }
  EXPECT_GT(sides, 100000U);
}

TEST(JudgeCapsules, CoverTheirRowsBeyondAllMeasure) {
  constexpr double kFar = 2e10;  // steps in 1e9 mm
  constexpr GridSize kGrid{101, 4000001};
  for (const double rise : {0.0, 1e-10, 1e-6, 1.0, 100.0, kFar}) {
    std::size_t row_count = 0;
    const Segment segment({-kFar, 50.5 - rise / 2}, {kFar, 50.5 + rise / 2});
    Capsule(segment, kFar / 2).visit(kGrid, [&](const RowSpans& rows) {
      for (std::size_t i = 0; i < rows.count; ++i) {
        EXPECT_EQ(rows.left[i], 0) << rise;
        EXPECT_EQ(rows.end[i], 4000001) << rise;
      }
      row_count += rows.count;
    });
    EXPECT_EQ(row_count, kGrid.rows) << rise;
  }
}

/// The loops of this processor beside the plain ones.
std::vector<const RowLoops*> other_loops() {
  std::vector<const RowLoops*> loops = judging::runnable_row_loops();
  loops.erase(loops.begin());
  return loops;
}

TEST(JudgeRowLoops, CutExactlyTheDisc) {
  std::mt19937_64 random(28);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const RowLoops* loops : judging::runnable_row_loops())
    for (int round = 0; round < 200; ++round) {
      Point2 centre{100 * unit(random), 60 * unit(random)};
      if (round % 3 == 0) centre.x = std::round(centre.x);
      const double radius = round % 2 == 0 ? 40 * unit(random) : unit(random);
      RowSpans rows;
      rows.first_row = 5;
      rows.count = 1 + random() % RowSpans::kMost;
      const std::size_t begin = random() % rows.count;
      const std::size_t end = begin + 1 + random() % (rows.count - begin);
      loops->cut_disc({centre.x, centre.y, radius * radius}, begin, end, rows);
      EXPECT_TRUE(rows.is_cut);
      for (std::size_t i = 0; i < end; ++i)
        for (std::int64_t column = -50; column < 150; ++column) {
          const Point2 p{static_cast<double>(column), static_cast<double>(rows.first_row + i)};
          const double away = distance(p, centre);
          if (std::abs(away - radius) < 1e-6) continue;
          EXPECT_EQ(rows.cut_left[i] <= column && column < rows.cut_end[i],
                    i >= begin && away < radius)
              << loops->name;
        }
    }
}

TEST(JudgeRowLoops, DrawTheSameOnEveryProcessor) {
  constexpr GridSize kGrid{64, 500};
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const RowLoops* loops : other_loops())
    for (int round = 0; round < 2000; ++round) {
      // Any numbers: no capsule need have them.
      const auto number = [&](double from, double to) { return from + (to - from) * unit(random); };
      judging::CapsuleShape shape{.low_x = number(-100, 600),
                                  .low_y = number(-10, 70),
                                  .high_x = number(-100, 600),
                                  .high_y = number(-10, 70),
                                  .square = number(0, round % 2 == 0 ? 30 : 30000),
                                  .slope = number(-10, 10),
                                  .half_width = number(0, round % 5 == 0 ? 1000 : 10),
                                  .left = {number(-10, 70), number(-10, 70)},
                                  .right = {number(-10, 70), number(-10, 70)}};
      if (round % 3 == 0) shape.low_x = std::round(shape.low_x);  // ties
      if (round % 3 == 0) shape.half_width = std::round(shape.half_width);
      if (round % 3 == 0) shape.slope = std::round(shape.slope);
      if (round % 3 == 0) shape.low_y = std::round(shape.low_y);
      const judging::DiscShape disc{shape.low_x, shape.low_y, shape.square};
      const auto begin = static_cast<std::size_t>(number(0, 20));
      const auto end = begin + static_cast<std::size_t>(number(1, 40));
      const auto draw = [&](const RowLoops& drawn_by, bool straight) {
        RowSpans rows;
        rows.first_row = static_cast<std::size_t>(round % 7);
        rows.count = kGrid.rows;
        (straight ? drawn_by.straight_rows : drawn_by.rows)(shape, kGrid.columns, begin, end, rows);
        drawn_by.cut_disc(disc, begin, end, rows);
        std::vector<std::int64_t> all;
        for (std::size_t i = begin; i < end; ++i)
          all.insert(all.end(), {rows.left[i], rows.end[i], rows.cut_left[i], rows.cut_end[i]});
        return all;
      };
      for (const bool straight : {false, true})
        EXPECT_EQ(draw(judging::kPlainLoops, straight), draw(*loops, straight)) << loops->name;
    }
}

/// Any words, most of them with some bits.
std::vector<std::uint64_t> random_words(std::mt19937_64& random, std::size_t size) {
  std::vector<std::uint64_t> words(size);
  for (std::uint64_t& word : words)
    if (random() % 4 > 0) word = random() & random();
  return words;
}

TEST(JudgeRowLoops, AddAndRemoveWhatSpansHold) {
  std::mt19937_64 random(25);
  for (const RowLoops* loops : judging::runnable_row_loops())
    for (int round = 0; round < 300; ++round) {
      const std::size_t rows = 70 + random() % 30;
      const std::size_t strips = 1 + random() % 5;
      RowSpans spans;
      spans.count = 1 + random() % RowSpans::kMost;
      spans.first_row = random() % (rows - spans.count + 1);
      spans.first_word = random() % strips;
      spans.end_word = spans.first_word + 1 + random() % (strips - spans.first_word);
      spans.is_cut = random() % 2 == 0;
      std::fill_n(spans.left + spans.count, RowSpans::kRoom, 0);
      std::fill_n(spans.end + spans.count, RowSpans::kRoom, 0);
      for (std::size_t i = 0; i < spans.count; ++i) {
        const auto column = [&](std::size_t beyond) {
          const std::size_t first = spans.first_word * kWordBits;
          const std::size_t size = (spans.end_word - spans.first_word) * kWordBits;
          return static_cast<std::int64_t>(first + random() % (size + 1 + 2 * beyond)) -
                 static_cast<std::int64_t>(beyond);
        };
        spans.left[i] = column(0);
        spans.end[i] = column(0);  // often none
        spans.cut_left[i] = column(100);
        spans.cut_end[i] = column(100);
      }
      const std::size_t size = strips * rows + judging::StripWords::kRoom;
      const std::vector<std::uint64_t> before = random_words(random, size);
      const std::vector<std::uint64_t> again_before = random_words(random, size);
      std::vector<std::uint64_t> meant(size);
      for (std::size_t i = 0; i < spans.count; ++i)
        for (std::size_t column = 0; column < strips * kWordBits; ++column)
          if (holds(spans, i, column))
            meant[column / kWordBits * rows + spans.first_row + i] |= std::uint64_t{1}
                                                                      << (column % kWordBits);
      std::vector<std::uint64_t> added = before;
      loops->add(spans, added.data(), rows);
      std::vector<std::uint64_t> removed = before;
      loops->remove(spans, removed.data(), rows);
      std::vector<std::uint64_t> once = before;
      std::vector<std::uint64_t> again = again_before;
      const bool met = loops->add_counting(spans, once.data(), again.data(), rows);
      bool any_met = false;
      for (std::size_t i = 0; i < size; ++i) {
        any_met = any_met || (before[i] & meant[i]) != 0;
        ASSERT_EQ(added[i], before[i] | meant[i]) << loops->name;
        ASSERT_EQ(removed[i], before[i] & ~meant[i]) << loops->name;
        ASSERT_EQ(once[i], before[i] | meant[i]) << loops->name;
        ASSERT_EQ(again[i], again_before[i] | (before[i] & meant[i])) << loops->name;
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
