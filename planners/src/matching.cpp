#include "routebench/planning/matching.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "lemon_matching.hpp"
#include "point_tree.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/nearest_grid.hpp"

namespace routebench {
namespace {

using lemon_matching::kPriceScale;
using lemon_matching::Solution;
using lemon_matching::WeightedPair;

// So many near neighbours of each point are tried at first; few of the pairs that a shortest
// matching needs are left out by that.
constexpr std::size_t kNeighbours = 8;

void require_even(std::span<const Point2> points) {
  if (points.size() % 2 == 0) return;
  throw Error(ErrorKind::kBadUsage, "a matching of " + std::to_string(points.size()) +
                                        " points, but only an even number can be paired");
}

WeightedPair weighted(std::span<const Point2> points, std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b), to_grid(distance(points[a], points[b]))};
}

/// Ascending, each pair once.
void tidy(std::vector<WeightedPair>& pairs) {
  const auto key = [](const WeightedPair& pair) { return std::pair(pair.a, pair.b); };
  std::sort(pairs.begin(), pairs.end(),
            [&](const WeightedPair& p, const WeightedPair& q) { return key(p) < key(q); });
  const auto same = [&](const WeightedPair& p, const WeightedPair& q) { return key(p) == key(q); };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
}

/// Pairs that could make a solution lighter: those against its proof (see lemon_matching.hpp).
std::vector<WeightedPair> pairs_against(const Solution& solution, std::span<const Point2> points,
                                        const PointTree& tree) {
  // Blossoms of each node, ascending.
  std::vector<std::vector<std::uint32_t>> blossoms_of(points.size());
  for (std::uint32_t k = 0; k < solution.blossoms.size(); ++k)
    for (const std::uint32_t node : solution.blossoms[k].nodes) blossoms_of[node].push_back(k);
  const auto price_together = [&](std::uint32_t a, std::uint32_t b) {
    std::int64_t price = 0;
    auto k = blossoms_of[b].begin();
    for (const std::uint32_t blossom : blossoms_of[a]) {
      while (k != blossoms_of[b].end() && *k < blossom) ++k;
      if (k != blossoms_of[b].end() && *k == blossom) price += solution.blossoms[blossom].price;
    }
    return price;
  };

  const std::int64_t highest = *std::max_element(solution.price.begin(), solution.price.end());
  std::vector<WeightedPair> against;
  for (std::uint32_t a = 0; a < points.size(); ++a) {
    const std::int64_t reach = (solution.price[a] + highest) / kPriceScale + 1;
    if (reach <= 0) continue;
    tree.for_each_within(points[a], from_grid(reach), [&](std::uint32_t b) {
      if (b <= a) return;
      const WeightedPair pair = weighted(points, a, b);
      const std::int64_t slack = kPriceScale * pair.weight - solution.price[a] - solution.price[b];
      if (slack < 0 && slack + price_together(a, b) < 0) against.push_back(pair);
    });
  }
  return against;
}

}  // namespace

double length_mm(std::span<const Point2> points, const Matching& matching) {
  double sum = 0;
  for (std::size_t i = 0; i < matching.size(); ++i)
    if (i < matching[i]) sum += distance(points[i], points[matching[i]]);
  return sum;
}

Matching greedy_matching(std::span<const Point2> points) {
  require_even(points);
  Matching mate(points.size());
  NearestGrid free({points.begin(), points.end()});
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!free.has(i)) continue;
    free.remove(i);
    mate[i] = free.nearest(points[i]).value();
    mate[mate[i]] = i;
    free.remove(mate[i]);
  }
  return mate;
}

Matching minimum_matching(std::span<const Point2> points) {
  const Matching greedy = greedy_matching(points);
  if (points.empty()) return greedy;
  const PointTree tree(points);
  std::vector<WeightedPair> pairs;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    // With the pairs of another perfect matching there always is one, and it is never longer.
    pairs.push_back(weighted(points, i, greedy[i]));
    for (const std::uint32_t near : tree.nearest(i, kNeighbours))
      pairs.push_back(weighted(points, i, near));
  }
  while (true) {
    tidy(pairs);
    const Solution solution =
        lemon_matching::solve(static_cast<std::uint32_t>(points.size()), pairs);
    if (solution.mate.empty())
      throw Error(ErrorKind::kInternal, "no perfect matching where there must be one");
    const std::vector<WeightedPair> against = pairs_against(solution, points, tree);
    if (against.empty()) return solution.mate;
    pairs.insert(pairs.end(), against.begin(), against.end());
  }
}

}  // namespace routebench
