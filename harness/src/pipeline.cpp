#include "routebench/harness/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <utility>

#include "judge/alike.hpp"
#include "plan_memo.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/layer_io.hpp"
#include "routebench/geometry/region.hpp"
#include "routebench/geometry/solid.hpp"
#include "routebench/planning/sha256.hpp"

namespace routebench {
namespace {

/// Heights that were written as text and read back may differ by this much.
constexpr double kHeightToleranceMm = 1e-6;

bool is_layer_file(const std::string& spec) {
  std::string extension = std::filesystem::path(spec).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension == ".wkt";
}

/// A bead of another height than its layer's would make every volume wrong.
void require_task_height(const std::string& file, const std::vector<Layer>& layers,
                         const Task& task) {
  for (const Layer& layer : layers) {
    if (std::abs(layer.height_mm - task.layer_height_mm) <= kHeightToleranceMm) continue;
    throw Error(ErrorKind::kBadInput, file + ": layer " + std::to_string(layer.index) + " is " +
                                          to_string(ParamValue(layer.height_mm)) +
                                          " mm high but the task's " + "layer_height_mm is " +
                                          to_string(ParamValue(task.layer_height_mm)) +
                                          "; set it to the file's");
  }
}

void require_no_facets_wanted(const std::string& layer_file, const Task& task) {
  if (task.skin_rule != SkinRule::kDifference)
    throw Error(ErrorKind::kBadInput,
                layer_file + ": a file of layers has no facets; skin_rule must be difference");
}

/// Sets Layer::solid by the task's rules: with skins, or only where a whole layer is dense. Only
/// layers that were cut from a mesh have facets.
void mark_solid(std::vector<Layer>& layers, const Task& task, const Mesh* mesh, bool with_skins,
                const ParallelFor& parallel_for) {
  std::vector<bool> dense(layers.size(), false);
  if (task.skin_rule != SkinRule::kDifference && mesh != nullptr)
    dense = layers_with_flat_facets(
        *mesh, task.skin_rule == SkinRule::kSlope ? FlatRule::kSlope : FlatRule::kNear,
        task.layer_height_mm, layers.size());
  else if (with_skins)
    find_solid(layers, task.skin_layers, parallel_for);
  for (std::size_t i = 0; i < layers.size(); ++i)
    if (dense[i] || layers[i].z_mm < task.base_mm) layers[i].solid = layers[i].polygons;
}

SlicedModel slice_mesh_model(const std::string& spec, const Task& task,
                             const SliceModelOptions& options, const ParallelFor& parallel_for) {
  Model model = load_model(spec, {.repair = options.repair}, parallel_for);
  const SliceOptions slicing = slicing_for(task, options);
  if (options.method == SliceMethod::kVoxel && options.on_container)
    options.on_container(voxel_container(model.mesh, slicing, spec));
  Slices slices = slice_mesh(model.mesh, slicing, spec, parallel_for);
  SlicedModel sliced;
  sliced.mesh = model.report;
  if (options.hash_mesh) sliced.mesh_hash = content_hash(model.mesh, parallel_for);
  sliced.warnings = std::move(model.warnings);
  sliced.warnings.insert(sliced.warnings.end(), slices.report.warnings.begin(),
                         slices.report.warnings.end());
  sliced.report = std::move(slices.report);
  sliced.layers = std::move(slices.layers);
  mark_solid(sliced.layers, task, &model.mesh, options.find_skins, parallel_for);
  return sliced;
}

SlicedModel read_layer_file(const std::string& spec, const Task& task,
                            const SliceModelOptions& options, const ParallelFor& parallel_for) {
  if (options.find_skins) require_no_facets_wanted(spec, task);
  SlicedModel sliced;
  sliced.layers = read_wkt(spec, task.layer_height_mm, &sliced.warnings);
  require_task_height(spec, sliced.layers, task);
  for (const Layer& layer : sliced.layers) sliced.report.repaired_layers += layer.repaired ? 1 : 0;
  mark_solid(sliced.layers, task, nullptr, options.find_skins, parallel_for);
  return sliced;
}

/// Of each layer the lowest one whose skins are found from the same polygons: it is equal and has,
/// beside air, the same different layers in reach; itself if it is the first such one.
std::vector<std::size_t> first_of_equal_surroundings(const std::vector<Layer>& layers,
                                                     std::span<const std::size_t> first,
                                                     int skin_layers) {
  const auto reach = static_cast<std::size_t>(std::max(skin_layers, 0));
  std::map<std::vector<std::size_t>, std::size_t> lowest;
  std::vector<std::size_t> original(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    // In the order in which SkinFinder asks them, so that results are equal to the last bit.
    std::vector<std::size_t> asked = {first[i]};
    const auto ask = [&asked](std::size_t other) {
      if (std::find(asked.begin(), asked.end(), other) == asked.end()) asked.push_back(other);
    };
    if (i < reach || i + reach >= layers.size()) {
      ask(layers.size());  // air, which leaves nothing to ask
    } else {
      for (std::size_t distance = reach; distance > 0; --distance) {
        ask(first[i - distance]);
        ask(first[i + distance]);
      }
    }
    const std::size_t equal = lowest.emplace(std::move(asked), i).first->second;
    original[i] = layers[equal].solid == layers[i].solid ? equal : i;
  }
  return original;
}

Point2 lower_corner(const std::vector<Layer>& layers) {
  Point2 corner{};
  bool found = false;
  for (const Layer& layer : layers) {
    if (layer.polygons.empty()) continue;
    const Point2 lower = bounding_box(layer.polygons).lower;
    corner = found ? Point2{std::min(corner.x, lower.x), std::min(corner.y, lower.y)} : lower;
    found = true;
  }
  return corner;
}

}  // namespace

SliceOptions slicing_for(const Task& task, const SliceModelOptions& options) {
  // A step of usual printers, 80 of which make a millimetre, and what slicers resolve.
  constexpr double kStraightMm = 0.0125;
  return {.layer_height_mm = task.layer_height_mm,
          .method = options.method,
          .repair = options.repair,
          .straight_mm = kStraightMm,
          .cell_mm = options.cell_mm.value_or(task.line_width_mm)};
}

SlicedModel slice_model(const std::string& spec, const Task& task, const SliceModelOptions& options,
                        const ParallelFor& parallel_for) {
  SlicedModel sliced = is_layer_file(spec) ? read_layer_file(spec, task, options, parallel_for)
                                           : slice_mesh_model(spec, task, options, parallel_for);
  sliced.spec = spec;
  sliced.origin = lower_corner(sliced.layers);
  return sliced;
}

Demands demands_of(const SlicedModel& sliced, const Task& task, const ParallelFor& parallel_for) {
  const std::vector<Layer>& layers = sliced.layers;
  const bool by_difference = task.skin_rule == SkinRule::kDifference && task.density < 1;
  const SkinFinder skins(layers, by_difference ? task.skin_layers : 0, parallel_for);
  const std::vector<std::size_t> first = first_of_equal_layers(layers);
  const std::vector<std::size_t> original =
      first_of_equal_surroundings(layers, first, task.skin_layers);
  std::vector<Polygons> insides(layers.size());
  parallel_for(layers.size(), [&](std::size_t i) {
    if (first[i] == i) insides[i] = inside_of(layers[i], task);
  });
  Demands demands(layers.size());
  parallel_for(layers.size(), [&](std::size_t i) {
    if (original[i] != i) return;
    const bool is_dense = !layers[i].solid.empty();
    demands[i] = std::make_shared<const Demand>(demand_of(
        layers[i], task, insides[first[i]],
        [&](const Polygons& inside) { return is_dense ? inside : skins.skins_in(inside, i); }));
  });
  for (std::size_t i = 0; i < layers.size(); ++i)
    if (original[i] != i) demands[i] = demands[original[i]];
  return demands;
}

PreparedModel prepare_model(const std::string& spec, const Task& task,
                            const SliceModelOptions& options, const ParallelFor& parallel_for) {
  if (is_layer_file(spec)) require_no_facets_wanted(spec, task);
  SliceModelOptions without_skins = options;
  without_skins.find_skins = false;
  PreparedModel model{slice_model(spec, task, without_skins, parallel_for), {}};
  model.demands = demands_of(model.sliced, task, parallel_for);
  return model;
}

std::vector<std::size_t> all_layers(const SlicedModel& sliced) {
  std::vector<std::size_t> chosen(sliced.layers.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  return chosen;
}

std::vector<std::size_t> first_of_equal_routes(const Contender& contender,
                                               const PreparedModel& model,
                                               std::span<const std::size_t> chosen) {
  const std::vector<Layer>& layers = model.sliced.layers;
  const std::vector<std::size_t> first = first_of_equal_layers(layers);
  const int period = contender.repeats_every();
  std::vector<std::size_t> original(chosen.size());
  std::map<std::pair<std::size_t, int>, std::vector<std::size_t>> known;  // different ones' places
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    original[i] = i;
    if (period == 0) continue;
    const Layer& layer = layers[chosen[i]];
    const auto& demand = model.demands[chosen[i]];
    std::vector<std::size_t>& places = known[{first[chosen[i]], layer.index % period}];
    const auto equal = std::find_if(places.begin(), places.end(), [&](std::size_t place) {
      const auto& other = model.demands[chosen[place]];
      return layers[chosen[place]].height_mm == layer.height_mm &&
             (other == demand ||
              (other->dense == demand->dense && other->sparse == demand->sparse));
    });
    if (equal != places.end())
      original[i] = *equal;
    else
      places.push_back(i);
  }
  return original;
}

std::vector<PlannedLayer> plan_layers(const Contender& contender, const PreparedModel& model,
                                      std::span<const std::size_t> chosen, const Task& task,
                                      std::uint64_t seed, std::stop_token stop,
                                      const ParallelFor& parallel_for, Repeats repeats) {
  const std::vector<Layer>& layers = model.sliced.layers;
  std::vector<std::size_t> first;
  if (repeats == Repeats::kTakeOver) first = first_of_equal_layers(layers);
  const auto has_equals = [&](std::size_t layer) {
    return !first.empty() &&
           (first[layer] != layer || (layer + 1 < layers.size() && first[layer + 1] == layer));
  };
  // The first of equal layers before the others, which take over from them: a thread that came to
  // the second while another plans the first would have to wait.
  std::vector<std::size_t> order(chosen.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (repeats == Repeats::kTakeOver)
    std::stable_partition(order.begin(), order.end(), [&](std::size_t i) {
      return i == 0 || first[chosen[i - 1]] != first[chosen[i]];
    });
  PlanMemo memo;
  std::vector<PlannedLayer> planned(chosen.size());
  parallel_for(chosen.size(), [&](std::size_t place) {
    const std::size_t i = order[place];
    planned[i] = contender.plan(layers[chosen[i]], *model.demands[chosen[i]], task,
                                model.sliced.origin, seed, stop,
                                has_equals(chosen[i]) ? &memo : nullptr, repeats == Repeats::kPlan);
  });
  return planned;
}

std::optional<Point2> end_of(const Route& route) {
  if (route.strokes.empty()) return std::nullopt;
  return route.strokes.back().points.back();
}

JudgedCell judge_layers(const Judge& judge, const PreparedModel& model,
                        std::span<const std::size_t> chosen, std::span<const PlannedLayer> planned,
                        const ParallelFor& parallel_for) {
  // Where each layer is entered from is known before any is judged, so that they can be judged at
  // the same time.
  std::vector<judging::LayerCase> cases;
  cases.reserve(planned.size());
  std::optional<Point2> nozzle;
  for (std::size_t i = 0; i < planned.size(); ++i) {
    cases.push_back({model.demands[chosen[i]].get(), &planned[i].route, nozzle});
    if (const auto end = end_of(planned[i].route)) nozzle = end;
  }
  const std::vector<std::size_t> first = judging::first_alike(cases);
  JudgedCell cell;
  cell.layers.resize(planned.size());
  parallel_for(planned.size(), [&](std::size_t i) {
    if (first[i] == i)
      cell.layers[i] = judge.score(model.sliced.layers[chosen[i]], *cases[i].demand,
                                   *cases[i].route, cases[i].entered_from);
  });
  const std::size_t wall_ns = metric_index("plan_wall_ns");
  const std::size_t cpu_ns = metric_index("plan_cpu_ns");
  for (std::size_t i = 0; i < planned.size(); ++i) {
    LayerScore& score = cell.layers[i];
    if (first[i] != i) {
      const Layer& layer = model.sliced.layers[chosen[i]];
      score = cell.layers[first[i]];
      score.layer_index = layer.index;
      score.z_mm = layer.z_mm;
      score.repaired = layer.repaired;
    }
    score.scores[wall_ns] = static_cast<double>(planned[i].plan_wall_ns);
    score.scores[cpu_ns] = static_cast<double>(planned[i].plan_cpu_ns);
  }
  cell.totals = judge.total(cell.layers);
  cell.verdict = judge.verdict(cell.totals);
  return cell;
}

}  // namespace routebench
