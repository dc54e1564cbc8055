/// A planner that breaks one promise at a time is caught by that promise's check, and an honest one
/// by none.

#include "routebench/harness/conformance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <set>

#include "routebench/geometry/error.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/frame.hpp"
#include "routebench/planning/plugin.hpp"
#include "routebench/planning/walls.hpp"

namespace routebench {
namespace {

enum class Fault {
  kNone,
  kOnePoint,
  kNoWidth,
  kOffGrid,
  kTwice,
  kFillsNothingness,
  kOutside,
  kOutsideAsPublished,
  kBeadOutside,
  kRemembers,
  kDependsOnThread,
  kDrawsLots,
  kCountsLayers,
  kStays,
  kDeaf,
  kLeavesOut
};

/// Rings inside one another, and a fault where its parameter asks for it.
template <Fault fault>
class Rings final : public Planner {
 public:
  struct Params {
    bool faulty = fault != Fault::kOutsideAsPublished;
    void bind(ParamBinder& bind) { bind("faulty", faulty, "break a promise"); }
  };
  static PlannerInfo info() {
    PlannerInfo info{"rings", PlannerRole::kFill, "rings inside one another", ""};
    info.repeats_every = 1;
    if (fault == Fault::kOutsideAsPublished) info.may_leave = {{"faulty", "true"}};
    return info;
  }
  explicit Rings(const Params& params) : params_(params) {}

  [[nodiscard]] Route plan(const Layer& layer, const PlanContext& context) const override {
    const Frame frame(layer, context);
    Route route;
    const bool close = params_.faulty && fault == Fault::kBeadOutside;
    Polygons region = offset(frame.polygons(), -context.line_width_mm / (close ? 3 : 2));
    while (!region.empty()) {
      if (!params_.faulty || fault != Fault::kDeaf) stop_if_asked(context);
      for (Ring& ring : rings_of(region)) {
        ring.push_back(ring.front());
        route.strokes.push_back({std::move(ring), context.line_width_mm});
      }
      region = offset(region, -context.line_distance_mm());
    }
    route = frame.from_frame(std::move(route));
    if (params_.faulty) spoil(route, layer, context);
    return route;
  }

 private:
  static void spoil(Route& route, const Layer& layer, const PlanContext& context) {
    static std::atomic<int> calls{0};
    const double width = context.line_width_mm;
    if (fault == Fault::kFillsNothingness && layer.polygons.empty())
      route.strokes.push_back({{{0, 0}, {1, 0}}, width});
    if (route.strokes.empty()) return;
    Stroke& first = route.strokes.front();
    switch (fault) {
      case Fault::kOnePoint:
        first.points.resize(1);
        break;
      case Fault::kNoWidth:
        first.width_mm = 0;
        break;
      case Fault::kOffGrid:
        first.points.front().x += 1e-9;
        break;
      case Fault::kTwice:
        first.points.push_back(first.points.back());
        break;
      case Fault::kOutside:
      case Fault::kOutsideAsPublished:
        first.points.front() = first.points.front() + Point2{1, 1};
        break;
      case Fault::kRemembers:
        if (++calls % 2 == 0) std::reverse(route.strokes.begin(), route.strokes.end());
        break;
      case Fault::kDependsOnThread: {
        static thread_local int here = ++calls;
        if (here % 2 == 0) first.width_mm = width / 2;
        break;
      }
      case Fault::kDrawsLots:
        if (context.seed % 2 == 0) std::reverse(route.strokes.begin(), route.strokes.end());
        break;
      case Fault::kCountsLayers:
        if (layer.index % 2 != 0) std::reverse(route.strokes.begin(), route.strokes.end());
        break;
      case Fault::kStays:
        if (layer.polygons.front().outer.front().x > 100) route.strokes.pop_back();
        break;
      case Fault::kLeavesOut:
        route.strokes.pop_back();
        route.strokes.resize(route.strokes.size() / 2);
        break;
      default:
        break;
    }
  }

  Params params_;
};

/// A planner that a contender refuses to go on with has broken a promise, too.
bool is_broken(const ConformanceCheck& check, const Registry& registry, const TrialLayer& layer) {
  try {
    return check.breach(registry, "rings", layer).has_value();
  } catch (const Error&) {
    return true;
  }
}

/// Names of the checks that find a breach on some layer.
template <Fault fault>
std::set<std::string> checks_that_fail() {
  Registry registry;
  registry.add<Rings<fault>>();
  std::set<std::string> failed;
  for (const ConformanceCheck& check : conformance_checks())
    for (const TrialLayer& layer : trial_layers())
      if (!failed.contains(check.name) && is_broken(check, registry, layer))
        failed.insert(check.name);
  return failed;
}

using Names = std::set<std::string>;

TEST(Conformance, AnHonestPlannerPasses) { EXPECT_EQ(checks_that_fail<Fault::kNone>(), Names{}); }

TEST(Conformance, EveryFaultIsCaughtByItsCheck) {
  EXPECT_TRUE(checks_that_fail<Fault::kOnePoint>().contains("strokes"));
  EXPECT_TRUE(checks_that_fail<Fault::kNoWidth>().contains("strokes"));
  EXPECT_EQ(checks_that_fail<Fault::kOffGrid>(), Names{"strokes"});
  EXPECT_EQ(checks_that_fail<Fault::kTwice>(), Names{"strokes"});
  EXPECT_TRUE(checks_that_fail<Fault::kFillsNothingness>().contains("strokes"));
  EXPECT_TRUE(checks_that_fail<Fault::kOutside>().contains("inside"));
  EXPECT_EQ(checks_that_fail<Fault::kBeadOutside>(), Names{"beads"});
  EXPECT_TRUE(checks_that_fail<Fault::kRemembers>().contains("pure"));
  EXPECT_TRUE(checks_that_fail<Fault::kDependsOnThread>().contains("pure"));
  EXPECT_EQ(checks_that_fail<Fault::kDrawsLots>(), Names{"repeats"});
  EXPECT_EQ(checks_that_fail<Fault::kCountsLayers>(), Names{"repeats"});
  EXPECT_EQ(checks_that_fail<Fault::kStays>(), Names{"moves"});
  EXPECT_EQ(checks_that_fail<Fault::kDeaf>(), Names{"stops"});
  EXPECT_EQ(checks_that_fail<Fault::kLeavesOut>(), Names{"task"});
}

TEST(Conformance, APaperMayLeaveThePolygonsIfItsPlannerSaysSo) {
  EXPECT_EQ(checks_that_fail<Fault::kOutsideAsPublished>(), Names{});
}

TEST(Conformance, ABreachTellsParametersComplaintAndRoute) {
  Registry registry;
  registry.add<Rings<Fault::kOffGrid>>();
  for (const TrialLayer& layer : trial_layers()) {
    if (layer.name != "square") continue;
    const auto breach = conformance_checks().front().breach(registry, "rings", layer);
    ASSERT_TRUE(breach);
    EXPECT_EQ(breach->params, "defaults");
    EXPECT_EQ(breach->complaint.find("stroke 0 has a point off the grid at ("), 0U);
    EXPECT_FALSE(breach->route.strokes.empty());
  }
}

TEST(Conformance, TrialLayersHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const TrialLayer& layer : trial_layers()) EXPECT_TRUE(names.insert(layer.name).second);
  EXPECT_GT(names.size(), 10U);
}

}  // namespace
}  // namespace routebench
