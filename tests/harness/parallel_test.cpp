#include "routebench/harness/parallel.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <system_error>
#include <thread>
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

TEST(ParallelLoop, CanBeCalledAgainAndWithinItself) {
  const ParallelFor parallel_for = parallel_loop(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::atomic<int>> runs(64);
    parallel_for(
        8, [&](std::size_t i) { parallel_for(8, [&](std::size_t k) { ++runs[8 * i + k]; }); });
    for (const auto& count : runs) EXPECT_EQ(count, 1);
  }
}

TEST(ParallelLoop, ServesSeveralThreadsAtOnce) {
  const ParallelFor parallel_for = parallel_loop(3);
  std::vector<std::atomic<int>> runs(4000);
  {
    std::vector<std::jthread> callers;
    for (std::size_t caller = 0; caller < 4; ++caller)
      callers.emplace_back([&, caller] {
        for (std::size_t round = 0; round < 10; ++round)
          parallel_for(100, [&](std::size_t i) { ++runs[1000 * caller + 100 * round + i]; });
      });
  }
  for (const auto& count : runs) EXPECT_EQ(count, 1);
}

TEST(ParallelLoop, IsAPlainLoopInAFork) {
  const ParallelFor parallel_for = parallel_loop(3);
  parallel_for(10, [](std::size_t) {});  // its threads have begun
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::size_t sum = 0;
    {
      const ParallelFor copy = parallel_for;
      copy(10, [&](std::size_t i) { sum += i; });
    }
    ::_exit(sum == 45 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST(ParallelLoop, DoesWithoutThreadsThatTheSystemDenies) {
  pthread_attr_t usual, denied;
  ASSERT_EQ(::pthread_getattr_default_np(&usual), 0);
  ASSERT_EQ(::pthread_attr_init(&denied), 0);
  // No process has room for such a stack.
  ASSERT_EQ(::pthread_attr_setstacksize(&denied, std::size_t{1} << 60), 0);
  ASSERT_EQ(::pthread_setattr_default_np(&denied), 0);
  EXPECT_THROW(std::thread([] {}).join(), std::system_error);
  const ParallelFor parallel_for = parallel_loop(3);
  std::vector<std::atomic<int>> runs(100);
  EXPECT_NO_THROW(parallel_for(runs.size(), [&](std::size_t i) { ++runs[i]; }));
  EXPECT_EQ(::pthread_setattr_default_np(&usual), 0);
  for (const auto& count : runs) EXPECT_EQ(count, 1);
  // Threads begin once they are granted.
  std::atomic<int> begun{0};
  parallel_for(3, [&](std::size_t) {
    ++begun;
    begun.notify_all();
    for (int seen = begun; seen < 3; seen = begun) begun.wait(seen);
  });
  EXPECT_EQ(begun, 3);
  ::pthread_attr_destroy(&denied);
  ::pthread_attr_destroy(&usual);
}

TEST(ParallelLoop, TakesSeveralThreads) {
  const ParallelFor parallel_for = parallel_loop(2);
  // Each of two items waits for the other one to begin.
  std::atomic<int> begun{0};
  parallel_for(2, [&](std::size_t) {
    ++begun;
    begun.notify_all();
    for (int seen = begun; seen < 2; seen = begun) begun.wait(seen);
  });
  EXPECT_EQ(begun, 2);
}

TEST(ParallelLoop, LetsThreadsAndWhatTheyStartRunAnywhere) {
  const auto processors = [] {
    cpu_set_t set;
    CPU_ZERO(&set);
    EXPECT_EQ(::sched_getaffinity(0, sizeof set, &set), 0);
    return set;
  };
  const cpu_set_t all = processors();
  const ParallelFor parallel_for = parallel_loop(3);
  for (int round = 0; round < 20; ++round) {
    std::atomic<int> begun{0};
    parallel_for(3, [&](std::size_t) {  // all threads take part
      const cpu_set_t here = processors();
      EXPECT_TRUE(CPU_EQUAL(&here, &all));
      ++begun;
      begun.notify_all();
      for (int seen = begun; seen < 3; seen = begun) begun.wait(seen);
    });
  }
}

}  // namespace
}  // namespace routebench
