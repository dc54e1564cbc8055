/// Laws of what overlays are made of: boxes of edges, rings that cross, loops, and memory for a
/// while.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory_resource>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "overlay/crossed_rings.hpp"
#include "overlay/edge_boxes.hpp"
#include "overlay/overlay.hpp"
#include "overlay/planar_edges.hpp"
#include "overlay/ring_index.hpp"
#include "overlay/scratch.hpp"
#include "overlay/small_loops.hpp"

namespace routebench::overlay {
namespace {

/// Small ones, and some that reach from end to end of the grid.
GridBox random_box(std::mt19937_64& random) {
  std::uniform_int_distribution<std::int32_t> place(-40, 40), size(0, 12);
  std::uniform_int_distribution<int> kind(0, 15);
  const GridPoint p{place(random), place(random)};
  GridBox box{p, {p.x + size(random), p.y + size(random)}};
  if (const int which = kind(random); which == 0) {
    box.lower.x = -kMaxUnits;
    box.upper.x = kMaxUnits;
  } else if (which == 1) {
    box.lower.y = -kMaxUnits;
    box.upper.y = kMaxUnits;
  } else if (which == 2) {
    box.lower = box.upper = {kMaxUnits, kMaxUnits};
  } else if (which == 3) {
    box.lower = box.upper = {-kMaxUnits, -kMaxUnits};
  }
  return box;
}

TEST(EdgeBoxes, VisitsWhatMeetsByDefinition) {
  std::mt19937_64 random(1);
  for (const std::uint32_t edges : {1U, 7U, 8U, 9U, 63U, 64U, 65U, 200U, 513U}) {
    EdgeBoxes boxes(edges, std::pmr::get_default_resource());
    std::vector<GridBox> set(edges);
    const auto set_box = [&](std::uint32_t e) {
      set[e] = random_box(random);
      boxes.set(e, set[e]);
    };
    for (std::uint32_t e = 0; e < edges; ++e) set_box(e);
    const auto expect_all = [&] {
      for (int i = 0; i < 200; ++i) {
        const GridBox box = random_box(random);
        const auto first = std::uniform_int_distribution<std::uint32_t>(
            0, static_cast<std::uint32_t>(set.size()))(random);
        std::vector<std::uint32_t> visited, meeting;
        boxes.visit_meeting(box, first, [&](std::uint32_t e) { visited.push_back(e); });
        for (std::uint32_t e = 0; e < first; ++e)
          if (set[e].meets(box)) meeting.push_back(e);
        EXPECT_EQ(visited, meeting) << first << " of " << set.size();
      }
    };
    expect_all();
    // Cuts add edges, and change those that they cut.
    const auto more = static_cast<std::uint32_t>(edges + edges / 2 + 1);
    set.resize(more);
    boxes.resize(more);
    for (std::uint32_t e = edges; e < more; ++e) set_box(e);
    for (std::uint32_t e = 0; e < edges; e += 3) set_box(e);
    expect_all();
  }
}

TEST(EdgeBoxes, VisitsPairsThatMeetByDefinition) {
  std::mt19937_64 random(1);
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  // Of few boxes near each other all pairs may meet, of many far apart hardly any does.
  for (const std::int32_t apart : {0, 1, 4})
    for (const std::uint32_t edges : {1U, 8U, 9U, 64U, 65U, 130U, 513U}) {
      EdgeBoxes boxes(edges, std::pmr::get_default_resource());
      std::vector<GridBox> set(edges);
      for (std::uint32_t e = 0; e < edges; ++e) {
        set[e] = random_box(random);
        if (std::abs(set[e].lower.x) < 1000 && std::abs(set[e].upper.x) < 1000)
          for (std::int32_t* x : {&set[e].lower.x, &set[e].upper.x})
            *x += apart * static_cast<std::int32_t>(e);
        boxes.set(e, set[e]);
      }
      std::vector<Pair> visited, meeting;
      boxes.visit_meeting_pairs(
          edges, [&](std::uint32_t e, std::uint32_t f) { visited.emplace_back(e, f); });
      for (std::uint32_t e = 0; e < edges; ++e)
        for (std::uint32_t f = 0; f + 1 < e; ++f)
          if (set[e].meets(set[f])) meeting.emplace_back(e, f);
      std::sort(visited.begin(), visited.end());
      EXPECT_EQ(visited, meeting) << edges << " edges, " << apart << " apart";
    }
}

TEST(EdgeBoxes, FindsAPairOfTwoSetsByDefinition) {
  std::mt19937_64 random(1);
  int found = 0, missed = 0;
  for (int round = 0; round < 300; ++round) {
    const auto make = [&](std::vector<GridBox>& set, std::int32_t beside) {
      std::uniform_int_distribution<std::uint32_t> sizes(1, round % 3 == 0 ? 300 : 70);
      std::uniform_int_distribution<std::int32_t> place(0, 2000), size(0, 20);
      set.resize(sizes(random));
      EdgeBoxes boxes(static_cast<std::uint32_t>(set.size()), std::pmr::get_default_resource());
      for (std::uint32_t e = 0; e < set.size(); ++e) {
        const GridPoint p{place(random) + beside, place(random)};
        set[e] = {p, {p.x + size(random), p.y + size(random)}};
        boxes.set(e, set[e]);
      }
      return boxes;
    };
    std::vector<GridBox> ones, others;
    const EdgeBoxes one = make(ones, 0), other = make(others, round % 2 == 0 ? 1900 : 0);
    std::size_t meeting = 0, asked = 0;
    for (const GridBox& a : ones)
      for (const GridBox& b : others) meeting += a.meets(b) ? 1U : 0U;
    // Whatever is asked about is a pair that meets, and all are asked about if none will do.
    EXPECT_FALSE(one.any_meeting_pair(other, [&](std::uint32_t e, std::uint32_t f) {
      EXPECT_TRUE(ones[e].meets(others[f]));
      ++asked;
      return false;
    }));
    EXPECT_EQ(asked, meeting);
    const auto first = [](std::uint32_t, std::uint32_t) { return true; };
    EXPECT_EQ(one.any_meeting_pair(other, first), meeting > 0);
    ++(meeting > 0 ? found : missed);
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(missed, 50);
}

TEST(EdgeBoxes, MeetsNothingBeforeItIsSet) {
  EdgeBoxes boxes(100, std::pmr::get_default_resource());
  const GridBox all{{-kMaxUnits, -kMaxUnits}, {kMaxUnits, kMaxUnits}};
  boxes.visit_meeting(all, 100, [](std::uint32_t e) { ADD_FAILURE() << e; });
  boxes.visit_meeting_pairs(100, [](std::uint32_t e, std::uint32_t) { ADD_FAILURE() << e; });
}

constexpr std::array kInsides{Inside::kFirstPositive, Inside::kFirstNonZero, Inside::kFirstOdd,
                              Inside::kEither,        Inside::kBoth,         Inside::kFirstOnly};

/// Rings of either set that run about at will.
GridRings random_rings(std::mt19937_64& random, std::int32_t extent) {
  std::uniform_int_distribution<std::int32_t> place(-extent, extent);
  std::uniform_int_distribution<int> count(1, 5), corners(3, 12), kind(0, 2);
  GridRings rings;
  for (int n = count(random); n > 0; --n) {
    constexpr std::array<Winding, 3> windings{{{1, 0}, {0, 1}, {-1, 0}}};
    rings.begin_ring(windings[static_cast<std::size_t>(kind(random))]);
    for (int k = corners(random); k > 0; --k) rings.add({place(random), place(random)});
    rings.end_ring();
  }
  return rings;
}

/// By the definition. Takes a place on none of the rings.
Winding winding_at(const GridRings& rings, GridPoint p) {
  Winding sum;
  for (std::uint32_t ring = 0; ring < rings.rings(); ++ring) {
    GridPoint a = rings.ring(ring).back();
    for (const GridPoint b : rings.ring(ring)) {
      if (a.y <= p.y && b.y > p.y && turn(a, b, p) > 0) sum = sum + rings.winding(ring);
      if (b.y <= p.y && a.y > p.y && turn(a, b, p) < 0) sum = sum - rings.winding(ring);
      a = b;
    }
  }
  return sum;
}

/// Whether a place is so near to an edge that rounding may move one over the other.
bool is_near_an_edge(const GridRings& rings, GridPoint p) {
  constexpr std::int32_t kMoved = 2;
  for (std::uint32_t ring = 0; ring < rings.rings(); ++ring) {
    GridPoint a = rings.ring(ring).back();
    for (const GridPoint b : rings.ring(ring)) {
      const GridBox box = box_of(std::array{a, b});
      const std::int64_t x = b.x - a.x, y = b.y - a.y;
      if (box.lower.x - kMoved <= p.x && p.x <= box.upper.x + kMoved &&
          box.lower.y - kMoved <= p.y && p.y <= box.upper.y + kMoved &&
          std::abs(turn(a, b, p)) <= kMoved * (std::abs(x) + std::abs(y)))
        return true;
      a = b;
    }
  }
  return false;
}

TEST(CrossedRings, BoundWhatIsInsideByDefinition) {
  std::mt19937_64 random(1);
  // Rings on a coarse grid touch, cross at nearly one place and leave slivers.
  for (const std::int32_t extent : {20, 100, 1000, 1000000, kMaxUnits / 2}) {
    int bounded = 0, asked = 0;
    for (int round = 0; round < 300; ++round) {
      const GridRings rings = random_rings(random, extent);
      if (rings.rings() == 0) continue;
      const PlanarEdges edges(rings);
      const CrossedRings crossed(edges);
      for (const Inside inside : kInsides) {
        const std::optional<GridRings> boundary = crossed.boundary(inside);
        ++asked;
        if (!boundary) continue;
        ++bounded;
        if (boundary->rings() > 0) {
          EXPECT_FALSE(PlanarEdges(*boundary).any_meets());
        }
        std::uniform_int_distribution<std::int32_t> place(-extent, extent);
        for (int i = 0; i < 40; ++i) {
          const GridPoint p{place(random), place(random)};
          if (is_near_an_edge(rings, p)) continue;
          EXPECT_EQ(winding_at(*boundary, p).first, is_inside(winding_at(rings, p), inside) ? 1 : 0)
              << "round " << round << " within " << extent;
        }
      }
    }
    // Where odd windings and others meet at corners only, or edges touch, it has to be cut.
    if (extent >= 1000000) {
      EXPECT_GT(3 * bounded, asked);
    }
  }
}

TEST(CrossedRings, SayNothingOfRingsThatTouch) {
  const auto square = [](GridRings& rings, std::int32_t from, std::int32_t to, Winding winding) {
    rings.begin_ring(winding);
    for (const GridPoint p : {GridPoint{from, from}, {to, from}, {to, to}, {from, to}})
      rings.add(p);
    rings.end_ring();
  };
  for (const std::int32_t from : {0, 10, 100}) {  // same side, corner on side, corner at corner
    GridRings rings;
    square(rings, 0, 100, {1, 0});
    square(rings, from, from + 150, {0, 1});
    const PlanarEdges edges(rings);
    EXPECT_EQ(CrossedRings(edges).boundary(Inside::kEither).has_value(), from == 10);
  }
}

TEST(Overlay, DividesByDefinition) {
  std::mt19937_64 random(2);
  for (const std::int32_t extent : {20, 1000, 1000000})
    for (int round = 0; round < 200; ++round) {
      const GridRings rings = random_rings(random, extent);
      const std::optional<Divided> divided = divide(rings);
      ASSERT_TRUE(divided);
      const GridRings within = rings_of(divided->within), beyond = rings_of(divided->beyond);
      std::uniform_int_distribution<std::int32_t> place(-extent, extent);
      for (int i = 0; i < 100; ++i) {
        const GridPoint p{place(random), place(random)};
        if (is_near_an_edge(rings, p)) continue;
        const Winding winding = winding_at(rings, p);
        EXPECT_EQ(winding_at(within, p).first, is_inside(winding, Inside::kBoth) ? 1 : 0);
        EXPECT_EQ(winding_at(beyond, p).first, is_inside(winding, Inside::kFirstOnly) ? 1 : 0);
      }
    }
}

TEST(SmallLoops, ThatLieOutsideGoWithoutATrace) {
  // What is far does not go for being small: every loop that goes lies outside all else.
  std::mt19937_64 random(3);
  int gone = 0;
  for (const std::int32_t extent : {100, 10000, kMaxUnits / 2})
    for (int round = 0; round < 3000; ++round) {
      std::uniform_int_distribution<std::int32_t> place(-extent, extent);
      std::uniform_int_distribution<int> corners(5, 16), share(0, 4);
      std::pmr::vector<DrawnPoint> curve;
      for (int k = corners(random); k > 0; --k)
        curve.push_back({{place(random), place(random)}, share(random) > 0, true});
      const auto drawn = [](const std::pmr::vector<DrawnPoint>& points) {
        GridRings rings;
        rings.begin_ring({1, 0});
        for (const DrawnPoint& p : points) rings.add(p.at);
        rings.end_ring();
        return rings;
      };
      const GridRings before = drawn(curve);
      const std::size_t points = curve.size();
      SmallLoops(false, true, curve.get_allocator().resource()).drop_from(curve);
      gone += curve.size() < points ? 1 : 0;
      const GridRings after = drawn(curve);
      for (int i = 0; i < 40; ++i) {
        const GridPoint p{place(random), place(random)};
        if (is_near_an_edge(before, p)) continue;
        EXPECT_EQ(winding_at(after, p).first > 0, winding_at(before, p).first > 0)
            << "round " << round << " within " << extent;
      }
    }
  EXPECT_GT(gone, 100);
}

TEST(RingIndex, TellsWhatComesNear) {
  const auto square_at = [](GridPoint lower, std::int32_t side) {
    GridRings rings;
    rings.begin_ring({1, 0});
    for (const GridPoint by : {GridPoint{0, 0}, {side, 0}, {side, side}, {0, side}})
      rings.add({lower.x + by.x, lower.y + by.y});
    rings.end_ring();
    return RingIndex(std::move(rings));
  };
  const RingIndex square = square_at({0, 0}, 1000);
  for (const GridPoint along : {GridPoint{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
    const auto beside = [&](std::int32_t gap) {
      const std::int32_t by = along.x + along.y > 0 ? 1000 + gap : 100 + gap;
      return square_at(
          {400 * std::abs(along.y) + by * along.x, 400 * std::abs(along.x) + by * along.y}, 100);
    };
    for (const std::int32_t gap : {-50, 0, 1, 3}) {
      EXPECT_TRUE(square.comes_near(beside(gap))) << gap;
      EXPECT_TRUE(beside(gap).comes_near(square)) << gap;
    }
    for (const std::int32_t gap : {6, 100}) {
      EXPECT_FALSE(square.comes_near(beside(gap))) << gap;
      EXPECT_FALSE(beside(gap).comes_near(square)) << gap;
    }
  }
  EXPECT_FALSE(square.comes_near(square_at({450, 450}, 100)));  // inside, clear of the boundary
}

struct Piece {
  std::byte* memory;
  std::size_t bytes;
  std::size_t alignment;
  unsigned char mark;
};

Piece take(std::pmr::memory_resource& from, std::size_t bytes, std::size_t alignment,
           unsigned char mark) {
  auto* const memory = static_cast<std::byte*>(from.allocate(bytes, alignment));
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % alignment, 0U);
  std::memset(memory, mark, bytes);
  return {memory, bytes, alignment, mark};
}

void expect_own(const Piece& piece) {
  EXPECT_TRUE(std::all_of(piece.memory, piece.memory + piece.bytes,
                          [&](std::byte b) { return b == std::byte{piece.mark}; }));
}

void give_back(std::pmr::memory_resource& to, const Piece& piece) {
  expect_own(piece);
  to.deallocate(piece.memory, piece.bytes, piece.alignment);
}

TEST(Scratch, HandsNoMemoryOutTwice) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> size(1, 3000), which(0, 1000);
  std::uniform_int_distribution<int> align(0, 6), mark(0, 255);
  Scratch scratch;
  std::vector<Piece> pieces;
  for (int i = 0; i < 2000; ++i) {
    if (pieces.size() > 40 || (!pieces.empty() && which(random) < 400)) {
      const std::size_t k = which(random) < 500 ? pieces.size() - 1 : which(random) % pieces.size();
      give_back(scratch, pieces[k]);
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
    } else {
      pieces.push_back(take(scratch, size(random), std::size_t{1} << align(random),
                            static_cast<unsigned char>(mark(random))));
    }
  }
  for (const Piece& piece : pieces) give_back(scratch, piece);
}

TEST(Scratch, GivesAllBackWhenItEnds) {
  const auto first_place = [] {
    Scratch scratch;
    const Piece first = take(scratch, 100, 8, 1), second = take(scratch, 200, 8, 2);
    give_back(scratch, first);
    give_back(scratch, second);
    return static_cast<const void*>(first.memory);
  };
  const void* const place = first_place();
  for (std::size_t i = 0; i < Scratch::kBlockBytes / 50; ++i) EXPECT_EQ(first_place(), place);
}

TEST(Scratch, LeavesMemoryOfAnEarlierOneAlone) {
  Scratch outer;
  const Piece kept = take(outer, 5000, 8, 1);
  {
    Scratch inner;
    const Piece piece = take(inner, 5000, 8, 2);
    expect_own(kept);
    give_back(inner, piece);
  }
  const Piece later = take(outer, 5000, 8, 3);
  give_back(outer, kept);
  give_back(outer, later);
}

TEST(Scratch, TakesFromTheHeapWhatDoesNotFit) {
  Scratch scratch;
  std::vector<Piece> pieces;
  for (const std::size_t bytes : {Scratch::kBlockBytes, Scratch::kBlockBytes, std::size_t{100},
                                  2 * Scratch::kBlockBytes, std::size_t{100}})
    pieces.push_back(take(scratch, bytes, 16, static_cast<unsigned char>(pieces.size())));
  for (const Piece& piece : pieces) give_back(scratch, piece);
}

}  // namespace
}  // namespace routebench::overlay
