#pragma once
/// An honest planner and one that does what no planner should, for tests of what keeps them apart.

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cfenv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/planning/plugin.hpp"

namespace routebench::test {

/// Lines along x over the bounding box of what it is given: right for rectangles.
inline Route hatch(const Layer& layer, const PlanContext& context, int every, bool zigzag) {
  Route route;
  if (layer.polygons.empty()) return route;
  const Box2 box = bounding_box(layer.polygons);
  const double half_mm = context.line_width_mm / 2;
  const double distance_mm = context.line_distance_mm();
  int line = 0;
  for (double y = box.lower.y + half_mm; y <= box.upper.y - half_mm; y += distance_mm, ++line) {
    if (every > 1 && line % every == 0) continue;
    Point2 a = snap(Point2{box.lower.x + half_mm, y});
    Point2 b = snap(Point2{box.upper.x - half_mm, y});
    if (zigzag && line % 2 == 1) std::swap(a, b);
    route.strokes.push_back({{a, b}, context.line_width_mm});
  }
  return route;
}

/// Fill: does the task, with lines to and fro or all the same way.
class Hatch final : public Planner {
 public:
  struct Params {
    bool zigzag = true;
    int version = 1;
    void bind(ParamBinder& bind) {
      bind("zigzag", zigzag, "every other line the other way");
      bind("version", version, {1, 100}, "", "changes nothing");
    }
  };
  static PlannerInfo info() { return {"hatch", PlannerRole::kFill, "fills rectangles", ""}; }
  explicit Hatch(const Params& params) : params_(params) {}
  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    return hatch(layer, context, 1, params_.zigzag);
  }

 private:
  Params params_;
};

/// Fill: does one thing that it should not do, on the second layer; the others it fills as it
/// should.
class Culprit final : public Planner {
 public:
  enum class Crime {
    kSegfault,
    kAbort,
    kThrow,
    kLoop,
    kHoard,
    kNan,
    kInfinite,
    kRecurse,
    kLeak,
    kExit,
    kChatter,
    kCloseFiles,
    kSkip,
    kOutside,
    kMoody,
    kThread,
    kNap,
    kKillSelf,
    kDiscard,
    kStillborn,
    kUnborn,
    kRound,
    kCurse
  };
  struct Params {
    Crime crime = Crime::kSegfault;
    void bind(ParamBinder& bind) {
      bind("crime", crime, {{"segfault", Crime::kSegfault}, {"abort", Crime::kAbort},
                            {"throw", Crime::kThrow},       {"loop", Crime::kLoop},
                            {"hoard", Crime::kHoard},       {"nan", Crime::kNan},
                            {"infinite", Crime::kInfinite}, {"recurse", Crime::kRecurse},
                            {"leak", Crime::kLeak},         {"exit", Crime::kExit},
                            {"chatter", Crime::kChatter},   {"close_files", Crime::kCloseFiles},
                            {"skip", Crime::kSkip},         {"outside", Crime::kOutside},
                            {"moody", Crime::kMoody},       {"thread", Crime::kThread},
                            {"nap", Crime::kNap},           {"kill_self", Crime::kKillSelf},
                            {"discard", Crime::kDiscard},   {"stillborn", Crime::kStillborn},
                            {"unborn", Crime::kUnborn},     {"round", Crime::kRound},
                            {"curse", Crime::kCurse}},
           "what to do");
    }
  };
  static PlannerInfo info() { return {"culprit", PlannerRole::kFill, "misbehaves", ""}; }
  explicit Culprit(const Params& params) : params_(params) {
    if (params_.crime == Crime::kStillborn) std::abort();
    if (params_.crime == Crime::kUnborn) throw 5;
  }

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    Route route = hatch(layer, context, 1, true);
    if (layer.index != 1 || route.strokes.empty()) return route;
    Point2& first = route.strokes.front().points.front();
    switch (params_.crime) {
      case Crime::kSegfault:
        raise(SIGSEGV);
        break;
      case Crime::kAbort:
        std::fprintf(stderr, "a bad\nday\n");
        std::abort();
      case Crime::kThrow:
        throw std::runtime_error("no\nmood");
      case Crime::kLoop:
        for (;;) std::this_thread::yield();
      case Crime::kHoard:
        hoard();
        break;
      case Crime::kNan:
        first.x = std::numeric_limits<double>::quiet_NaN();
        break;
      case Crime::kInfinite:
        first.y = std::numeric_limits<double>::infinity();
        break;
      case Crime::kRecurse:
        first.x += recurse(1);
        break;
      case Crime::kLeak:
        // All that is asked for, and a scribble beside the part.
        for (int i = 0; i < 20; ++i)
          route.strokes.push_back(
              {{{-9, -9.0 + i / 2.0}, {-3, -9.0 + i / 2.0}}, context.line_width_mm});
        break;
      case Crime::kExit:
        std::exit(0);
      case Crime::kChatter:
        for (int i = 0; i < 20'000; ++i) std::printf("la la la %d\n", i);
        std::fflush(stdout);
        break;
      case Crime::kCloseFiles:
        for (int i = 0; i < 64; ++i) close(i);
        break;
      case Crime::kSkip:
        return hatch(layer, context, 2, true);
      case Crime::kOutside:
        for (Stroke& stroke : route.strokes)
          for (Point2& p : stroke.points) p.x += 100;
        break;
      case Crime::kMoody:
        std::rotate(route.strokes.begin(),
                    route.strokes.begin() + getpid() % static_cast<int>(route.strokes.size()),
                    route.strokes.end());
        break;
      case Crime::kThread:
        std::thread([] {
          for (;;) pause();
        }).detach();
        break;
      case Crime::kNap:
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        break;
      case Crime::kKillSelf:
        raise(SIGKILL);
        break;
      case Crime::kDiscard:
        return {};
      case Crime::kRound:
        std::fesetround(FE_UPWARD);
        break;
      case Crime::kCurse:
        throw std::runtime_error("\x1b[2J\xff" + std::string(1'000'000, 'x'));
      case Crime::kStillborn:
      case Crime::kUnborn:
        break;  // never came to plan
    }
    return route;
  }

 private:
  /// Until the stack is used up.
  static double recurse(double depth) {
    volatile double here[512] = {depth};
    if (depth < 0) return 0;  // never, but a compiler must not know
    return recurse(depth + 1) + here[0];
  }

  static void hoard() {
    std::vector<std::string> all;
    for (;;) all.emplace_back(std::size_t{1} << 20, 'x');
  }

  Params params_;
};

}  // namespace routebench::test
