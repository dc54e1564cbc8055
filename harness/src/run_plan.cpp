#include "run_plan.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include "byte_stream.hpp"
#include "json_parts.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/planning/sha256.hpp"
#include "run_forecast.hpp"
#include "run_progress.hpp"

namespace routebench {
namespace {

/// The task keys that decide how a model is cut into layers and regions.
using Shape = std::tuple<double, int, SkinRule, double, double, int, double>;

Shape shape_of(const Task& task) {
  return {task.layer_height_mm, task.skin_layers, task.skin_rule, task.base_mm,
          task.line_width_mm,   task.perimeters,  task.density};
}

bool sliced_alike(const Task& a, const Task& b) {
  return a.layer_height_mm == b.layer_height_mm && a.skin_layers == b.skin_layers &&
         a.skin_rule == b.skin_rule && a.base_mm == b.base_mm;
}

std::string hex(std::uint64_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(value >> shift) & 0xf];
  return text;
}

/// Triangles that were sliced; none if the model is a file of layers.
std::size_t triangles_of(const SlicedModel& sliced) {
  if (!sliced.mesh) return 0;
  return sliced.mesh->simplification ? sliced.mesh->simplification->triangles_after
                                     : sliced.mesh->triangles;
}

std::size_t outline_vertices(const std::vector<Layer>& layers) {
  std::size_t vertices = 0;
  for (const Layer& layer : layers)
    for (const Polygon& polygon : layer.polygons) {
      vertices += polygon.outer.size();
      for (const Ring& hole : polygon.holes) vertices += hole.size();
    }
  return vertices;
}

ModelRecord record_of(const std::string& spec, const SlicedModel& sliced) {
  ModelRecord record;
  record.spec = spec;
  record.mesh_hash = sliced.mesh_hash ? hex(*sliced.mesh_hash) : "";
  record.layers_hash = hash_of_layers(sliced.layers);
  record.triangles = triangles_of(sliced);
  record.layers = sliced.layers.size();
  const Json report = {{"mesh", sliced.mesh ? json_of(*sliced.mesh) : Json(nullptr)},
                       {"slicing", json_of(sliced.report)},
                       {"outline_vertices", outline_vertices(sliced.layers)}};
  record.report_json = text_of(report, true);
  record.warnings_json = text_of(Json(sliced.warnings), true);
  return record;
}

/// A model under one task, cut anew only if no task before it cut it alike.
PreparedModel prepared_model(const ConfiguredModel& model, const Task& task,
                             const std::vector<std::pair<Task, const ReadyModel*>>& before,
                             const SliceModelOptions& options, const ParallelFor& parallel_for) {
  for (const auto& [other, ready] : before) {
    if (!sliced_alike(other, task)) continue;
    PreparedModel prepared{ready->prepared.sliced, {}};
    prepared.demands = demands_of(prepared.sliced, task, parallel_for);
    return prepared;
  }
  return prepare_model(model.source, task, options, parallel_for);
}

ContenderRecord record_of(const ConfiguredContender& configured, Json variant) {
  ContenderRecord record{configured.spec.name, configured.base_name, text_of(variant, true), ""};
  record.variant_hash = sha256(record.variant_json);
  return record;
}

/// Fingerprints of the plugin files from which a contender's planners come, with a space between.
/// A refused one is marked: what it lacked may be there the next time, and then it is another one.
std::string plugin_hashes(const ContenderSpec& spec, const PlannerSet& planners) {
  std::string hashes;
  for (const std::optional<SlotSpec>& slot : {spec.shell, spec.fill}) {
    if (!slot) continue;
    const std::string& origin = planners.registry.at(slot->planner).origin;
    for (const PluginRecord& plugin : planners.plugins)
      if (plugin.file == origin)
        hashes += (hashes.empty() ? "" : " ") + plugin.sha256 + (plugin.loaded ? "" : kRefusedMark);
  }
  return hashes;
}

ReadyContender ready_contender(const ConfiguredContender& configured, const PlannerSet& planners) {
  if (configured.spec.slicer) {
    Slicer slicer(*configured.spec.slicer);
    // The version is part of what it is, so that another one is another variant.
    ContenderRecord record = record_of(configured, {{"slicer", json_of(slicer)}});
    return {std::move(record), std::move(slicer), ""};
  }
  if (configured.spec.slicing)
    return {record_of(configured, {{"slicing", to_string(*configured.spec.slicing)}}),
            *configured.spec.slicing, ""};
  Contender contender(configured.spec, planners.registry);
  Json variant = json_of(contender);
  variant.erase("name");
  return {record_of(configured, std::move(variant)), std::move(contender),
          plugin_hashes(configured.spec, planners)};
}

SettingRecord record_of(const Setting& setting) {
  SettingRecord record{setting.label, text_of(json_of(setting.task), true),
                       text_of(json_of(setting.printer), true), ""};
  ByteWriter both;
  both.add(std::string_view(record.task_json)).add(std::string_view(record.printer_json));
  record.setting_hash = sha256(both.bytes());
  return record;
}

std::string key_of(const PlannedCell& cell) {
  ByteWriter key;
  key.add(std::string_view(cell.model->record.spec))
      .add(std::string_view(cell.model->record.layers_hash))
      .add(std::string_view(cell.contender->record.name))
      .add(std::string_view(cell.contender->record.variant_hash))
      .add(std::string_view(cell.contender->plugin_hashes))
      .add(std::string_view(cell.setting->record.setting_hash))
      .add(cell.seed);
  return sha256(key.bytes());
}

std::string label_of(const PlannedCell& cell, const ExperimentConfig& config) {
  std::string label = cell.model->record.spec + " · " + cell.contender->record.name;
  if (!cell.setting->record.label.empty()) label += " · " + cell.setting->record.label;
  if (config.seeds.size() > 1) label += " · seed " + std::to_string(cell.seed);
  return label;
}

/// "walls, density=1" as itself, "walls" and "density=1".
std::vector<std::string> parts_of_label(const std::string& label) {
  constexpr std::string_view kSeparator = ", ";
  std::vector<std::string> parts{label};
  if (label.find(kSeparator) == std::string::npos) return parts;
  for (std::size_t begin = 0; begin < label.size();) {
    const std::size_t end = std::min(label.find(kSeparator, begin), label.size());
    parts.push_back(label.substr(begin, end - begin));
    begin = end + kSeparator.size();
  }
  return parts;
}

bool is_among(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Throws Error{kBadUsage} for a wanted name that is not there.
void require_among(const std::vector<std::string>& wanted, const std::set<std::string>& there,
                   const std::string& what) {
  for (const std::string& name : wanted) {
    if (there.contains(name)) continue;
    const std::vector<std::string> names(there.begin(), there.end());
    const std::optional<std::string> near = nearest_name(name, names);
    throw Error(
        ErrorKind::kBadUsage,
        "--only " + what + "=" + name + ": the config has no such " + what +
            (near ? "; did you mean " + *near + "?" : ", but for example " + names.front()));
  }
}

void require_known_choice(const ExperimentConfig& config, const RunnerOptions& options) {
  std::set<std::string> contenders;
  for (const ConfiguredContender& contender : config.contenders)
    contenders.insert({contender.spec.name, contender.base_name});
  std::set<std::string> models;
  for (const ConfiguredModel& model : config.models) models.insert(model.spec);
  require_among(options.only_contenders, contenders, "contender");
  require_among(options.only_models, models, "model");
  std::set<std::string> settings;
  for (const Setting& setting : config.settings)
    for (const std::string& part : parts_of_label(setting.label)) settings.insert(part);
  require_among(options.only_settings, settings, "setting");
}

/// Whether the options let a cell be executed; `place` counts all cells of the config.
bool is_chosen(const PlannedCell& cell, std::size_t place, const RunnerOptions& options) {
  const auto fits = [](const std::vector<std::string>& wanted,
                       const std::vector<std::string>& names) {
    return wanted.empty() || std::any_of(names.begin(), names.end(), [&](const std::string& name) {
             return is_among(wanted, name);
           });
  };
  const ContenderRecord& contender = cell.contender->record;
  const std::string& spec = cell.model->record.spec;
  const std::string& label = cell.setting->record.label;
  if (options.shard && place % options.shard->count != options.shard->number - 1) return false;
  if (options.only_cells && !options.only_cells->contains({spec, contender.name, label, cell.seed}))
    return false;
  return fits(options.only_contenders, {contender.name, contender.base_name}) &&
         fits(options.only_models, {spec}) && fits(options.only_settings, parts_of_label(label));
}

/// Models by their place in the config and by shape: settings that differ in nothing else share
/// layers and demands.
using ModelTable = std::map<std::pair<std::size_t, Shape>, const ReadyModel*>;

/// Makes one model ready for every setting.
void make_ready(const ExperimentConfig& config, std::size_t place_in_config,
                const SliceModelOptions& slicing, const ParallelFor& parallel_for, RunPlan& plan,
                ModelTable& table) {
  const ConfiguredModel& model = config.models[place_in_config];
  std::vector<std::pair<Task, const ReadyModel*>> before;
  for (const Setting& setting : config.settings) {
    const ReadyModel*& place = table[{place_in_config, shape_of(setting.task)}];
    if (place != nullptr) continue;
    PreparedModel prepared = prepared_model(model, setting.task, before, slicing, parallel_for);
    ModelRecord record = record_of(model.spec, prepared.sliced);
    const double work = work_of(prepared, setting.task);
    plan.models.push_back({std::move(record), std::move(prepared), work});
    place = &plan.models.back();
    before.emplace_back(setting.task, place);
  }
  const ReadyModel& first = *before.front().second;
  plan.notes.push_back("sliced " + model.spec + ": " + std::to_string(first.record.layers) +
                       (first.record.layers == 1 ? " layer" : " layers"));
  for (const std::string& warning : first.prepared.sliced.warnings)
    plan.notes.push_back("warning: " + model.spec + ": " + warning);
}

/// Makes a model ready, or notes why one that may be missing is left out.
void add_model(const ExperimentConfig& config, std::size_t place_in_config,
               const SliceModelOptions& slicing, const ParallelFor& parallel_for, RunPlan& plan,
               ModelTable& table) {
  const ConfiguredModel& model = config.models[place_in_config];
  const std::size_t ready_before = plan.models.size();
  try {
    make_ready(config, place_in_config, slicing, parallel_for, plan, table);
  } catch (const Error& error) {
    if (!model.optional || error.kind() != ErrorKind::kBadInput) throw;
    while (plan.models.size() > ready_before) plan.models.pop_back();
    std::erase_if(table, [&](const auto& entry) { return entry.first.first == place_in_config; });
    plan.notes.push_back(std::string("left out an optional model: ") + error.what());
  }
}

void add_cells(const ExperimentConfig& config, const RunnerOptions& options,
               const ModelTable& models, RunPlan& plan) {
  // Counts what is left out, too: shards are the same on every machine.
  std::size_t place = 0;
  for (std::size_t s = 0; s < config.settings.size(); ++s)
    for (std::size_t m = 0; m < config.models.size(); ++m)
      for (const std::uint64_t seed : config.seeds)
        for (const ReadyContender& contender : plan.contenders) {
          const std::size_t place_of_cell = place++;
          const auto ready = models.find({m, shape_of(config.settings[s].task)});
          if (ready == models.end()) continue;  // optional, and left out
          PlannedCell cell;
          cell.model = ready->second;
          cell.contender = &contender;
          cell.setting = &plan.settings[s];
          cell.seed = seed;
          cell.chosen = is_chosen(cell, place_of_cell, options);
          cell.key = key_of(cell);
          cell.label = label_of(cell, config);
          plan.cells.push_back(std::move(cell));
        }
}

}  // namespace

RunPlan make_plan(const ExperimentConfig& config, const PlannerSet& planners,
                  const RunnerOptions& options, const ParallelFor& parallel_for,
                  const RunLog& log) {
  check_contenders(config, planners.registry);
  require_known_choice(config, options);
  RunPlan plan;
  for (const ConfiguredContender& configured : config.contenders) {
    plan.contenders.push_back(ready_contender(configured, planners));
    const Slicer* slicer = std::get_if<Slicer>(&plan.contenders.back().worker);
    if (slicer != nullptr)
      plan.notes.push_back(configured.spec.name + ": " +
                           (slicer->missing().empty() ? slicer->version() : slicer->missing()));
  }
  for (const Setting& setting : config.settings)
    plan.settings.push_back({record_of(setting), Judge(setting.task, setting.printer)});
  ModelTable models;
  RunProgress progress(log, "slicing model", config.models.size(),
                       static_cast<double>(config.models.size()));
  for (std::size_t m = 0; m < config.models.size(); ++m) {
    add_model(config, m, {.repair = options.repair, .hash_mesh = true}, parallel_for, plan, models);
    progress.step(1, {});
  }
  add_cells(config, options, models, plan);
  return plan;
}

}  // namespace routebench
