/// Speed of slicing by method, of chaining, and of questions to outlines.

#include <benchmark/benchmark.h>

#include <random>

#include "bench_models.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/slice.hpp"
#include "slicing/chain_segments.hpp"
#include "slicing/cut_triangles.hpp"

namespace {

using namespace routebench;

void over_triangles(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(4)->Range(1 << 10, 1 << 20)->Unit(benchmark::kMillisecond)->Complexity();
}

/// Cutting, chaining and union of the rings.
template <SliceMethod kMethod>
void slice_sphere(benchmark::State& state) {
  const Model model = bench::sphere(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(slice_mesh(model.mesh, {.method = kMethod}, model.spec));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(slice_sphere<SliceMethod::kBucket>)->Apply(over_triangles);
BENCHMARK(slice_sphere<SliceMethod::kSweep>)->Apply(over_triangles);
BENCHMARK(slice_sphere<SliceMethod::kNaive>)
    ->RangeMultiplier(4)
    ->Range(1 << 10, 1 << 18)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

/// From the cuts of a layer to its rings, in 100 layers.
void chain_cuts(benchmark::State& state) {
  const Model model = bench::sphere(state.range(0));
  const slicing::Planes planes{0.6, 100};
  const slicing::CutTable table =
      slicing::cut_triangles(model.mesh, planes, SliceMethod::kBucket, model.spec, serial_for);
  for (auto _ : state)
    for (int layer = 0; layer < planes.count; ++layer)
      benchmark::DoNotOptimize(slicing::chain_cuts(table.layer(static_cast<std::size_t>(layer)),
                                                   model.mesh, planes.z_mm(layer)));
  state.SetComplexityN(state.range(0));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(table.cuts.size()));
}
BENCHMARK(chain_cuts)->Apply(over_triangles);

void build_edge_grid(benchmark::State& state) {
  const Layer layer = bench::star_layer(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(EdgeGrid(layer.polygons));
  state.SetComplexityN(state.range(0));
}
BENCHMARK(build_edge_grid)->RangeMultiplier(4)->Range(64, 1 << 16)->Complexity();

/// Whether travels cross an outline.
void cross_outline(benchmark::State& state) {
  const Layer layer = bench::star_layer(state.range(0));
  const EdgeGrid outline(layer.polygons);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(0, 100);
  std::vector<Point2> ends(2048);
  for (Point2& p : ends) p = {place(random), place(random)};
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(outline.outside_length_mm(ends[i], ends[i + 1]));
    i = (i + 2) % ends.size();
  }
}
BENCHMARK(cross_outline)->RangeMultiplier(8)->Range(64, 1 << 15);

}  // namespace
