/// Speed of what planners share: Euler circuits, matching, the nearest stroke.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <random>

#include "routebench/planning/euler.hpp"
#include "routebench/planning/matching.hpp"
#include "routebench/planning/nearest_grid.hpp"

namespace {

using namespace routebench;

std::vector<Point2> random_points(std::int64_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 100);
  std::vector<Point2> points(static_cast<std::size_t>(count));
  for (Point2& p : points) p = {place(random), place(random)};
  return points;
}

/// A square lattice that closes upon itself: every node has four edges.
Multigraph torus(std::uint32_t side) {
  std::vector<Multigraph::Ends> edges;
  edges.reserve(2 * std::size_t{side} * side);
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t node = y * side + x;
      edges.push_back({node, y * side + (x + 1) % side});
      edges.push_back({node, (y + 1) % side * side + x});
    }
  return Multigraph(std::size_t{side} * side, std::move(edges));
}

void hierholzer(benchmark::State& state) {
  const auto side = static_cast<std::uint32_t>(state.range(0));
  const Multigraph graph = torus(side);
  for (auto _ : state) benchmark::DoNotOptimize(euler_circuits(graph));
  const std::int64_t edges = 2 * state.range(0) * state.range(0);
  state.SetComplexityN(edges);
  state.SetItemsProcessed(state.iterations() * edges);
}
BENCHMARK(hierholzer)
    ->Arg(70)
    ->Arg(224)
    ->Arg(707)
    ->Arg(2236)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);

void match_points(benchmark::State& state) {
  const std::vector<Point2> points = random_points(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(minimum_matching(points));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(match_points)
    ->RangeMultiplier(4)
    ->Range(64, 1 << 12)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

/// Takes all points, always the nearest.
void nearest_points(benchmark::State& state) {
  const std::vector<Point2> points = random_points(state.range(0));
  for (auto _ : state) {
    NearestGrid grid(points);
    Point2 at{0, 0};
    while (const auto next = grid.nearest(at)) {
      at = points[*next];
      grid.remove(*next);
    }
    benchmark::DoNotOptimize(at);
  }
  state.SetComplexityN(state.range(0));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(nearest_points)->RangeMultiplier(8)->Range(64, 1 << 18)->Complexity();

}  // namespace
