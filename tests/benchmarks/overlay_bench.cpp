/// Speed of region work: offsets, Booleans, skins.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "bench_models.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/solid.hpp"
#include "routebench/geometry/vec.hpp"

namespace {

using namespace routebench;

void over_points(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(4)->Range(64, 1 << 14)->Unit(benchmark::kMicrosecond)->Complexity();
}

void shrink_by_a_line(benchmark::State& state) {
  const Layer layer = bench::star_layer(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(offset(layer.polygons, -0.4));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(shrink_by_a_line)->Apply(over_points);

/// Outlines of a few points, as lattices and text are made of: so many that none is foreseen.
constexpr int kFewPointOutlines = 1024;

void over_few_points(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(2)->Range(4, 64)->Unit(benchmark::kMicrosecond);
}

std::vector<Polygons> few_point_outlines(int points, std::uint64_t first_seed) {
  std::vector<Polygons> outlines;
  for (int i = 0; i < kFewPointOutlines; ++i)
    outlines.push_back(polygons_from_rings(
        {test::star(first_seed + static_cast<std::uint64_t>(i), points, {50, 50}, 0.6, 1.2)},
        FillRule::kNonZero));
  return outlines;
}

void shrink_few_points(benchmark::State& state) {
  const auto outlines = few_point_outlines(static_cast<int>(state.range(0)), 1);
  for (auto _ : state)
    for (const Polygons& outline : outlines) benchmark::DoNotOptimize(offset(outline, -0.2));
  state.SetItemsProcessed(state.iterations() * kFewPointOutlines);
}
BENCHMARK(shrink_few_points)->Apply(over_few_points);

void subtract_few_points(benchmark::State& state) {
  const auto a = few_point_outlines(static_cast<int>(state.range(0)), 1);
  const auto b = few_point_outlines(static_cast<int>(state.range(0)), kFewPointOutlines + 1);
  for (auto _ : state)
    for (std::size_t i = 0; i < a.size(); ++i) benchmark::DoNotOptimize(subtract(a[i], b[i]));
  state.SetItemsProcessed(state.iterations() * kFewPointOutlines);
}
BENCHMARK(subtract_few_points)->Apply(over_few_points);

/// A large disc of very short edges.
void shrink_a_disc(benchmark::State& state) {
  const auto points = static_cast<int>(state.range(0));
  const Polygons disc = {{test::star(1, points, {256, 256}, 256.0, 256.0), {}}};
  for (auto _ : state) benchmark::DoNotOptimize(offset(disc, -0.1));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(shrink_a_disc)
    ->RangeMultiplier(4)
    ->Range(1 << 10, 1 << 18)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

/// Two outlines that cross often, as those of neighbouring layers do.
template <Polygons (*kOperation)(const Polygons&, const Polygons&)>
void boolean(benchmark::State& state) {
  const auto points = static_cast<int>(state.range(0));
  const Polygons a = {{test::star(1, points, {50, 50}, 47.0, 50.0), {}}};
  const Polygons b = {{test::star(2, points, {50, 50}, 47.0, 50.0), {}}};
  for (auto _ : state) benchmark::DoNotOptimize(kOperation(a, b));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(boolean<unite>)->Apply(over_points);
BENCHMARK(boolean<intersect>)->Apply(over_points);
BENCHMARK(boolean<subtract>)->Apply(over_points);

/// Copies of one outline that differ by a few units of the grid: their sides cross again and again.
void unite_nearly_equal(benchmark::State& state) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> by(-8, 8);
  const Ring outline = test::star(1, 500, {50, 50}, 47.0, 50.0);
  std::vector<Ring> rings(static_cast<std::size_t>(state.range(0)), outline);
  for (Ring& ring : rings)
    for (Point2& p : ring)
      p = p + Point2{by(random) / kGridUnitsPerMm, by(random) / kGridUnitsPerMm};
  for (auto _ : state) benchmark::DoNotOptimize(polygons_from_rings(rings, FillRule::kNonZero));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(unite_nearly_equal)
    ->RangeMultiplier(2)
    ->Range(2, 16)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

/// Two combs: n^2 places where long sides cross.
void intersect_combs(benchmark::State& state) {
  const auto comb = [&](bool turned) {
    Ring ring;
    const auto length = static_cast<double>(2 * state.range(0));
    for (int i = 0; i < state.range(0); ++i)
      ring.insert(ring.end(),
                  {{2.0 * i, -1}, {2.0 * i, length}, {2.0 * i + 1, length}, {2.0 * i + 1, -1}});
    ring.insert(ring.end(), {{length, -1}, {length, -2}, {0, -2}});
    if (turned)
      for (Point2& p : ring) p = {p.y, p.x};
    return polygons_from_rings({ring}, FillRule::kNonZero);
  };
  const Polygons upright = comb(false), level = comb(true);
  for (auto _ : state) benchmark::DoNotOptimize(intersect(upright, level));
  state.SetComplexityN(state.range(0) * state.range(0));
}
BENCHMARK(intersect_combs)
    ->RangeMultiplier(2)
    ->Range(4, 128)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

/// A plate with many holes: one outline, n holes of six corners.
void shrink_a_grate(benchmark::State& state) {
  std::vector<Ring> rings = {test::rectangle(0, 0, 500, 500)};
  const auto side = static_cast<int>(state.range(0));
  const double pitch = 500.0 / side;
  for (int i = 0; i < side; ++i)
    for (int k = 0; k < side; ++k)
      rings.push_back(
          test::star(1, 6, {(i + 0.5) * pitch, (k + 0.5) * pitch}, 0.35 * pitch, 0.35 * pitch));
  const Polygons plate = polygons_from_rings(rings, FillRule::kEvenOdd);
  for (auto _ : state) benchmark::DoNotOptimize(offset(plate, -0.2));
  state.SetComplexityN(state.range(0) * state.range(0));
}
BENCHMARK(shrink_a_grate)
    ->RangeMultiplier(2)
    ->Range(4, 128)
    ->Unit(benchmark::kMicrosecond)
    ->Complexity();

void find_all_skins(benchmark::State& state) {
  const Model model = bench::sphere(1 << 14);
  const Slices slices = slice_mesh(model.mesh, {}, model.spec);
  for (auto _ : state) {
    std::vector<Layer> layers = slices.layers;
    find_solid(layers, static_cast<int>(state.range(0)));
    benchmark::DoNotOptimize(layers);
  }
}
BENCHMARK(find_all_skins)->Arg(1)->Arg(3)->Arg(10)->Unit(benchmark::kMillisecond);

void find_skins_within_walls(benchmark::State& state) {
  const Model model = bench::sphere(1 << 14);
  const Slices slices = slice_mesh(model.mesh, {}, model.spec);
  std::vector<Polygons> insides;
  for (const Layer& layer : slices.layers) insides.push_back(offset(layer.polygons, -0.8));
  for (auto _ : state) {
    const SkinFinder finder(slices.layers, static_cast<int>(state.range(0)));
    for (std::size_t i = 0; i < insides.size(); ++i)
      benchmark::DoNotOptimize(finder.skins_in(insides[i], i));
  }
}
BENCHMARK(find_skins_within_walls)->Arg(1)->Arg(3)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
