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

#if defined(__AVX512F__)
WholeLanes rounded_down(Lanes a) {
  return __builtin_bit_cast(WholeLanes,
                            _mm512_cvt_roundpd_epi64(a, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
}
WholeLanes rounded_up(Lanes a) {
  return __builtin_bit_cast(WholeLanes,
                            _mm512_cvt_roundpd_epi64(a, _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC));
}
#else
// Next to this number there are only whole ones: to add it rounds to the nearest, which is then the
// sum's last digits. For numbers up to 2^50.
constexpr double kOnlyWhole = 0x1.8p52;

WholeLanes nearest(Lanes a) {
  return __builtin_bit_cast(WholeLanes, a + kOnlyWhole) -
         __builtin_bit_cast(WholeLanes, lanes_of(kOnlyWhole));
}
#if defined(__AVX2__)
WholeLanes rounded_down(Lanes a) { return nearest(_mm256_floor_pd(a)); }
WholeLanes rounded_up(Lanes a) { return nearest(_mm256_ceil_pd(a)); }
#else
WholeLanes rounded_down(Lanes a) { return nearest(a) + (a + kOnlyWhole - kOnlyWhole > a); }
WholeLanes rounded_up(Lanes a) { return nearest(a) - (a + kOnlyWhole - kOnlyWhole < a); }
#endif
#endif

/// 0, 1, 2 and so on.
Lanes steps() {
  Lanes steps;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    steps[lane] = static_cast<double>(static_cast<std::int64_t>(lane));
  return steps;
}

/// Of a column's number its place in a word.
constexpr std::uint64_t kInWord = kWordBits - 1;

/// All bits but the lowest `count`.
WordLanes all_but(WholeLanes count) {
#if defined(__AVX512F__)
  const auto some = _mm512_max_epi64(__builtin_bit_cast(__m512i, count), __m512i{});
  return __builtin_bit_cast(WordLanes, _mm512_sllv_epi64(_mm512_set1_epi64(-1), some));
#elif defined(__AVX2__)
  const auto some = __builtin_bit_cast(__m256i, count & (count > 0));
  return __builtin_bit_cast(WordLanes, _mm256_sllv_epi64(_mm256_set1_epi64x(-1), some));
#else
  // Neither shifts nor comparisons of this size are among what SSE2 does in vectors.
  WordLanes bits{};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::int64_t k = count[lane];
    const std::uint64_t some = ~std::uint64_t{0} << (static_cast<std::uint64_t>(k) & kInWord);
    const std::uint64_t up_to_all = k > 0 ? some : ~std::uint64_t{0};
    bits[lane] = k >= std::int64_t{kWordBits} ? 0 : up_to_all;
  }
  return bits;
#endif
}

/// The columns of a grid from one place to another.
struct Columns {
  WholeLanes left{};
  WholeLanes end{};

  Columns() = default;
  Columns(Lanes from, Lanes to, Lanes columns)
      : left(rounded_up(lesser(greater(from, Lanes{}), columns))),
        end(rounded_down(lesser(greater(to, lanes_of(-1)), columns - 1)) + 1) {}

  /// Those in words whose first column is `begin`.
  [[nodiscard]] WordLanes in_words(std::int64_t begin) const {
    return all_but(left - begin) & ~all_but(end - begin);
  }
};

double larger(double a, double b) { return a < b ? b : a; }

/// Calls visit(place of the first word, mask) for some rows at once of all that a capsule holds.
template <bool kCut, typename Visit>
void visit_words(const CapsuleShape& given, const GridPart& given_part, std::size_t rows,
                 const Visit& visit) {
  const CapsuleShape shape = given;  // what is stored to words does not change it
  const GridPart part = given_part;
  const Lanes columns = lanes_of(static_cast<double>(static_cast<std::int64_t>(part.columns)));
  const Lanes square = lanes_of(shape.radius * shape.radius);
  const bool cuts_low = kCut && shape.begins_low;
  const bool cuts_high = kCut && !shape.begins_low;
  // Up to here rows may meet the lower disc, from there on the upper one: only these take roots.
  double low_end = larger(shape.left.begin, shape.right.begin);
  double high_begin = -larger(-shape.left.end, -shape.right.end);
  // Where the disc ends is rounded: a row more, lest it depend on how many are taken at once.
  if (cuts_low) low_end = larger(low_end, shape.low_y + shape.radius + 1);
  if (cuts_high) high_begin = -larger(-high_begin, shape.radius + 1 - shape.high_y);
  auto height = static_cast<double>(static_cast<std::int64_t>(part.first_row));
  const Lanes end_height = lanes_of(static_cast<double>(static_cast<std::int64_t>(part.end_row)));
  for (std::size_t row = part.first_row; row < part.end_row; row += kLanes, height += kLanes) {
    const Lanes y = height + steps();
    const Lanes middle = shape.low_x + shape.slope * (y - shape.low_y);
    Lanes left = middle - shape.half_width;
    Lanes right = middle + shape.half_width;
    Columns cut;
    const auto meet_disc = [&](double disc_x, double disc_y, WholeLanes is_left,
                               WholeLanes is_right, bool cuts) {
      const Lanes rise = y - disc_y;
      const Lanes half_square = square - rise * rise;
      const Lanes half = square_root(half_square);
      const Lanes from = disc_x - half;
      const Lanes to = disc_x + half;
      left = is_left ? from : left;
      right = is_right ? to : right;
      if (!cuts) return;
      cut = Columns(from, to, columns);
      cut.end = half_square >= 0 ? cut.end : cut.left;
    };
    if (height <= low_end)
      meet_disc(shape.low_x, shape.low_y, y < shape.left.begin, y < shape.right.begin, cuts_low);
    if (height + (kLanes - 1) >= high_begin)
      meet_disc(shape.high_x, shape.high_y, y > shape.left.end, y > shape.right.end, cuts_high);
    Columns held(left, right, columns);
    held.end = y < end_height ? held.end : held.left;
    for (std::size_t word = part.first_word; word < part.end_word; ++word) {
      const auto column = static_cast<std::int64_t>(word * kWordBits);
      WordLanes mask = held.in_words(column);
      if constexpr (kCut) mask &= ~cut.in_words(column);
      visit(word * rows + row, mask);
    }
  }
}

template <typename Visit>
void visit_words(const CapsuleShape& shape, const GridPart& part, std::size_t rows,
                 const Visit& visit) {
  if (shape.is_cut)
    visit_words<true>(shape, part, rows, visit);
  else
    visit_words<false>(shape, part, rows, visit);
}

void add(const CapsuleShape& shape, const GridPart& part, std::uint64_t* words, std::size_t rows) {
  visit_words(shape, part, rows,
              [words](std::size_t i, WordLanes mask) { store(words[i], load(words[i]) | mask); });
}

void remove(const CapsuleShape& shape, const GridPart& part, std::uint64_t* words,
            std::size_t rows) {
  visit_words(shape, part, rows,
              [words](std::size_t i, WordLanes mask) { store(words[i], load(words[i]) & ~mask); });
}

bool add_counting(const CapsuleShape& shape, const GridPart& part, std::uint64_t* words,
                  std::uint64_t* again, std::size_t rows) {
  WordLanes met{};
  visit_words(shape, part, rows, [words, again, &met](std::size_t i, WordLanes mask) {
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

#if defined(__AVX512VPOPCNTDQ__)
/// Counts bits.
class BitCounter {
 public:
  void add(WordLanes words) {
    of_words_ +=
        __builtin_bit_cast(WordLanes, _mm512_popcnt_epi64(__builtin_bit_cast(__m512i, words)));
  }

  [[nodiscard]] std::size_t count() const {
    std::size_t set = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) set += of_words_[lane];
    return set;
  }

 private:
  WordLanes of_words_{};
};
#else
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
#endif

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
