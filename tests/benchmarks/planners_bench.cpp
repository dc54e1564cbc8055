/// Speed of every planner over the size of a layer, and of its searches.

#include <benchmark/benchmark.h>

#include "bench_models.hpp"
#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

void plan_star(benchmark::State& state, const std::string& planner, const ParamSet& params,
               double density) {
  Registry registry;
  register_builtin_planners(registry);
  const auto planning = registry.at(planner).make(params);
  const Layer layer = bench::star_layer(state.range(0));
  PlanContext context;
  context.density = density;
  for (auto _ : state) benchmark::DoNotOptimize(planning->plan(layer, context));
  state.SetComplexityN(state.range(0));
}
BENCHMARK_CAPTURE(plan_star, greedy_shell_grid, "greedy_shell", {{"search", "grid"}}, 1.0)
    ->RangeMultiplier(4)
    ->Range(64, 1 << 14)
    ->Complexity();
BENCHMARK_CAPTURE(plan_star, greedy_shell_naive, "greedy_shell", {{"search", "naive"}}, 1.0)
    ->RangeMultiplier(4)
    ->Range(64, 1 << 12)
    ->Complexity();
BENCHMARK_CAPTURE(plan_star, greedy_shell_linear, "greedy_shell", {{"chain", "linear"}}, 1.0)
    ->RangeMultiplier(4)
    ->Range(64, 1 << 14)
    ->Complexity();
BENCHMARK_CAPTURE(plan_star, rectilinear_sparse, "rectilinear", {}, 0.2)
    ->RangeMultiplier(4)
    ->Range(64, 1 << 14)
    ->Complexity();
BENCHMARK_CAPTURE(plan_star, rectilinear_dense, "rectilinear", {}, 1.0)
    ->RangeMultiplier(4)
    ->Range(64, 1 << 14)
    ->Complexity();
BENCHMARK_CAPTURE(plan_star, rectilinear_naive, "rectilinear", {{"search", "naive"}}, 1.0)
    ->RangeMultiplier(4)
    ->Range(64, 1 << 12)
    ->Complexity();

}  // namespace
