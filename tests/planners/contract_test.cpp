/// What every planner promises (planner.hpp), for every planner that is compiled in and every
/// plugin named in the environment variable ROUTEBENCH_PLUGINS (files, separated by ':').

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stop_token>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "nasty_layers.hpp"
#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/planning/plugin.hpp"

namespace routebench {
namespace {

// Offsets are cleaned to 5 um, an opening is two of them.
constexpr double kToleranceMm = 0.011;

/// Built-in planners and plugins, and what went wrong with the latter.
struct Planners {
  Registry registry;
  std::vector<PluginRecord> plugins;
};

const Planners& planners() {
  static const Planners all = [] {
    Planners found;
    register_builtin_planners(found.registry);
    const char* files = std::getenv("ROUTEBENCH_PLUGINS");
    std::istringstream list(files != nullptr ? files : "");
    for (std::string file; std::getline(list, file, ':');)
      if (!file.empty()) found.plugins.push_back(load_plugin(found.registry, file));
    return found;
  }();
  return all;
}

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const auto& [name, entry] : planners().registry.entries()) names.push_back(name);
  return names;
}

/// The corners of what a parameter allows.
std::vector<ParamValue> corners(const ParamSchema& param) {
  switch (param.type) {
    case ParamType::kBool:
      return {false, true};
    case ParamType::kInt:
      return {static_cast<std::int64_t>(std::ceil(*param.lowest)),
              static_cast<std::int64_t>(std::floor(*param.highest))};
    case ParamType::kReal:
      return {*param.lowest, *param.highest};
    case ParamType::kChoice:
      break;
  }
  return {param.choices.begin(), param.choices.end()};
}

/// The defaults, all parameters at their first corner, all at their last, and, unless `few`, every
/// parameter at each of its corners alone.
std::vector<ParamSet> parameter_corners(const std::vector<ParamSchema>& schema, bool few) {
  std::vector<ParamSet> sets{{}, {}, {}};
  for (const ParamSchema& param : schema) {
    sets[1][param.name] = corners(param).front();
    sets[2][param.name] = corners(param).back();
    if (few) continue;
    for (const ParamValue& value : corners(param)) sets.push_back({{param.name, value}});
  }
  return sets;
}

/// Parameters with which a planner does as its paper did and leaves the polygons: the judge calls
/// that off task, and a test of the planner's own shows it.
struct Faithful {
  std::string planner, param;
  ParamValue value;
};
const std::vector<Faithful>& faithful() {
  static const std::vector<Faithful> all{
      {"eulerian", "jump", std::string("extrude")},
      {"eulerian", "variant", std::string("published")},
      {"rectilinear", "published", std::string("simple_slicer")},
  };
  return all;
}

bool leaves_as_published(const std::string& planner, const ParamSet& params) {
  return std::any_of(faithful().begin(), faithful().end(), [&](const Faithful& f) {
    const auto given = params.find(f.param);
    return f.planner == planner && given != params.end() && given->second == f.value;
  });
}

std::string text(const ParamSet& params) {
  std::string all;
  for (const auto& [name, value] : params) all += name + "=" + to_string(value) + " ";
  return all.empty() ? "defaults" : all;
}

/// Tasks that a planner of either kind may get.
std::vector<PlanContext> contexts(PlannerRole role) {
  PlanContext context;
  context.spacing_mm = 0.40708;
  context.start = {3, -2};
  std::vector<PlanContext> all;
  const bool shell = role == PlannerRole::kShell;
  for (const int perimeters : shell ? std::vector<int>{1, 3} : std::vector<int>{2}) {
    for (const double density : shell ? std::vector<double>{1} : std::vector<double>{1, 0.25}) {
      context.perimeters = perimeters;
      context.density = density;
      all.push_back(context);
    }
  }
  return all;
}

Layer moved(Layer layer, Point2 by) {
  for (Polygon& polygon : layer.polygons) {
    for (Point2& p : polygon.outer) p = p + by;
    for (Ring& hole : polygon.holes)
      for (Point2& p : hole) p = p + by;
  }
  return layer;
}

Route moved(Route route, Point2 by) {
  for (Stroke& stroke : route.strokes)
    for (Point2& p : stroke.points) p = p + by;
  return route;
}

class Contract : public testing::TestWithParam<std::tuple<std::string, test::NastyLayer>> {
 protected:
  [[nodiscard]] const Registry::Entry& entry() const {
    return planners().registry.at(std::get<0>(GetParam()));
  }
  [[nodiscard]] const Layer& layer() const { return std::get<1>(GetParam()).layer; }

