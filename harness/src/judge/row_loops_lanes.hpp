#pragma once
// The loops of RowLoops, for files that compile them for one kind of processor each. All of it
// stays in such a file: were it in functions that other files have, too, the linker might keep the
// one for a processor that is not there.
//
// Several numbers at once, in vectors of the compiler's own. Sums, products and roots are rounded
// as they are one by one, so the results are the same whatever the processor.

#include <cstddef>
#include <cstdint>

#include "judge/row_loops.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace routebench::judging {
namespace {

#if defined(__AVX512F__)
constexpr const char* kName = "AVX-512";
constexpr std::size_t kLanes = 8;
#elif defined(__AVX2__)
constexpr const char* kName = "AVX2";
constexpr std::size_t kLanes = 4;
#else
constexpr const char* kName = "plain";
constexpr std::size_t kLanes = 2;
#endif
using Lanes = double __attribute__((vector_size(kLanes * 8)));
using WholeLanes = std::int64_t __attribute__((vector_size(kLanes * 8)));  // -1 is true
using WordLanes = std::uint64_t __attribute__((vector_size(kLanes * 8)));
using FloatLanes = float __attribute__((vector_size(kLanes * 8)));

Lanes lanes_of(double number) { return Lanes{} + number; }
WholeLanes bits_of(Lanes lanes) { return __builtin_bit_cast(WholeLanes, lanes); }
WordLanes words_of(WholeLanes lanes) { return __builtin_bit_cast(WordLanes, lanes); }
WholeLanes whole_of(WordLanes lanes) { return __builtin_bit_cast(WholeLanes, lanes); }
Lanes lesser(Lanes a, Lanes b) { return a < b ? a : b; }
Lanes greater(Lanes a, Lanes b) { return a > b ? a : b; }

template <typename Number>
void store(Number& first, WordLanes lanes) {
  __builtin_memcpy(&first, &lanes, sizeof(lanes));
}
template <typename Number>
WordLanes load(const Number& first) {
  WordLanes lanes;
  __builtin_memcpy(&lanes, &first, sizeof(lanes));
  return lanes;
}

bool any(WordLanes lanes) {
#if defined(__AVX512F__)
  const auto all = __builtin_bit_cast(__m512i, lanes);
  return _mm512_test_epi64_mask(all, all) != 0;
#elif defined(__AVX2__)
  const auto all = __builtin_bit_cast(__m256i, lanes);
  return _mm256_testz_si256(all, all) == 0;
#else
  return (lanes[0] | lanes[1]) != 0;
#endif
}

/// Of what rounding may have made negative.
Lanes square_root(Lanes square) {
  const Lanes a = greater(square, Lanes{});
#if defined(__AVX512F__)
  return _mm512_sqrt_pd(a);
#elif defined(__AVX2__)
  return _mm256_sqrt_pd(a);
#elif defined(__SSE2__)
  return _mm_sqrt_pd(a);
#else
  return Lanes{__builtin_sqrt(a[0]), __builtin_sqrt(a[1])};
#endif
}

// Next to this number there are only whole ones: to add it rounds to the nearest, which is then the
// sum's last digits. For numbers up to 2^50.
constexpr double kOnlyWhole = 0x1.8p52;

WholeLanes rounded_down(Lanes a) {
  const Lanes raised = a + kOnlyWhole;
  return bits_of(raised) - bits_of(lanes_of(kOnlyWhole)) + (raised - kOnlyWhole > a);
}
WholeLanes rounded_up(Lanes a) {
  const Lanes raised = a + kOnlyWhole;
  return bits_of(raised) - bits_of(lanes_of(kOnlyWhole)) - (raised - kOnlyWhole < a);
}

/// 0, 1, 2 and so on.
Lanes steps() {
  Lanes steps;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    steps[lane] = static_cast<double>(static_cast<std::int64_t>(lane));
  return steps;
}

/// Heights of row `i` of the spans and those after it.
Lanes heights(const RowSpans& spans, std::size_t i) {
  return static_cast<double>(static_cast<std::int64_t>(spans.first_row + i)) + steps();
}

/// The columns of a grid from one place to another.
void put(RowSpans& spans, std::size_t i, Lanes from, Lanes to, Lanes columns) {
  const WholeLanes last = rounded_down(lesser(greater(to, lanes_of(-1)), columns - 1));
  store(spans.left[i], words_of(rounded_up(lesser(greater(from, Lanes{}), columns))));
  store(spans.end[i], words_of(last + 1));
}

Lanes centre_line(const CapsuleShape& shape, Lanes y) {
  return shape.low_x + shape.slope * (y - shape.low_y);
}

void rows(const CapsuleShape& given, std::size_t columns, std::size_t begin, std::size_t end,
          RowSpans& spans) {
  const CapsuleShape shape = given;  // what is stored to spans does not change it
  const Lanes column_count = lanes_of(static_cast<double>(static_cast<std::int64_t>(columns)));
  const Lanes low_x = lanes_of(shape.low_x);
  const Lanes low_y = lanes_of(shape.low_y);
  const Lanes high_x = lanes_of(shape.high_x);
  const Lanes high_y = lanes_of(shape.high_y);
  Lanes y = heights(spans, begin);
  for (std::size_t i = begin; i < end; i += kLanes, y += kLanes) {
    const Lanes middle = centre_line(shape, y);
    const WholeLanes left_is_low = y < shape.left.begin;
    const WholeLanes right_is_low = y < shape.right.begin;
    const Lanes left_rise = y - (left_is_low ? low_y : high_y);
    const Lanes right_rise = y - (right_is_low ? low_y : high_y);
    const Lanes left_arc =
        (left_is_low ? low_x : high_x) - square_root(shape.square - left_rise * left_rise);
    const Lanes right_arc =
        (right_is_low ? low_x : high_x) + square_root(shape.square - right_rise * right_rise);
    put(spans, i, (left_is_low | (y > shape.left.end)) ? left_arc : middle - shape.half_width,
        (right_is_low | (y > shape.right.end)) ? right_arc : middle + shape.half_width,
        column_count);
  }
}

void straight_rows(const CapsuleShape& given, std::size_t columns, std::size_t begin,
                   std::size_t end, RowSpans& spans) {
  const CapsuleShape shape = given;
  const Lanes column_count = lanes_of(static_cast<double>(static_cast<std::int64_t>(columns)));
  Lanes y = heights(spans, begin);
  for (std::size_t i = begin; i < end; i += kLanes, y += kLanes) {
    const Lanes middle = centre_line(shape, y);
    put(spans, i, middle - shape.half_width, middle + shape.half_width, column_count);
  }
}

void cut_disc(const DiscShape& given, std::size_t begin, std::size_t end, RowSpans& spans) {
  const DiscShape disc = given;
  const Lanes furthest = lanes_of(0x1p40);
  spans.is_cut = true;
  for (std::size_t i = 0; i < spans.count; i += kLanes) {
    store(spans.cut_left[i], WordLanes{});
    store(spans.cut_end[i], WordLanes{});
  }
  Lanes y = heights(spans, begin);
  for (std::size_t i = begin; i < end; i += kLanes, y += kLanes) {
    const Lanes rise = y - disc.y;
    const Lanes square = disc.square - rise * rise;
    const Lanes half = square_root(square);
    const WholeLanes left = rounded_up(lesser(greater(disc.x - half, -furthest), furthest));
    const WholeLanes last = rounded_down(lesser(greater(disc.x + half, -furthest), furthest));
    store(spans.cut_left[i], words_of(left));
    store(spans.cut_end[i], words_of(square >= 0 ? last + 1 : left));
  }
}

/// Of a column's number its place in a word.
constexpr std::uint64_t kInWord = kWordBits - 1;

/// Of words whose first column is `begin`, the columns before an end.
WordLanes columns_before(WholeLanes end, std::int64_t begin) {
  const WholeLanes count = end - begin;
#if defined(__SSE2__) && !defined(__AVX2__)
  // Neither shifts nor comparisons of this size are among what these do in vectors.
  WordLanes columns{};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::int64_t k = count[lane];
    const std::uint64_t some = ~(~std::uint64_t{0} << (static_cast<std::uint64_t>(k) & kInWord));
    const std::uint64_t up_to_all = k > 0 ? some : 0;
    columns[lane] = k >= std::int64_t{kWordBits} ? ~std::uint64_t{0} : up_to_all;
  }
  return columns;
#else
  const WordLanes some = ~(~WordLanes{} << (words_of(count) & kInWord));
  return (some & words_of(count > 0)) | words_of(count >= std::int64_t{kWordBits});
#endif
}

