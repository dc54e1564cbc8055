/// Speed of judging one layer, beside that of planning it.

#include <benchmark/benchmark.h>

#include "bench_models.hpp"
#include "judge/coverage.hpp"
#include "judge/layer_samples.hpp"
#include "judge/run.hpp"
#include "judge/strays.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/demand.hpp"
#include "routebench/harness/judge.hpp"
#include "routebench/planning/plugin.hpp"

namespace {

using namespace routebench;

/// One layer with everything that its judging needs.
struct Case {
  explicit Case(double density) {
    Registry registry;
    register_builtin_planners(registry);
    task.density = density;
    layer = bench::star_layer(2000);
    demand = demand_of(layer, task);
    ContenderSpec spec;
    spec.name = "both";
    spec.shell = SlotSpec{"greedy_shell", {}};
    spec.fill = SlotSpec{"rectilinear", {}};
    contender.emplace(std::move(spec), registry);
  }
  [[nodiscard]] PlannedLayer plan() const {
    return contender->plan(layer, demand, task, {0, 0}, 1, {});
  }

  Task task;
  Layer layer;
  Demand demand;
  std::optional<Contender> contender;
};

double density_of(const benchmark::State& state) {
  return static_cast<double>(state.range(0)) / 100;
}

void plan_layer(benchmark::State& state) {
  const Case layer(density_of(state));
  for (auto _ : state) benchmark::DoNotOptimize(layer.plan());
}
BENCHMARK(plan_layer)->ArgName("percent")->Arg(20)->Arg(100)->Unit(benchmark::kMillisecond);

void judge_layer(benchmark::State& state) {
  const Case layer(density_of(state));
  const PlannedLayer planned = layer.plan();
  const Judge judge(layer.task, {});
  for (auto _ : state)
    benchmark::DoNotOptimize(judge.score(layer.layer, layer.demand, planned.route, {}));
}
BENCHMARK(judge_layer)->ArgName("percent")->Arg(20)->Arg(100)->Unit(benchmark::kMillisecond);

/// Of judging, what beads cover, at samples 0.05 mm apart.
void cover_layer(benchmark::State& state) {
  const Case layer(density_of(state));
  const std::vector<judging::Run> runs = judging::runs_of(layer.plan().route, layer.task.join_mm);
  const EdgeGrid outline(layer.demand.outline);
  for (auto _ : state) {
    const judging::LayerSamples samples(layer.demand, layer.task);
    const judging::Strays strays = judging::strays_of(runs, outline, layer.task.line_width_mm);
    benchmark::DoNotOptimize(judging::measure_coverage(
        samples, samples.outline.count(), layer.demand, runs, strays.beads, layer.task));
  }
}
BENCHMARK(cover_layer)->ArgName("percent")->Arg(20)->Arg(100)->Unit(benchmark::kMillisecond);

}  // namespace
