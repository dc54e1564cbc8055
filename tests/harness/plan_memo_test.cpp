#include "plan_memo.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include "polygons.hpp"

namespace routebench {
namespace {

using Question = PlanMemo::Question;

const Question kQuestion{nullptr, 0, 0.2, {0, 0}, 1};
const Route kRoute{{{{{0, 0}, {1, 0}}, 0.4}}};

TEST(PlanMemo, AnotherRegionOrQuestionIsPlannedAnew) {
  PlanMemo memo;
  int calls = 0;
  const auto ask = [&](const Question& question, const Polygons& region) {
    static_cast<void>(memo.route(question, region, [&] {
      ++calls;
      return kRoute;
    }));
    return calls;
  };
  const Polygons square = {{test::rectangle(0, 0, 1, 1), {}}};
  const Polygons both = {square[0], {test::rectangle(2, 0, 3, 1), {}}};
  EXPECT_EQ(ask(kQuestion, square), 1);
  EXPECT_EQ(ask(kQuestion, square), 1);
  EXPECT_EQ(ask(kQuestion, both), 2);
  int expected = 2;
  for (int part = 0; part < 4; ++part) {
    Question other = kQuestion;
    if (part == 0) other.phase = 1;
    if (part == 1) other.height_mm = 0.3;
    if (part == 2) other.start = {1, 0};
    if (part == 3) other.density = 0.2;
    EXPECT_EQ(ask(other, square), ++expected);
    EXPECT_EQ(ask(other, square), expected);
  }
  EXPECT_EQ(ask(kQuestion, both), expected);
}

TEST(PlanMemo, WhoComesMeanwhileWaitsAndGetsTheSameRoute) {
  PlanMemo memo;
  const Polygons square = {{test::rectangle(0, 0, 1, 1), {}}};
  std::atomic<int> calls = 0;
  std::atomic<bool> all_ask = false;
  const auto plan = [&] {
    ++calls;
    while (!all_ask) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return kRoute;
  };
  std::vector<std::shared_ptr<const Route>> routes(4);
  {
    std::vector<std::jthread> threads;
    for (auto& route : routes)
      threads.emplace_back([&] { route = memo.route(kQuestion, square, plan); });
    all_ask = true;
  }
  EXPECT_EQ(calls, 1);
  for (const auto& route : routes) EXPECT_EQ(route, routes[0]);
  EXPECT_EQ(*routes[0], kRoute);
}

TEST(PlanMemo, WhatHasFailedIsPlannedByTheNext) {
  PlanMemo memo;
  const Polygons square = {{test::rectangle(0, 0, 1, 1), {}}};
  std::atomic<int> calls = 0;
  std::atomic<int> failed = 0;
  const auto ask = [&] {
    try {
      EXPECT_EQ(*memo.route(kQuestion, square,
                            [&] {
                              if (++calls < 3) throw std::runtime_error("not yet");
                              return kRoute;
                            }),
                kRoute);
    } catch (const std::runtime_error&) {
      ++failed;
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 5; ++i) threads.emplace_back(ask);
  }
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(failed, 2);
}

}  // namespace
}  // namespace routebench
