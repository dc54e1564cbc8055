/// Speed of slicing, by method and size, and of region work.

#include <benchmark/benchmark.h>

#include "bench_models.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/solid.hpp"

namespace {

using namespace routebench;

void set_size(benchmark::State& state) { state.SetComplexityN(state.range(0)); }

template <SliceMethod kMethod>
void slice_sphere(benchmark::State& state) {
  const Model model = bench::sphere(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(slice_mesh(model.mesh, {.method = kMethod}, model.spec));
  set_size(state);
}
BENCHMARK(slice_sphere<SliceMethod::kBucket>)
    ->RangeMultiplier(4)
    ->Range(1 << 10, 1 << 20)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK(slice_sphere<SliceMethod::kSweep>)
    ->RangeMultiplier(4)
    ->Range(1 << 10, 1 << 20)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();
BENCHMARK(slice_sphere<SliceMethod::kNaive>)
    ->RangeMultiplier(4)
    ->Range(1 << 10, 1 << 18)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

void find_skins(benchmark::State& state) {
  const Model model = bench::sphere(1 << 14);
  const Slices slices = slice_mesh(model.mesh, {}, model.spec);
  for (auto _ : state) {
    std::vector<Layer> layers = slices.layers;
    find_solid(layers, static_cast<int>(state.range(0)));
    benchmark::DoNotOptimize(layers);
  }
}
BENCHMARK(find_skins)->Arg(1)->Arg(3)->Arg(10)->Unit(benchmark::kMillisecond);

void shrink_by_a_line(benchmark::State& state) {
  const Layer layer = bench::star_layer(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(offset(layer.polygons, -0.4));
  set_size(state);
}
BENCHMARK(shrink_by_a_line)->RangeMultiplier(4)->Range(64, 1 << 14)->Complexity();

}  // namespace
