#include "routebench/harness/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace routebench {
namespace {

TEST(ParallelLoop, RunsEveryItemOnce) {
  for (const int jobs : {1, 2, 7}) {
    std::vector<std::atomic<int>> runs(1000);
    parallel_loop(jobs)(runs.size(), [&](std::size_t i) { ++runs[i]; });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelLoop, ReportsTheLowestItemsFailureWhateverTheTiming) {
  for (int round = 0; round < 50; ++round) {
    try {
      parallel_loop(4)(100, [](std::size_t i) {
        if (i >= 3) throw std::runtime_error(std::to_string(i));
      });
      FAIL() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3");
    }
  }
}

TEST(ParallelLoop, NothingToDoIsDone) {
  parallel_loop(3)(0, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace routebench