/// Calls visit(place of the first word, mask) for some rows at once of all that spans hold.
template <typename Visit>
void visit_spans(const RowSpans& spans, std::size_t rows, const Visit& visit) {
  for (std::size_t word = spans.first_word; word < spans.end_word; ++word) {
    const auto column = static_cast<std::int64_t>(word * kWordBits);
    const std::size_t first = word * rows + spans.first_row;
    const auto between = [column](const std::int64_t& left, const std::int64_t& end) {
      return columns_before(whole_of(load(end)), column) &
             ~columns_before(whole_of(load(left)), column);
    };
    if (spans.is_cut)
      for (std::size_t i = 0; i < spans.count; i += kLanes)
        visit(first + i,
              between(spans.left[i], spans.end[i]) & ~between(spans.cut_left[i], spans.cut_end[i]));
    else
      for (std::size_t i = 0; i < spans.count; i += kLanes)
        visit(first + i, between(spans.left[i], spans.end[i]));
  }
}

void add(const RowSpans& spans, std::uint64_t* words, std::size_t rows) {
  visit_spans(spans, rows,
              [words](std::size_t i, WordLanes mask) { store(words[i], load(words[i]) | mask); });
}

void remove(const RowSpans& spans, std::uint64_t* words, std::size_t rows) {
  visit_spans(spans, rows,
              [words](std::size_t i, WordLanes mask) { store(words[i], load(words[i]) & ~mask); });
}

