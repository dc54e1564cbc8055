#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <stop_token>
#include <thread>
#include <utility>

#include "routebench/geometry/edge_grid.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"
#include "routebench/harness/conformance.hpp"
#include "routebench/harness/contender.hpp"
#include "routebench/harness/judge.hpp"

namespace routebench {
namespace {

// Offsets are cleaned to 5 um, an opening is two of them.
constexpr double kToleranceMm = 0.011;
// Layers with more islands are slow, and much alike.
constexpr std::size_t kManyIslands = 100;

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
/// parameter at each of its corners alone. What may make a planner do as its paper did stays out of
/// the combinations: it may override the rest, and excuse it from staying inside.
std::vector<ParamSet> parameter_corners(const Registry::Entry& entry, bool few) {
  std::vector<ParamSet> sets{{}};
  if (entry.params.empty()) return sets;
  sets.resize(3);
  const std::vector<PlannerInfo::Setting>& faithful = entry.info.may_leave;
  for (const ParamSchema& param : entry.params) {
    if (std::none_of(faithful.begin(), faithful.end(),
                     [&](const auto& setting) { return setting.param == param.name; })) {
      sets[1][param.name] = corners(param).front();
      sets[2][param.name] = corners(param).back();
    }
    if (few) continue;
    for (const ParamValue& value : corners(param)) sets.push_back({{param.name, value}});
  }
  return sets;
}

std::string text_of(const ParamSet& params) {
  std::string all;
  for (const auto& [name, value] : params)
    all += (all.empty() ? "" : " ") + name + "=" + to_string(value);
  return all.empty() ? "defaults" : all;
}

std::string text_of(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::string text_of(Point2 p) { return "(" + text_of(p.x) + ", " + text_of(p.y) + ")"; }

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

bool leaves_as_published(const PlannerInfo& info, const ParamSet& params) {
  return std::any_of(info.may_leave.begin(), info.may_leave.end(),
                     [&](const PlannerInfo::Setting& setting) {
                       const auto given = params.find(setting.param);
                       return given != params.end() && to_string(given->second) == setting.value;
                     });
}

/// One way of planning a trial layer.
struct Trial {
  const PlannerInfo& info;
  const Planner& planner;
  const Layer& layer;
  const PlanContext& context;
};

/// A complaint and the route that shows it.
struct Seen {
  std::string complaint;
  Route route;
};

/// Looks at every corner of the parameters and every kind of task.
template <typename Look>
std::optional<Breach> at_all_corners(const Registry& registry, const std::string& name,
                                     const TrialLayer& trial, bool only_inside, Look&& look) {
  const Registry::Entry& entry = registry.at(name);
  const bool few = trial.layer.polygons.size() > kManyIslands;
  for (const ParamSet& params : parameter_corners(entry, few)) {
    if (only_inside && leaves_as_published(entry.info, params)) continue;
    const auto planner = entry.make(params);
    for (const PlanContext& context : contexts(entry.info.role))
      if (std::optional<Seen> seen = look(Trial{entry.info, *planner, trial.layer, context}))
        return Breach{text_of(params), std::move(seen->complaint), std::move(seen->route)};
  }
  return std::nullopt;
}

/// What is wrong with a stroke in itself; empty if nothing.
std::string fault_of(const Stroke& stroke) {
  if (stroke.points.size() < 2) return "has fewer than two points";
  if (!(stroke.width_mm > 0 && std::isfinite(stroke.width_mm))) return "has no width";
  for (std::size_t i = 0; i < stroke.points.size(); ++i) {
    if (stroke.points[i] != snap(stroke.points[i]))
      return "has a point off the grid at " + text_of(stroke.points[i]);
    if (i > 0 && stroke.points[i] == stroke.points[i - 1])
      return "has the same point twice in a row at " + text_of(stroke.points[i]);
  }
  return {};
}

std::optional<Seen> unsound_stroke(const Trial& trial) {
  Route route = trial.planner.plan(trial.layer, trial.context);
  if (trial.layer.polygons.empty() && !route.strokes.empty())
    return Seen{"an empty layer got strokes", std::move(route)};
  for (std::size_t i = 0; i < route.strokes.size(); ++i)
    if (const std::string fault = fault_of(route.strokes[i]); !fault.empty())
      return Seen{"stroke " + std::to_string(i) + " " + fault, std::move(route)};
  return std::nullopt;
}

std::optional<Seen> stroke_outside(const Trial& trial) {
  const EdgeGrid edges(trial.layer.polygons);
  Route route = trial.planner.plan(trial.layer, trial.context);
  for (std::size_t s = 0; s < route.strokes.size(); ++s) {
    const std::vector<Point2>& points = route.strokes[s].points;
    double outside_mm = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      outside_mm += edges.outside_length_mm(points[i - 1], points[i]);
    if (outside_mm > kToleranceMm)
      return Seen{"stroke " + std::to_string(s) + " runs " + text_of(outside_mm) +
                      " mm outside the polygons",
                  std::move(route)};
  }
  return std::nullopt;
}

std::optional<Seen> bead_outside(const Trial& trial) {
  const EdgeGrid edges(trial.layer.polygons);
  Route route = trial.planner.plan(trial.layer, trial.context);
  for (std::size_t s = 0; s < route.strokes.size(); ++s) {
    const Stroke& stroke = route.strokes[s];
    for (std::size_t i = 1; i < stroke.points.size(); ++i) {
      const Point2 a = stroke.points[i - 1], b = stroke.points[i];
      const int samples = static_cast<int>(distance(a, b) / 0.1) + 1;
      for (int k = 0; k <= samples; ++k) {
        const Point2 p = lerp(a, b, static_cast<double>(k) / samples);
        if (edges.distance_to_edge_mm(p, stroke.width_mm / 2 - kToleranceMm))
          return Seen{"the bead of stroke " + std::to_string(s) + ", " + text_of(stroke.width_mm) +
                          " mm wide, leaves the polygons at " + text_of(p),
                      std::move(route)};
      }
    }
  }
  return std::nullopt;
}

std::optional<Seen> impurity(const Trial& trial) {
  Layer other;
  other.polygons = {{{{1, 1}, {8, 1}, {8, 5}, {1, 5}}, {}}};
  Route route = trial.planner.plan(trial.layer, trial.context);
  static_cast<void>(trial.planner.plan(other, trial.context));
  if (trial.planner.plan(trial.layer, trial.context) != route)
    return Seen{"a second call gave another route, after one for another layer", std::move(route)};
  Route elsewhere;
  std::exception_ptr thrown;
  std::thread([&] {
    try {
      elsewhere = trial.planner.plan(trial.layer, trial.context);
    } catch (...) {
      thrown = std::current_exception();
    }
  }).join();
  if (thrown) std::rethrow_exception(thrown);
  if (elsewhere != route) return Seen{"another thread got another route", std::move(route)};
  return std::nullopt;
}

std::optional<Seen> unrepeated(const Trial& trial) {
  if (trial.info.repeats_every == 0) return std::nullopt;
  Layer above = trial.layer;
  above.index += trial.info.repeats_every;
  above.z_mm += trial.info.repeats_every * above.height_mm;
  PlanContext context = trial.context;
  context.seed += 1;
  Route route = trial.planner.plan(above, context);
  if (route == trial.planner.plan(trial.layer, trial.context)) return std::nullopt;
  return Seen{
      "an equal layer, as many above as it is said to repeat itself after, got another "
      "route",
      std::move(route)};
}

std::optional<Seen> unmoved(const Trial& trial) {
  const Point2 by{snap(137.3), snap(-61.7)};
  PlanContext context = trial.context;
  context.start = context.start + by;
  context.origin = context.origin + by;
  Route there = trial.planner.plan(moved(trial.layer, by), context);
  if (there == moved(trial.planner.plan(trial.layer, trial.context), by)) return std::nullopt;
  return Seen{"layer, start and origin were moved, and the route did not just move with them",
              moved(std::move(there), Point2{-by.x, -by.y})};
}

std::optional<Seen> going_on(const Trial& trial) {
  Route route = trial.planner.plan(trial.layer, trial.context);
  if (route.strokes.empty()) return std::nullopt;
  std::stop_source source;
  source.request_stop();
  PlanContext context = trial.context;
  context.stop = source.get_token();
  try {
    static_cast<void>(trial.planner.plan(trial.layer, context));
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kStopped) return std::nullopt;
    throw;
  }
  return Seen{"it was asked to stop and planned to the end", std::move(route)};
}

/// Tasks that need no second planner.
std::vector<Task> tasks_alone(PlannerRole role) {
  Task task;
  task.skin_layers = 0;
  if (role == PlannerRole::kShell) {
    task.density = 0;
    return {task};
  }
  task.perimeters = 0;
  // Whole lines in a small layer are a good deal more or less than a density demands.
  task.gate.deposit_min = 0.5;
  task.gate.deposit_max = 2;
  Task dense = task;
  dense.density = 1;
  dense.gate = GateLimits{};
  return {dense, task};
}

std::optional<Breach> task_not_done(const Registry& registry, const std::string& name,
                                    const TrialLayer& trial) {
  if (!trial.roomy) return std::nullopt;
  const PlannerRole role = registry.at(name).info.role;
  const bool shell = role == PlannerRole::kShell;
  const SlotSpec slot{name, {}};
  ContenderSpec spec{.name = name,
                     .shell = shell ? std::optional(slot) : std::nullopt,
                     .fill = shell ? std::nullopt : std::optional(slot)};
  const Contender contender(std::move(spec), registry);
  for (const Task& task : tasks_alone(role)) {
    const Judge judge(task, {});
    const Demand demand = demand_of(trial.layer, task);
    const PlannedLayer planned = contender.plan(trial.layer, demand, task, {}, 1, {});
    const LayerScore score = judge.score(trial.layer, demand, planned.route, std::nullopt);
    const Verdict verdict = judge.verdict(judge.total(std::span(&score, 1)));
    if (verdict.outcome != Outcome::kValid)
      return Breach{"defaults", "at density " + text_of(task.density) + ": " + verdict.reason,
                    planned.route};
  }
  return std::nullopt;
}

/// A check of every parameter corner.
ConformanceCheck everywhere(std::string name, std::string promise,
                            std::optional<Seen> (*look)(const Trial&), bool only_inside = false) {
  return {std::move(name), std::move(promise),
          [look, only_inside](const Registry& registry, const std::string& planner,
                              const TrialLayer& layer) {
            return at_all_corners(registry, planner, layer, only_inside, look);
          }};
}

/// A check of the default parameters.
ConformanceCheck of_defaults(std::string name, std::string promise,
                             std::optional<Seen> (*look)(const Trial&)) {
  return {std::move(name), std::move(promise),
          [look](const Registry& registry, const std::string& planner,
                 const TrialLayer& layer) -> std::optional<Breach> {
            const Registry::Entry& entry = registry.at(planner);
            const auto made = entry.make({});
            for (const PlanContext& context : contexts(entry.info.role))
              if (std::optional<Seen> seen = look(Trial{entry.info, *made, layer.layer, context}))
                return Breach{"defaults", std::move(seen->complaint), std::move(seen->route)};
            return std::nullopt;
          }};
}

}  // namespace

const std::vector<ConformanceCheck>& conformance_checks() {
  static const std::vector<ConformanceCheck> all{
      everywhere("strokes", "strokes are sound and their points lie on the grid", unsound_stroke),
      everywhere("inside", "centre lines stay inside the polygons", stroke_outside, true),
      of_defaults("beads", "with default parameters beads stay inside the polygons", bead_outside),
      everywhere("pure", "equal arguments give an equal route, after other calls and on any thread",
                 impurity),
      everywhere("repeats", "equal layers have equal routes as often as it is said", unrepeated),
      everywhere("moves", "the route moves with layer, start and origin", unmoved),
      everywhere("stops", "planning ends soon when it is asked to", going_on),
      {"task", "with default parameters the gate passes layers that have room", task_not_done}};
  return all;
}

}  // namespace routebench
