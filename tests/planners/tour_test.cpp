#include "routebench/planning/tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/ordering.hpp"

namespace routebench {
namespace {

/// Items of one or two pairs of ways at random places.
std::vector<TourItem> random_items(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> mm(0, 50), near(-3, 3);
  std::vector<TourItem> items;
  for (std::size_t i = 0; i < count; ++i) {
    TourItem item;
    const Point2 at{mm(random), mm(random)};
    for (std::size_t pair = 0; pair <= i % 2; ++pair) {
      const Point2 a = at + Point2{near(random), near(random)};
      const Point2 b = at + Point2{near(random), near(random)};
      item.ways.push_back({a, b});
      item.ways.push_back({b, a});
    }
    items.push_back(item);
  }
  return items;
}

double gaps_mm(const std::vector<TourItem>& items, const std::vector<Visit>& tour, Point2 start) {
  double sum = 0;
  for (const Visit& visit : tour) {
    const Way& way = items[visit.item].ways[visit.way];
    sum += distance(start, way.in);
    start = way.out;
  }
  return sum;
}

/// The least sum of gaps of all orders and ways.
double least_mm(const std::vector<TourItem>& items, std::set<std::uint32_t> left, Point2 from) {
  if (left.empty()) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t item : left) {
    std::set<std::uint32_t> rest = left;
    rest.erase(item);
    for (const Way& way : items[item].ways)
      least = std::min(least, distance(from, way.in) + least_mm(items, rest, way.out));
  }
  return least;
}

TEST(ShortTour, VisitsEveryItemOnceInOneOfItsWays) {
  for (const std::size_t count : {0U, 1U, 2U, 7U, 400U}) {
    const std::vector<TourItem> items = random_items(count, 1);
    std::set<std::uint32_t> seen;
    for (const Visit& visit : short_tour(items, {}, {})) {
      EXPECT_TRUE(seen.insert(visit.item).second);
      ASSERT_LT(visit.way, items[visit.item].ways.size());
    }
    EXPECT_EQ(seen.size(), count);
  }
}

TEST(ShortTour, IsNearTheShortestWhereThatIsKnown) {
  double sum = 0, least_sum = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<TourItem> items = random_items(5, seed);
    const double mm = gaps_mm(items, short_tour(items, {}, {}), {});
    const double least = least_mm(items, {0, 1, 2, 3, 4}, {});
    EXPECT_GE(mm, least - 1e-9);
    sum += mm;
    least_sum += least;
  }
  EXPECT_LT(sum, 1.05 * least_sum);
}

TEST(ShortTour, OfStrokesIsNeverLongerThanNearestFirst) {
  double shorter = 0, nearest = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<Stroke> strokes;
    for (const TourItem& item : random_items(60, seed))
      strokes.push_back({{item.ways[0].in, item.ways[0].out}, 0.4});
    const auto gaps = [](const std::vector<Stroke>& order) {
      double mm = 0;
      Point2 at{};
      for (const Stroke& stroke : order) {
        mm += distance(at, stroke.points.front());
        at = stroke.points.back();
      }
      return mm;
    };
    const double a = gaps(in_short_order(strokes, {}, {})),
                 b = gaps(nearest_first(strokes, {}, {}));
    EXPECT_LE(a, b + 1e-6);
    shorter += a;
    nearest += b;
  }
  EXPECT_LT(shorter, 0.95 * nearest) << "the local search finds nothing";
}

TEST(ShortTour, KeepsStrokesAsTheyAreButForTheirDirection) {
  const std::vector<Stroke> strokes{{{{9, 0}, {9, 1}, {5, 0}}, 0.4}, {{{0, 0}, {1, 0}}, 0.3}};
  const std::vector<Stroke> order = in_short_order(strokes, {0, 0}, {});
  ASSERT_EQ(order.size(), 2U);
  EXPECT_EQ(order[0], strokes[1]);
  EXPECT_EQ(order[1], (Stroke{{{5, 0}, {9, 1}, {9, 0}}, 0.4}));
}

TEST(ShortTour, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  PlanContext context;
  context.stop = source.get_token();
  EXPECT_THROW((void)short_tour(random_items(3, 1), {}, context), Error);
}

}  // namespace
}  // namespace routebench