  /// Calls check(planner, context) for every corner.
  template <typename Check>
  void for_all(Check&& check) {
    const bool many_islands = layer().polygons.size() > 100;  // slow; and much alike
    for (const ParamSet& params : parameter_corners(entry().params, many_islands)) {
      SCOPED_TRACE(text(params));
      inside_ = !leaves_as_published(entry().info.name, params);
      const auto planner = entry().make(params);
      for (const PlanContext& context : contexts(entry().info.role)) check(*planner, context);
    }
  }

  bool inside_ = true;  ///< whether the parameters that are being checked promise to stay inside
};

TEST_P(Contract, StrokesAreSoundAndLieOnTheGridInsideThePolygons) {
  const EdgeGrid edges(layer().polygons);
  for_all([&](const Planner& planner, const PlanContext& context) {
    const Route route = planner.plan(layer(), context);
    ASSERT_TRUE(!layer().polygons.empty() || route.strokes.empty());
    for (const Stroke& stroke : route.strokes) {
      ASSERT_GE(stroke.points.size(), 2U);
      ASSERT_GT(stroke.width_mm, 0);
      ASSERT_TRUE(std::isfinite(stroke.width_mm));
      for (const Point2 p : stroke.points) ASSERT_EQ(p, snap(p));
      double outside_mm = 0;
      for (std::size_t i = 1; i < stroke.points.size(); ++i) {
        ASSERT_NE(stroke.points[i - 1], stroke.points[i]);
        outside_mm += edges.outside_length_mm(stroke.points[i - 1], stroke.points[i]);
      }
      if (inside_) {
        ASSERT_LE(outside_mm, kToleranceMm);
      }
    }
  });
}

TEST_P(Contract, BeadsStayInsideWithDefaultParameters) {
  const EdgeGrid edges(layer().polygons);
  const auto planner = entry().make({});
  for (const PlanContext& context : contexts(entry().info.role)) {
    for (const Stroke& stroke : planner->plan(layer(), context).strokes) {
      for (std::size_t i = 1; i < stroke.points.size(); ++i) {
        const Point2 a = stroke.points[i - 1], b = stroke.points[i];
        const int samples = static_cast<int>(distance(a, b) / 0.1) + 1;
        for (int k = 0; k <= samples; ++k) {
          const Point2 p = lerp(a, b, static_cast<double>(k) / samples);
          const double clear_mm = stroke.width_mm / 2 - kToleranceMm;
          ASSERT_FALSE(edges.distance_to_edge_mm(p, clear_mm))
              << "bead of " << stroke.width_mm << " mm at " << p.x << ", " << p.y;
        }
      }
    }
  }
}

TEST_P(Contract, EqualArgumentsGiveAnEqualRoute) {
  Layer other;
  other.polygons = {{test::rectangle(1, 1, 8, 5), {}}};
  for_all([&](const Planner& planner, const PlanContext& context) {
    const Route route = planner.plan(layer(), context);
    (void)planner.plan(other, context);
    ASSERT_EQ(planner.plan(layer(), context), route) << "another call in between";
    Route elsewhere;
    std::thread([&] { elsewhere = planner.plan(layer(), context); }).join();
    ASSERT_EQ(elsewhere, route) << "on another thread";
  });
}

TEST_P(Contract, TheRouteMovesWithTheLayer) {
  const Point2 by{snap(137.3), snap(-61.7)};
  for_all([&](const Planner& planner, PlanContext context) {
    const Route route = planner.plan(layer(), context);
    context.start = context.start + by;
    context.origin = context.origin + by;
    ASSERT_EQ(planner.plan(moved(layer(), by), context), moved(route, by));
  });
}

TEST_P(Contract, StopsWhenAsked) {
  for_all([&](const Planner& planner, PlanContext context) {
    if (planner.plan(layer(), context).strokes.empty()) return;
    std::stop_source source;
    source.request_stop();
    context.stop = source.get_token();
    try {
      (void)planner.plan(layer(), context);
      ADD_FAILURE() << "it went on";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kStopped);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(AllPlanners, Contract,
                         testing::Combine(testing::ValuesIn(planner_names()),
                                          testing::ValuesIn(test::nasty_layers())),
                         [](const auto& test) {
                           return std::get<0>(test.param) + "_" + std::get<1>(test.param).name;
                         });

TEST(ContractSetup, EveryNamedPluginIsThere) {
  for (const PluginRecord& plugin : planners().plugins)
    EXPECT_TRUE(plugin.loaded) << plugin.file << ": " << plugin.refused_because;
}

}  // namespace
}  // namespace routebench
