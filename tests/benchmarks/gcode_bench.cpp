/// Speed of writing and reading G-code.

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <sstream>

#include "bench_models.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/gcode_writer.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/parallel.hpp"
#include "scratch_dir.hpp"

namespace {

using namespace routebench;

/// Layers whose only stroke runs along the outline of a star.
class Print {
 public:
  explicit Print(std::int64_t points_a_layer, std::size_t layers = 1)
      : layer_(bench::star_layer(points_a_layer)) {
    Stroke stroke{layer_.polygons[0].outer, 0.45};
    stroke.points.push_back(stroke.points.front());
    planned_.route.strokes.push_back(std::move(stroke));
    planned_.kinds.push_back(StrokeKind::kWall);
    layers_.assign(layers, {&layer_, &planned_});
  }
  Print(const Print&) = delete;  // the layers point to the one
  Print& operator=(const Print&) = delete;

  void write(std::ostream& out, const ParallelFor& parallel_for = serial_for) const {
    GcodeWriter writer(out, {}, {}, {});
    writer.write_layers(layers_, parallel_for);
    writer.finish();
  }
  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    write(out);
    return std::move(out).str();
  }

 private:
  Layer layer_;
  PlannedLayer planned_;
  std::vector<RoutedLayer> layers_;
};

constexpr std::size_t kLayers = 256;

void over_points(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(8)->Range(1 << 9, 1 << 18)->Unit(benchmark::kMillisecond)->Complexity();
}

void count(benchmark::State& state, std::size_t bytes) {
  state.SetComplexityN(state.range(0));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void write_gcode_file(benchmark::State& state) {
  const Print print(state.range(0), kLayers);
  const ParallelFor parallel_for = parallel_loop(static_cast<int>(state.range(1)));
  const test::ScratchDir folder;
  for (auto _ : state) {
    OutputSet outputs;
    outputs.add(folder.path() / "out.gcode",
                [&](std::ostream& out) { print.write(out, parallel_for); });
    outputs.commit();
  }
  count(state, print.text().size());
}
BENCHMARK(write_gcode_file)
    ->ArgNames({"points", "jobs"})
    ->ArgsProduct({{256, 2048}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// What the file system takes for the same bytes, ready made and written at once: until they are in
/// its memory, or until they are on the disk.
void write_ready_bytes(benchmark::State& state) {
  const std::string text = Print(state.range(0), kLayers).text();
  const test::ScratchDir folder;
  const std::string name = folder.path() / "out.gcode";
  for (auto _ : state) {
    std::remove(name.c_str());
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    const ssize_t written = ::write(file, text.data(), text.size());
    if (file < 0 || static_cast<std::size_t>(written) != text.size()) {
      state.SkipWithError("cannot write");
      break;
    }
    if (state.range(1) != 0) ::fsync(file);
    ::close(file);
  }
  count(state, text.size());
}
BENCHMARK(write_ready_bytes)
    ->ArgNames({"points", "on_disk"})
    ->ArgsProduct({{256, 2048}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void read_gcode_text(benchmark::State& state) {
  const std::string text = Print(state.range(0)).text();
  for (auto _ : state) {
    std::istringstream in(text);
    benchmark::DoNotOptimize(read_gcode(in, "star", {}));
  }
  count(state, text.size());
}
BENCHMARK(read_gcode_text)->Apply(over_points);

}  // namespace
