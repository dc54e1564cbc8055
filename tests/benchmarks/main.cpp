/// The benchmark program. Beside times it measures memory: with --benchmark_format=json or
/// --benchmark_out=FILE every benchmark has `allocs_per_iter`, and `max_bytes_used`, the most that
/// it held at a time of what it allocated itself.

#include <benchmark/benchmark.h>

#include "counted_memory.hpp"
#include "kept_memory.hpp"

namespace {

/// Told by the library when a run of its own for memory begins and ends: times are taken in others.
class CountingManager : public benchmark::MemoryManager {
 public:
  void Start() override { routebench::bench::start_counting(); }
  void Stop(Result& result) override {
    const routebench::bench::MemoryCount count = routebench::bench::stop_counting();
    result.num_allocs = count.allocations;
    result.max_bytes_used = count.most_bytes;
    result.total_allocated_bytes = count.allocated_bytes;
    result.net_heap_growth = count.bytes;
  }
  void Stop(Result* result) override { Stop(*result); }
};

}  // namespace

int main(int argc, char** argv) {
  routebench::keep_freed_memory();  // as the commands do that read, slice and plan
  CountingManager memory;
  benchmark::RegisterMemoryManager(&memory);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::RegisterMemoryManager(nullptr);
  benchmark::Shutdown();
  return 0;
}
