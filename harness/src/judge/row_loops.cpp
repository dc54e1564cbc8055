#include "judge/row_loops.hpp"

#include "judge/row_loops_lanes.hpp"

namespace routebench::judging {

const RowLoops kPlainLoops = kLoops;

std::vector<const RowLoops*> runnable_row_loops() {
  std::vector<const RowLoops*> loops{&kPlainLoops};
#if defined(ROUTEBENCH_X86_LOOPS)
  if (__builtin_cpu_supports("avx2")) loops.push_back(&kAvx2Loops);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vpopcntdq"))
    loops.push_back(&kAvx512Loops);
#endif
  return loops;
}

const RowLoops& row_loops() noexcept {
  static const RowLoops& fastest = *runnable_row_loops().back();
  return fastest;
}

}  // namespace routebench::judging
