/// Speed of writing and reading G-code.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "bench_models.hpp"
#include "routebench/harness/gcode_reader.hpp"
#include "routebench/harness/gcode_writer.hpp"
#include "routebench/harness/output.hpp"
#include "scratch_dir.hpp"

namespace {

using namespace routebench;

/// One layer whose only stroke runs along the outline of a star.
struct Print {
  explicit Print(std::int64_t points) : layer(bench::star_layer(points)) {
    Stroke stroke{layer.polygons[0].outer, 0.45};
    stroke.points.push_back(stroke.points.front());
    planned.route.strokes.push_back(std::move(stroke));
    planned.kinds.push_back(StrokeKind::kWall);
  }

  void write(std::ostream& out) const {
    GcodeWriter writer(out, {}, {}, {});
    writer.write_layer(layer, planned);
    writer.finish();
  }
  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    write(out);
    return std::move(out).str();
  }

  Layer layer;
  PlannedLayer planned;
};

void over_points(benchmark::internal::Benchmark* bench) {
  bench->RangeMultiplier(8)->Range(1 << 9, 1 << 18)->Unit(benchmark::kMillisecond)->Complexity();
}

void count(benchmark::State& state, std::size_t bytes) {
  state.SetComplexityN(state.range(0));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void write_gcode_file(benchmark::State& state) {
  const Print print(state.range(0));
  const test::ScratchDir folder;
  for (auto _ : state) {
    OutputSet outputs;
    outputs.add(folder.path() / "out.gcode", [&](std::ostream& out) { print.write(out); });
    outputs.commit();
  }
  count(state, print.text().size());
}
BENCHMARK(write_gcode_file)->Apply(over_points);

/// What the file system takes for the same bytes, ready made.
void write_ready_bytes(benchmark::State& state) {
  const std::string text = Print(state.range(0)).text();
  const test::ScratchDir folder;
  for (auto _ : state) {
    OutputSet outputs;
    outputs.add(folder.path() / "out.gcode", [&](std::ostream& out) {
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
    });
    outputs.commit();
  }
  count(state, text.size());
}
BENCHMARK(write_ready_bytes)->Apply(over_points);

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
