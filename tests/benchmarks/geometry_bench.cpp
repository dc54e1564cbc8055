/// Speed of reading and welding meshes, of slicing by method, and of questions to outlines.

#include <benchmark/benchmark.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "bench_models.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/stl.hpp"
#include "scratch_dir.hpp"

namespace {

using namespace routebench;
namespace fs = std::filesystem;

std::string ascii_stl(const Mesh& mesh) {
  std::string text = "solid sphere\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t corner : triangle) {
      const Point3& p = mesh.vertices[corner];
      for (const std::string& piece :
           {std::string("vertex "), std::to_string(p.x), std::string(" "), std::to_string(p.y),
            std::string(" "), std::to_string(p.z), std::string("\n")})
        text += piece;
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

void read_file(benchmark::State& state, const std::string& bytes) {
  const test::ScratchDir folder;
  const fs::path file = folder.path() / "model.stl";
  std::ofstream(file, std::ios::binary) << bytes;
  for (auto _ : state) benchmark::DoNotOptimize(load_model(file.string()));
  state.SetComplexityN(state.range(0));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}

/// Reading includes welding, the mesh's report and its placement.
void read_binary_stl(benchmark::State& state) {
  read_file(state, stl_bytes(bench::sphere(state.range(0)).mesh));
}
void read_ascii_stl(benchmark::State& state) {
  read_file(state, ascii_stl(bench::sphere(state.range(0)).mesh));
}
void over_triangles(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(4)->Range(1 << 10, 1 << 20)->Unit(benchmark::kMillisecond)->Complexity();
}
BENCHMARK(read_binary_stl)->Apply(over_triangles);
BENCHMARK(read_ascii_stl)->Apply(over_triangles);

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