bool add_counting(const RowSpans& spans, std::uint64_t* words, std::uint64_t* again,
                  std::size_t rows) {
  WordLanes met{};
  visit_spans(spans, rows, [words, again, &met](std::size_t i, WordLanes mask) {
    const WordLanes before = load(words[i]);
    const WordLanes both = before & mask;
    // Most samples are passed once: the other words are left alone.
    if (any(both)) {
      store(again[i], load(again[i]) | both);
      met |= both;
    }
    store(words[i], before | mask);
  });
  return any(met);
}

void flip(const LineShape& given, std::size_t begin, std::size_t end, std::size_t first_strip,
          std::size_t end_strip, std::uint64_t* words, std::size_t rows) {
  const LineShape line = given;
  const Lanes first = static_cast<double>(static_cast<std::int64_t>(begin)) + steps();
  const Lanes row_end = lanes_of(static_cast<double>(static_cast<std::int64_t>(end)));
  for (std::size_t strip = first_strip; strip < end_strip; ++strip) {
    Lanes y = first;
    for (std::size_t row = begin; row < end; row += kLanes, y += kLanes) {
      const WordLanes column =
          words_of(rounded_up(greater(line.x + (y - line.y) * line.slope, Lanes{})));
      const WordLanes here = words_of(column / kWordBits == strip) & words_of(y < row_end);
      std::uint64_t& at = words[strip * rows + row];
      store(at, load(at) ^ (~WordLanes{} << (column & kInWord) & here));
    }
  }
}

void fill(std::uint64_t* words, std::uint64_t* carry, std::size_t rows) {
  std::size_t i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    const WordLanes flips = load(words[i]);
    const WordLanes before = load(carry[i]);
    store(words[i], flips ^ before);
    store(carry[i], before ^ words_of(whole_of(flips) < 0));
  }
  for (; i < rows; ++i) {
    const std::uint64_t flips = words[i];
    words[i] = flips ^ carry[i];
    carry[i] ^= std::uint64_t{0} - (flips >> 63U);
  }
}

/// Counts bits. Those of one word are counted by a call on plain processors: of some words together
/// they are added up byte by byte.
class BitCounter {
 public:
  void add(WordLanes words) {
    words -= words >> 1 & 0x5555555555555555U;
    words = (words & 0x3333333333333333U) + (words >> 2 & 0x3333333333333333U);
    of_bytes_ += (words + (words >> 4)) & 0x0f0f0f0f0f0f0f0fU;
    if (++added_ == kMost) carry();
  }

  [[nodiscard]] std::size_t count() {
    carry();
    std::size_t set = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) set += of_words_[lane];
    return set;
  }

 private:
  static constexpr int kMost = 31;  // of up to 8: a byte holds 255

  void carry() {
    WordLanes sums = (of_bytes_ & 0x00ff00ff00ff00ffU) + (of_bytes_ >> 8 & 0x00ff00ff00ff00ffU);
    sums = (sums & 0x0000ffff0000ffffU) + (sums >> 16 & 0x0000ffff0000ffffU);
    of_words_ += (sums & 0x00000000ffffffffU) + (sums >> 32);
    of_bytes_ = WordLanes{};
    added_ = 0;
  }

  WordLanes of_bytes_{};
  WordLanes of_words_{};
  int added_ = 0;
};

std::size_t count(const StripWords& plane, const std::uint64_t* with,
                  const std::uint64_t* without) {
  const std::uint64_t* const words = plane.words;
  BitCounter counter;
  const auto count_all = [&](const auto& words_at) {
    for (std::size_t strip = 0; strip < plane.strips; ++strip) {
      std::size_t i = strip * plane.rows + plane.used[strip].first;
      const std::size_t end = strip * plane.rows + plane.used[strip].end;
      for (; i + kLanes <= end; i += kLanes) counter.add(words_at(i));
      if (i < end) {
        const auto rest = static_cast<double>(static_cast<std::int64_t>(end - i));
        counter.add(words_at(i) & words_of(steps() < rest));
      }
    }
  };
  if (with == nullptr)
    count_all([=](std::size_t i) { return load(words[i]); });
  else if (without == nullptr)
    count_all([=](std::size_t i) { return load(words[i]) & load(with[i]); });
  else
    count_all([=](std::size_t i) { return load(words[i]) & load(with[i]) & ~load(without[i]); });
  return counter.count();
}

void weighted_sum(const float* const* from, const float* weights, std::size_t terms, float* to,
                  std::size_t count) {
  for (std::size_t i = 0; i < count; i += 2 * kLanes) {
    FloatLanes sum{};
    for (std::size_t term = 0; term < terms; ++term) {
      FloatLanes numbers;
      __builtin_memcpy(&numbers, from[term] + i, sizeof(numbers));
      sum += weights[term] * numbers;
    }
    __builtin_memcpy(to + i, &sum, sizeof(sum));
  }
}

constexpr RowLoops kLoops{
    .name = kName,
    .rows = rows,
    .straight_rows = straight_rows,
    .cut_disc = cut_disc,
    .add = add,
    .remove = remove,
    .add_counting = add_counting,
    .flip = flip,
    .fill = fill,
    .count = count,
    .weighted_sum = weighted_sum,
};

}  // namespace
}  // namespace routebench::judging
