#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "arguments.hpp"
#include "json_parts.hpp"
#include "plan_timing.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/harness/commands.hpp"
#include "routebench/harness/conformance.hpp"
#include "routebench/harness/output.hpp"
#include "routebench/harness/pipeline.hpp"
#include "routebench/harness/route_svg.hpp"
#include "run_cell.hpp"
#include "run_child.hpp"

namespace routebench {
namespace {

constexpr std::size_t kShownFailures = 4;  // of a check; JSON and pictures have all
constexpr ChildLimits kLimits{.timeout_s = 60, .memory_mb = 2048};
constexpr double kBytesPerMib = 1 << 20;
constexpr std::array<int, 4> kLadder{250, 1000, 4000, 16000};  // vertices

struct CheckArguments {
  std::string name;
  std::vector<std::string> plugins;
  std::string svg;
  std::string json;
};

/// What one check saw on one layer.
struct Failure {
  std::string layer;
  std::string params;  ///< empty if it did not come so far as to tell
  std::string complaint;
  std::string picture;  ///< an SVG document, if there is something to see
};

struct CheckResult {
  std::string name;
  std::string promise;
  std::vector<Failure> failures;
};

/// Time and memory on one step of the ladder.
struct Step {
  int vertices = 0;
  std::string problem;  ///< why there are no figures
  double cpu_ms = 0;
  double grown_mib = 0;
};

/// After so many that gave no result in time no other piece of work is begun: a planner that never
/// ends would keep us for hours.
constexpr int kMostTimedOut = 2;
constexpr const char* kNotTried = "not tried: others before gave no result in time";

/// Begins every piece of work in a child of its own and collects what they tell.
std::map<std::size_t, ChildEnd> run_in_children(const std::vector<ChildPool::Work>& works) {
  ChildPool pool(kLimits);
  std::map<std::size_t, ChildEnd> ends;
  int timed_out = 0;
  for (std::size_t id = 0; id < works.size() && timed_out < kMostTimedOut; ++id) {
    pool.start(id, works[id]);
    // One at a time: a check's figures are not to depend on its neighbours.
    while (pool.running() > 0)
      for (ChildPool::Finished& finished : pool.wait()) ends[finished.id] = std::move(finished.end);
    if (ends.at(id).how == ChildEnd::How::kTimedOut) ++timed_out;
  }
  return ends;
}

std::string picture_of(const Layer& layer, Route route) {
  PlannedLayer planned;
  planned.kinds.assign(route.strokes.size(), StrokeKind::kWall);
  planned.route = std::move(route);
  std::ostringstream svg;
  write_route_svg(svg, layer, planned);
  return svg.str();
}

ChildPool::Work check_work(const ConformanceCheck& check, const Registry& registry,
                           const std::string& planner, const TrialLayer& layer) {
  return [&](ChildProgress& progress) -> std::string {
    progress.layer = layer.layer.index;
    std::optional<Breach> breach = check.breach(registry, planner, layer);
    if (!breach) return {};
    return text_of({{"params", breach->params},
                    {"complaint", breach->complaint},
                    {"picture", picture_of(layer.layer, std::move(breach->route))}},
                   true);
  };
}

Failure failure_of(const std::string& layer, const ChildEnd& end) {
  if (end.how != ChildEnd::How::kResult)
    return {layer, {}, cell_result_of(end, kLimits).reason, {}};
  const Json told = Json::parse(end.text);
  return {layer, told["params"], told["complaint"], told["picture"]};
}

std::vector<CheckResult> run_checks(const Registry& registry, const std::string& planner) {
  const std::vector<TrialLayer> layers = trial_layers();
  std::vector<ChildPool::Work> works;
  for (const ConformanceCheck& check : conformance_checks())
    for (const TrialLayer& layer : layers)
      works.push_back(check_work(check, registry, planner, layer));
  const std::map<std::size_t, ChildEnd> ends = run_in_children(works);

  std::vector<CheckResult> results;
  for (const ConformanceCheck& check : conformance_checks()) {
    CheckResult result{check.name, check.promise, {}};
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const auto found = ends.find(results.size() * layers.size() + i);
      if (found == ends.end()) {
        result.failures.push_back({layers[i].name, {}, kNotTried, {}});
        continue;
      }
      const ChildEnd& end = found->second;
      if (end.how != ChildEnd::How::kResult || !end.text.empty())
        result.failures.push_back(failure_of(layers[i].name, end));
    }
    results.push_back(std::move(result));
  }
  return results;
}

/// A wavy disc of that many vertices, 0.2 mm apart.
Layer disc(int vertices) {
  const double radius_mm = 0.2 * vertices / (2 * std::numbers::pi);
  Layer layer;
  layer.height_mm = 0.2;
  layer.polygons.emplace_back();
  for (int i = 0; i < vertices; ++i) {
    const double t = 2 * std::numbers::pi * i / vertices;
    const double r = radius_mm * (1 + 0.1 * std::sin(5 * t));
    layer.polygons[0].outer.push_back(snap(Point2{r * std::cos(t), r * std::sin(t)}));
  }
  return layer;
}

/// Plans ever larger discs at the density of a usual part.
std::vector<Step> climb(const Registry& registry, const std::string& planner) {
  std::vector<ChildPool::Work> works;
  for (const int vertices : kLadder)
    works.emplace_back([&registry, &planner, vertices](ChildProgress&) -> std::string {
      const Layer layer = disc(vertices);
      PlanContext context;
      context.density = registry.at(planner).info.role == PlannerRole::kShell ? 1 : 0.2;
      const auto made = registry.at(planner).make({});
      // What a planner takes to begin with, a process of its own perhaps, is no growth.
      static_cast<void>(made->plan(Layer{}, context));
      const double before_bytes = peak_rss_bytes(made.get());
      PlanTime time;
      static_cast<void>(timed_plan(*made, layer, context, time));
      const double grown_mib = (peak_rss_bytes(made.get()) - before_bytes) / kBytesPerMib;
      return text_of(
          {{"cpu_ms", 1e-6 * static_cast<double>(time.cpu_ns)}, {"grown_mib", grown_mib}}, true);
    });
  const std::map<std::size_t, ChildEnd> ends = run_in_children(works);
  std::vector<Step> steps;
  for (std::size_t i = 0; i < kLadder.size(); ++i) {
    const auto found = ends.find(i);
    if (found == ends.end()) {
      steps.push_back({kLadder[i], kNotTried, 0, 0});
      continue;
    }
    const ChildEnd& end = found->second;
    if (end.how != ChildEnd::How::kResult) {
      steps.push_back({kLadder[i], cell_result_of(end, kLimits).reason, 0, 0});
      continue;
    }
    const Json told = Json::parse(end.text);
    steps.push_back({kLadder[i], {}, told["cpu_ms"], told["grown_mib"]});
  }
  return steps;
}

void print(std::ostream& out, const Registry::Entry& entry, const std::vector<CheckResult>& results,
           const std::vector<Step>& ladder, std::size_t layers) {
  out << entry.info.name << " (" << to_string(entry.info.role) << ", " << entry.origin << ") on "
      << layers << " layers\n\n";
  std::size_t widest = 0;
  for (const CheckResult& result : results) widest = std::max(widest, result.name.size());
  for (const CheckResult& result : results) {
    out << (result.failures.empty() ? "pass  " : "FAIL  ") << result.name
        << std::string(widest - result.name.size() + 2, ' ') << result.promise << '\n';
    for (std::size_t i = 0; i < std::min(kShownFailures, result.failures.size()); ++i) {
      const Failure& failure = result.failures[i];
      out << "      on " << failure.layer
          << (failure.params.empty() ? "" : " with " + failure.params) << ": " << failure.complaint
          << '\n';
    }
    if (result.failures.size() > kShownFailures)
      out << "      and on " << result.failures.size() - kShownFailures << " layers more\n";
  }
  out << "\nvertices    CPU ms  memory MiB\n";
  for (const Step& step : ladder) {
    std::string vertices = std::to_string(step.vertices);
    vertices.insert(0, 8 - vertices.size(), ' ');
    const auto column = [](double value) {
      const std::string text = readable(value);
      return std::string(text.size() < 10 ? 10 - text.size() : 0, ' ') + text;
    };
    out << vertices;
    if (step.problem.empty())
      out << column(step.cpu_ms) << "  " << column(step.grown_mib) << '\n';
    else
      out << "  " << step.problem << '\n';
  }
}

Json document_of(const Registry::Entry& entry, const std::vector<CheckResult>& results,
                 const std::vector<Step>& ladder) {
  Json checks = Json::array();
  for (const CheckResult& result : results) {
    Json failures = Json::array();
    for (const Failure& failure : result.failures)
      failures.push_back(
          {{"layer", failure.layer}, {"params", failure.params}, {"complaint", failure.complaint}});
    checks.push_back({{"name", result.name},
                      {"promise", result.promise},
                      {"passed", result.failures.empty()},
                      {"failures", std::move(failures)}});
  }
  Json steps = Json::array();
  for (const Step& step : ladder)
    steps.push_back({{"vertices", step.vertices},
                     {"problem", step.problem},
                     {"cpu_ms", step.cpu_ms},
                     {"grown_mib", step.grown_mib}});
  return {{"planner", entry.info.name},
          {"role", to_string(entry.info.role)},
          {"origin", entry.origin},
          {"checks", std::move(checks)},
          {"ladder", std::move(steps)}};
}

int check(const CheckArguments& arguments) {
  PlannerSet planners = load_planners(arguments.plugins);
  require_all_loaded(planners);
  print_refused(planners);
  add_commands(planners, std::span(&arguments.name, 1));
  const Registry::Entry& entry = planners.registry.at(arguments.name);
  const std::vector<CheckResult> results = run_checks(planners.registry, arguments.name);
  const std::vector<Step> ladder = climb(planners.registry, arguments.name);

  OutputSet outputs;
  if (!arguments.svg.empty()) {
    outputs.add_folder(arguments.svg);
    for (const CheckResult& result : results)
      for (const Failure& failure : result.failures)
        if (!failure.picture.empty())
          outputs.add(
              std::filesystem::path(arguments.svg) / (result.name + "-" + failure.layer + ".svg"),
              [&](std::ostream& out) { out << failure.picture; });
  }
  if (!arguments.json.empty())
    write_json(outputs, arguments.json, document_of(entry, results, ladder));
  outputs.commit();
  if (arguments.json != "-") print(std::cout, entry, results, ladder, trial_layers().size());
  const bool passed =
      std::all_of(results.begin(), results.end(),
                  [](const CheckResult& result) { return result.failures.empty(); }) &&
      std::all_of(ladder.begin(), ladder.end(),
                  [](const Step& step) { return step.problem.empty(); });
  return passed ? 0 : kExitNotValid;
}

}  // namespace

void add_check_planner_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App& command =
      *app.add_subcommand("check-planner", "Show whether a planner keeps what planners promise");
  command.add_option("NAME", arguments->name, "The planner")->type_name("")->required();
  add_plugin_option(command, arguments->plugins);
  command.add_option("--svg", arguments->svg, "Draw the layers on which it fails into a folder")
      ->type_name("DIR");
  command.add_option("--json", arguments->json, "Write what was found; - is the standard output")
      ->type_name("FILE|-");
  command.callback([arguments, &exit_code] { exit_code = check(*arguments); });
}

}  // namespace routebench
