/// Speed of every planner over the size of a layer, and of its searches.

#include <benchmark/benchmark.h>

#include <algorithm>

#include "bench_models.hpp"
#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

const Registry& planners() {
  static const Registry registry = [] {
    Registry built_in;
    register_builtin_planners(built_in);
    return built_in;
  }();
  return registry;
}

std::size_t segments_of(const Route& route) {
  std::size_t segments = 0;
  for (const Stroke& stroke : route.strokes) segments += stroke.points.size() - 1;
  return segments;
}

/// Items are segments of the route.
void plan(benchmark::State& state, const Planner& planner, double density) {
  const Layer layer = bench::star_layer(state.range(0));
  PlanContext context;
  context.density = density;
  Route route;
  for (auto _ : state) route = planner.plan(layer, context);
  state.SetComplexityN(state.range(0));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(segments_of(route)));
}

void plan_star(benchmark::State& state, const std::string& planner, const ParamSet& params,
               double density) {
  plan(state, *planners().at(planner).make(params), density);
}
void over_points(benchmark::internal::Benchmark* bench, std::int64_t most) {
  bench->RangeMultiplier(4)->Range(64, most)->Unit(benchmark::kMicrosecond)->Complexity();
}
void to_many(benchmark::internal::Benchmark* bench) { over_points(bench, 1 << 14); }
void to_few(benchmark::internal::Benchmark* bench) { over_points(bench, 1 << 12); }

/// greedy_shell with its grid round the holes of a plate; a hole has 20 segments.
void walls_of_a_plate(benchmark::State& state) {
  constexpr double kPitchMm = 5;
  const auto side = static_cast<int>(state.range(0));
  Layer layer = bench::star_layer(3);
  layer.polygons = {{test::rectangle(0, 0, kPitchMm * side, kPitchMm * side), {}}};
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y) {
      Ring hole = test::star(1, 20, {(x + 0.5) * kPitchMm, (y + 0.5) * kPitchMm}, 1.5, 1.5);
      std::reverse(hole.begin(), hole.end());
      layer.polygons[0].holes.push_back(std::move(hole));
    }
  PlanContext context;
  context.perimeters = 1;
  const auto planner = planners().at("greedy_shell").make({});
  std::size_t segments = 0;
  for (auto _ : state) segments = segments_of(planner->plan(layer, context));
  state.counters["segments"] = static_cast<double>(segments);
  state.SetComplexityN(static_cast<std::int64_t>(segments));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(segments));
}
BENCHMARK(walls_of_a_plate)->Arg(7)->Arg(22)->Arg(71)->Unit(benchmark::kMillisecond)->Complexity();

/// Whatever is registered, with its defaults.
const int registered = [] {
  for (const auto& [name, entry] : planners().entries()) {
    for (const double density : {1.0, 0.2}) {
      if (entry.info.role == PlannerRole::kShell && density < 1) continue;
      const std::string shown = "plan/" + name + (density < 1 ? "/sparse" : "/dense");
      const auto run = [&planner = entry, density](benchmark::State& state) {
        plan(state, *planner.make({}), density);
      };
      to_many(benchmark::RegisterBenchmark(shown.c_str(), run));
    }
  }
  return 0;
}();

BENCHMARK_CAPTURE(plan_star, greedy_shell_naive, "greedy_shell", {{"search", "naive"}}, 1.0)
    ->Apply(to_few);
BENCHMARK_CAPTURE(plan_star, greedy_shell_linear, "greedy_shell", {{"chain", "linear"}}, 1.0)
    ->Apply(to_many);
BENCHMARK_CAPTURE(plan_star, rectilinear_sweep, "rectilinear", {{"search", "sweep"}}, 1.0)
    ->Apply(to_many);
BENCHMARK_CAPTURE(plan_star, rectilinear_naive, "rectilinear", {{"search", "naive"}}, 1.0)
    ->Apply(to_few);
BENCHMARK_CAPTURE(plan_star, eulerian_published, "eulerian", {{"variant", "published"}}, 1.0)
    ->Apply(to_few);
BENCHMARK_CAPTURE(plan_star, eulerian_grid, "eulerian", {{"graph", "grid"}}, 1.0)->Apply(to_few);
BENCHMARK_CAPTURE(plan_star, voxel_euler, "voxel", {{"inside", "euler"}}, 1.0)->Apply(to_many);

}  // namespace
