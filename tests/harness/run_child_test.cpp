#include "run_child.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

namespace routebench {
namespace {

using How = ChildEnd::How;

/// Not known to the optimiser.
volatile int one = 1;

ChildEnd end_of(const ChildPool::Work& work, ChildLimits limits = {30, 2048}) {
  ChildPool pool(limits);
  pool.start(0, work);
  for (;;)
    for (ChildPool::Finished& finished : pool.wait()) return std::move(finished.end);
}

TEST(ChildPool, BringsBackWhatTheWorkReturns) {
  const std::string bytes("a\0b\n", 4);
  const ChildEnd end = end_of([&](ChildProgress&) { return bytes; });
  EXPECT_EQ(end.how, How::kResult);
  EXPECT_EQ(end.text, bytes);
}

TEST(ChildPool, BringsBackMoreThanAPipeHolds) {
  std::string bytes(5'000'000, 'x');
  for (std::size_t i = 0; i < bytes.size(); i += 7) bytes[i] = static_cast<char>('a' + i % 23);
  const ChildEnd end = end_of([&](ChildProgress&) { return bytes; });
  EXPECT_EQ(end.how, How::kResult);
  EXPECT_EQ(end.text, bytes);
}

TEST(ChildPool, TellsWhatWasThrown) {
  const ChildEnd end =
      end_of([](ChildProgress&) -> std::string { throw std::out_of_range("lost my list"); });
  EXPECT_EQ(end.how, How::kException);
  EXPECT_EQ(end.text, "lost my list");
  EXPECT_EQ(end_of([](ChildProgress&) -> std::string { throw 42; }).how, How::kException);
}

TEST(ChildPool, NamesTheSignalAndThePlace) {
  const ChildEnd end = end_of([](ChildProgress& progress) -> std::string {
    progress.layer = 12;
    progress.phase = ChildProgress::kJudging;
    raise(SIGSEGV);
    return {};
  });
  EXPECT_EQ(end.how, How::kSignal);
  EXPECT_EQ(signal_name(end.code), "SIGSEGV");
  EXPECT_EQ(end.layer, 12);
  EXPECT_EQ(end.phase, ChildProgress::kJudging);
}

TEST(ChildPool, KeepsTheLastWordsOfAnAbort) {
  const ChildEnd end = end_of([](ChildProgress&) -> std::string {
    std::fprintf(stderr, "sorry\n");
    std::abort();
  });
  EXPECT_EQ(end.how, How::kSignal);
  EXPECT_EQ(signal_name(end.code), "SIGABRT");
  EXPECT_NE(end.last_words.find("sorry"), std::string::npos);
}

TEST(ChildPool, EndingTheProcessIsNoResult) {
  for (const int code : {0, 7}) {
    const ChildEnd end = end_of([code](ChildProgress&) -> std::string { _exit(code); });
    EXPECT_EQ(end.how, How::kExited);
    EXPECT_EQ(end.code, code);
  }
}

TEST(ChildPool, StopsWorkThatGoesOnForever) {
  const ChildEnd end = end_of(
      [](ChildProgress&) -> std::string {
        for (int i = 0;; i += one)
          if (i < 0) i = 0;
      },
      {0.2, 2048});
  EXPECT_EQ(end.how, How::kTimedOut);
  EXPECT_GE(end.wall_s, 0.2);
}

TEST(ChildPool, StopsWorkThatIgnoresSignalsAndSleeps) {
  const ChildEnd end = end_of(
      [](ChildProgress&) -> std::string {
        for (const int number : {SIGTERM, SIGINT, SIGHUP}) signal(number, SIG_IGN);
        for (;;) pause();
      },
      {0.2, 2048});
  EXPECT_EQ(end.how, How::kTimedOut);
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(ChildPool, BoundsMemory) {
  const ChildEnd end = end_of(
      [](ChildProgress&) {
        std::vector<std::string> hoard;
        while (one == 1) hoard.emplace_back(1 << 20, 'x');
        return std::string("got it all");
      },
      {30, 64});
  EXPECT_EQ(end.how, How::kOutOfMemory);
}

TEST(ChildPool, BoundsMemoryWhereNothingMayBeThrown) {
  const ChildEnd end = end_of(
      [](ChildProgress&) {
        const auto hoard = []() noexcept {
          std::vector<std::string> all;
          while (one == 1) all.emplace_back(1 << 20, 'x');
          return all;
        };
        return hoard().front();
      },
      {30, 64});
  EXPECT_EQ(end.how, How::kOutOfMemory);
}

TEST(ChildPool, MemoryWithinTheLimitIsGranted) {
  const ChildEnd end =
      end_of([](ChildProgress&) { return std::string(std::string(40 << 20, 'x').size(), 'y'); },
             {30, 128});
  EXPECT_EQ(end.how, How::kResult);
  EXPECT_EQ(end.text.size(), std::size_t{40} << 20);
}
#endif

TEST(ChildPool, JunkOnTheStandardOutputStaysInside) {
  testing::internal::CaptureStdout();
  const ChildEnd end = end_of([](ChildProgress&) {
    for (int i = 0; i < 100'000; ++i) std::printf("junk %d\n", i);
    std::fflush(stdout);
    return std::string("done");
  });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(end.how, How::kResult);
  EXPECT_EQ(end.text, "done");
  EXPECT_LE(end.last_words.size(), 2000u);
}

TEST(ChildPool, ClosingAllFilesCostsTheResultOnly) {
  const ChildEnd end = end_of([](ChildProgress&) {
    for (int i = 0; i < 100; ++i) close(i);
    return std::string("nobody hears this");
  });
  EXPECT_EQ(end.how, How::kExited);
}

TEST(ChildPool, JunkInTheResultPipeIsNoResult) {
  const ChildEnd end = end_of([](ChildProgress&) {
    for (int i = 3; i < 100; ++i) static_cast<void>(!write(i, "junkjunkjunk", 12));
    return std::string("done");
  });
  EXPECT_EQ(end.how, How::kExited);
}

TEST(ChildPool, AChildHasNoOpenFileOfItsParent) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const ChildEnd end = end_of([&](ChildProgress&) {
    return std::string(write(ends[1], "x", 1) == 1 ? "wrote" : "could not");
  });
  EXPECT_EQ(end.text, "could not");
  close(ends[0]);
  close(ends[1]);
}

TEST(ChildPool, ThreadsThatStillRunDoNotMatter) {
  const ChildEnd end = end_of([](ChildProgress&) {
    std::thread([] {
      for (;;) pause();
    }).detach();
    return std::string("done");
  });
  EXPECT_EQ(end.how, How::kResult);
}

TEST(ChildPool, WhatAChildStartedEndsWithIt) {
  const ChildEnd end = end_of([](ChildProgress&) {
    const pid_t grandchild = fork();
    if (grandchild == 0)
      for (;;) pause();
    return std::to_string(grandchild);
  });
  ASSERT_EQ(end.how, How::kResult);
  const pid_t grandchild = static_cast<pid_t>(std::stol(end.text));
  // It is adopted and reaped by somebody else, which may take a moment; a zombie is dead, too.
  const std::string stat = "/proc/" + std::to_string(grandchild) + "/stat";
  bool gone = false;
  for (int i = 0; i < 500 && !gone; ++i) {
    std::FILE* file = std::fopen(stat.c_str(), "r");
    char state = 'Z';
    if (file != nullptr) {
      static_cast<void>(!std::fscanf(file, "%*d %*s %c", &state));
      std::fclose(file);
    }
    gone = state == 'Z' || state == 'X';
    if (!gone) usleep(10'000);
  }
  EXPECT_TRUE(gone);
}

TEST(ChildPool, LeavesNoCoreFileAndNoZombie) {
  const ChildEnd end = end_of([](ChildProgress&) {
    rlimit core{};
    getrlimit(RLIMIT_CORE, &core);
    return std::to_string(core.rlim_cur);
  });
  EXPECT_EQ(end.text, "0");
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(ChildPool, RunsManyAndKeepsThemApart) {
  ChildPool pool({30, 2048});
  std::vector<std::string> results(40);
  std::size_t started = 0, finished = 0;
  while (finished < results.size()) {
    while (started < results.size() && pool.running() < 7) {
      pool.start(started, [started](ChildProgress&) -> std::string {
        if (started % 10 == 3) std::abort();
        return "result " + std::to_string(started);
      });
      ++started;
    }
    for (const ChildPool::Finished& one_of_them : pool.wait()) {
      results[one_of_them.id] =
          one_of_them.end.how == How::kResult ? one_of_them.end.text : "failed";
      ++finished;
    }
  }
  for (std::size_t i = 0; i < results.size(); ++i)
    EXPECT_EQ(results[i], i % 10 == 3 ? "failed" : "result " + std::to_string(i));
}

TEST(ChildPool, KillsWhatRunsWhenItGoes) {
  {
    ChildPool pool({30, 2048});
    pool.start(0, [](ChildProgress&) -> std::string {
      for (;;) pause();
    });
  }
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

}  // namespace
}  // namespace routebench
