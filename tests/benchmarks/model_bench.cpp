/// Speed of reading models, beside that of only looking at their bytes; of welding and of slicing
/// what was read.

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "bench_models.hpp"
#include "model/vertex_welder.hpp"
#include "routebench/geometry/slice.hpp"
#include "routebench/geometry/stl.hpp"
#include "routebench/harness/parallel.hpp"
#include "scratch_dir.hpp"

namespace {

using namespace routebench;
namespace fs = std::filesystem;

std::string ascii_stl(const Mesh& mesh) {
  std::string text = "solid sphere\n";
  for (const auto& triangle : mesh.triangles) {
    text += "  facet normal 0.57735026 -0.57735026 0.57735026\n    outer loop\n";
    for (const std::uint32_t corner : triangle) {
      const Point3& p = mesh.vertices[corner];
      std::array<char, 128> line;
      const int length =
          std::snprintf(line.data(), line.size(), "      vertex %.9g %.9g %.9g\n", p.x, p.y, p.z);
      text.append(line.data(), static_cast<std::size_t>(length));
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid sphere\n";
}

/// What a file of a sphere is like.
enum class Kind {
  kBinary,
  kAscii,
  kScan,  ///< binary, with the rough surface and the order of a simplified scan
};

/// Moves vertices by up to 0.01 mm and shuffles the triangles, a few neighbours together.
void make_like_a_scan(Mesh& mesh) {
  constexpr std::size_t kTogether = 16;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> noise_mm(-0.01, 0.01);
  for (Point3& p : mesh.vertices)
    p = {p.x + noise_mm(random), p.y + noise_mm(random), p.z + noise_mm(random)};
  std::vector<std::size_t> begins;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += kTogether) begins.push_back(t);
  std::shuffle(begins.begin(), begins.end(), random);
  std::vector<std::array<std::uint32_t, 3>> shuffled;
  for (const std::size_t begin : begins)
    for (std::size_t t = begin; t < std::min(begin + kTogether, mesh.triangles.size()); ++t)
      shuffled.push_back(mesh.triangles[t]);
  mesh.triangles = std::move(shuffled);
}

/// A file of a sphere, 150 mm across, that is there as long as the program.
class SphereFile {
 public:
  SphereFile(std::int64_t triangles, Kind kind) : path_(folder_.path() / "model.stl") {
    Mesh mesh = load_model("shape:sphere?diameter=150&triangles=" + std::to_string(triangles)).mesh;
    if (kind == Kind::kScan) make_like_a_scan(mesh);
    std::ofstream(path_, std::ios::binary)
        << (kind == Kind::kAscii ? ascii_stl(mesh) : stl_bytes(mesh));
    bytes_ = fs::file_size(path_);
  }
  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  test::ScratchDir folder_;
  fs::path path_;
  std::size_t bytes_ = 0;
};

/// Large files are written once.
const SphereFile& sphere_file(std::int64_t triangles, Kind kind) {
  static std::map<std::pair<std::int64_t, Kind>, SphereFile> files;
  return files.try_emplace({triangles, kind}, triangles, kind).first->second;
}

void count(benchmark::State& state, std::size_t bytes) {
  state.SetComplexityN(state.range(0));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

/// All bytes of a file, into memory for as many.
void read_into(const std::string& path, std::span<char> bytes) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const ssize_t length = ::read(file, bytes.data(), bytes.size());
  if (file < 0 || static_cast<std::size_t>(length) != bytes.size())
    throw std::runtime_error("cannot read " + path);
  ::close(file);
}

/// Gives freed memory back to the system, as a process that has just begun has to get its memory
/// from there.
void give_back_memory(benchmark::State& state) {
  state.PauseTiming();
  ::malloc_trim(0);
  state.ResumeTiming();
}

/// Reading means welding, mending, the mesh's report and its placement, too.
template <Kind kKind>
void read_stl(benchmark::State& state) {
  const SphereFile& file = sphere_file(state.range(0), kKind);
  const ParallelFor parallel_for = parallel_loop(static_cast<int>(state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(load_model(file.path(), {}, parallel_for));
  count(state, file.bytes());
}
void over_sizes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"triangles", "jobs"})
      ->ArgsProduct({benchmark::CreateRange(1 << 10, 1 << 20, 4), {1}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Complexity();
}
void two_million(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"triangles", "jobs"})
      ->ArgsProduct({{2'000'000}, {1, 2}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}
BENCHMARK(read_stl<Kind::kBinary>)->Name("read_binary_stl")->Apply(over_sizes);
BENCHMARK(read_stl<Kind::kAscii>)->Name("read_ascii_stl")->Apply(over_sizes);
BENCHMARK(read_stl<Kind::kBinary>)->Name("read_large_binary_stl")->Apply(two_million);
BENCHMARK(read_stl<Kind::kAscii>)->Name("read_large_ascii_stl")->Apply(two_million);

/// What the system takes to hand over the bytes of the same file, into memory that is there or new.
void copy_large_binary_stl(benchmark::State& state) {
  const SphereFile& file = sphere_file(state.range(0), Kind::kBinary);
  for (auto _ : state) {
    if (state.range(1) != 0) give_back_memory(state);
    const auto bytes = std::make_unique_for_overwrite<char[]>(file.bytes());
    read_into(file.path(), {bytes.get(), file.bytes()});
    benchmark::DoNotOptimize(bytes.get());
  }
  count(state, file.bytes());
}
BENCHMARK(copy_large_binary_stl)
    ->ArgNames({"triangles", "new_memory"})
    ->ArgsProduct({{2'000'000}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// What it takes to read the same text and count its lines.
void scan_large_ascii_stl(benchmark::State& state) {
  const SphereFile& file = sphere_file(state.range(0), Kind::kAscii);
  std::string bytes(file.bytes(), '\0');
  for (auto _ : state) {
    read_into(file.path(), bytes);
    benchmark::DoNotOptimize(std::count(bytes.begin(), bytes.end(), '\n'));
  }
  count(state, file.bytes());
}
BENCHMARK(scan_large_ascii_stl)->Arg(2'000'000)->Unit(benchmark::kMillisecond)->UseRealTime();

/// From a binary file to 750 layers, in memory that is there or new.
template <Kind kKind>
void read_and_slice(benchmark::State& state) {
  const SphereFile& file = sphere_file(state.range(0), kKind);
  const ParallelFor parallel_for = parallel_loop(static_cast<int>(state.range(1)));
  for (auto _ : state) {
    if (state.range(2) != 0) give_back_memory(state);
    const Model model = load_model(file.path(), {}, parallel_for);
    benchmark::DoNotOptimize(slice_mesh(model.mesh, {}, model.spec, parallel_for));
  }
  count(state, file.bytes());
}
void over_memory(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"triangles", "jobs", "new_memory"})
      ->ArgsProduct({{2'000'000}, {1, 2}, {0, 1}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}
BENCHMARK(read_and_slice<Kind::kBinary>)->Name("read_and_slice")->Apply(over_memory);
BENCHMARK(read_and_slice<Kind::kScan>)->Name("read_and_slice_scan")->Apply(over_memory);

/// Equal corners become one vertex; what the readers do on the way.
void weld_corners(benchmark::State& state) {
  using Welder = models::VertexWelder<models::FloatPoint>;
  const Mesh mesh = bench::sphere(state.range(0)).mesh;
  std::vector<models::FloatPoint> corners;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle) {
      const Point3& p = mesh.vertices[corner];
      corners.push_back(
          {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
  std::vector<std::uint32_t> numbers(corners.size());
  for (auto _ : state) {
    Welder welder(mesh.triangles.size() / 2);
    for (std::size_t i = 0; i < corners.size(); i += Welder::kBatch)
      welder.weld(std::span(corners).subspan(i, std::min(Welder::kBatch, corners.size() - i)),
                  numbers.data() + i);
    benchmark::DoNotOptimize(welder.take_vertices());
  }
  state.SetComplexityN(state.range(0));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(corners.size()));
}
BENCHMARK(weld_corners)
    ->RangeMultiplier(4)
    ->Range(1 << 10, 1 << 20)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
