#include "json_documents.hpp"

#include "routebench/geometry/region.hpp"

namespace routebench {
namespace {

Json mesh_of(const SlicedModel& model) { return model.mesh ? json_of(*model.mesh) : Json(nullptr); }

Json layer_document(const LayerScore& layer) {
  Json json = {{"layer", layer.layer_index}, {"z_mm", layer.z_mm}, {"repaired", layer.repaired}};
  json.update(json_of(layer.scores));
  return json;
}

Json layer_documents(const std::vector<LayerScore>& layers) {
  Json json = Json::array();
  for (const LayerScore& layer : layers) json.push_back(layer_document(layer));
  return json;
}

Json layer_document(const Layer& layer) {
  std::size_t holes = 0;
  for (const Polygon& polygon : layer.polygons) holes += polygon.holes.size();
  return {{"layer", layer.index},
          {"z_mm", layer.z_mm},
          {"height_mm", layer.height_mm},
          {"area_mm2", area_mm2(layer.polygons)},
          {"perimeter_mm", perimeter_mm(layer.polygons)},
          {"polygons", layer.polygons.size()},
          {"holes", holes},
          {"repaired", layer.repaired}};
}

}  // namespace

Json plan_document(const PlanResult& result) {
  const JudgedCell* const cell = result.cell;
  Json document = {{"model", result.model.spec},
                   {"contender", result.contender},
                   {"task", json_of(result.judge.task())},
                   {"printer", json_of(result.judge.printer())},
                   {"seed", result.seed ? Json(*result.seed) : Json(nullptr)},
                   {"outcome", cell ? Json(to_string(cell->verdict.outcome)) : Json(nullptr)},
                   {"reason", cell ? Json(cell->verdict.reason) : Json(nullptr)},
                   {"layers", result.layers},
                   {"totals", cell ? json_of(cell->totals) : Json(nullptr)},
                   {"per_layer", cell ? layer_documents(cell->layers) : Json(nullptr)},
                   {"mesh", mesh_of(result.model)},
                   {"warnings", result.model.warnings}};
  if (const PlanPhases* const cpu = result.cpu)
    document["cpu_ns"] = {{"prepare", cpu->prepare_ns},
                          {"plan", cpu->plan_ns},
                          {"judge", cpu->judge_ns ? Json(*cpu->judge_ns) : Json(nullptr)}};
  return document;
}

Json score_document(const ScoreResult& result) {
  const GcodePrint& print = result.print;
  const LayerPairs& pairs = result.score.pairs;
  const SlicedModel* const model = result.model;
  Json unpaired_z = Json::array(), missing = Json::array(), ignored = Json::object();
  for (const std::size_t layer : pairs.unpaired) unpaired_z.push_back(print.layers[layer].z_mm);
  for (const std::size_t place : result.chosen)
    if (!pairs.file_layers[place]) missing.push_back(model->layers[place].index);
  for (const auto& [command, count] : print.ignored) ignored[command] = count;
  const Verdict& verdict = result.score.cell.verdict;
  const Point2 offset = result.score.offset_mm;
  return {{"file", result.file},
          {"model", model ? Json(model->spec) : Json(nullptr)},
          {"task", json_of(result.judge.task())},
          {"printer", json_of(result.judge.printer())},
          {"outcome", model ? Json(to_string(verdict.outcome)) : Json(nullptr)},
          {"reason", model ? Json(verdict.reason) : Json(nullptr)},
          {"layers", result.score.cell.layers.size()},
          {"offset_mm", model ? Json{offset.x, offset.y} : Json(nullptr)},
          {"z_offset_mm", model ? Json(print.z_offset_mm) : Json(nullptr)},
          {"paired_layers", model ? Json(pairs.count(result.chosen)) : Json(nullptr)},
          {"missing_layers", model ? missing : Json(nullptr)},
          {"unpaired_z_mm", model ? unpaired_z : Json(nullptr)},
          {"file_layers", print.layers.size()},
          {"file_retractions", print.retractions},
          {"file_travel_mm", print.travel_mm},
          {"file_filament_mm3", print.filament_mm3},
          {"file_excluded_strokes", print.excluded_strokes},
          {"file_excluded_mm", print.excluded_mm},
          {"file_ignored", std::move(ignored)},
          {"totals", json_of(result.score.cell.totals)},
          {"per_layer", layer_documents(result.score.cell.layers)},
          {"mesh", model ? mesh_of(*model) : Json(nullptr)},
          {"warnings", print.warnings}};
}

Json slice_document(const SlicedModel& model, std::string_view method) {
  Json layers = Json::array();
  for (const Layer& layer : model.layers) layers.push_back(layer_document(layer));
  return {{"model", model.spec},
          {"mesh", mesh_of(model)},
          {"warnings", model.warnings},
          {"method", model.mesh ? Json(method) : Json(nullptr)},
          {"report", json_of(model.report)},
          {"layers", std::move(layers)}};
}

Json planners_document(const PlannerSet& planners) {
  Json entries = Json::array();
  for (const auto& [name, entry] : planners.registry.entries()) entries.push_back(json_of(entry));
  Json plugins = Json::array();
  for (const PluginRecord& plugin : planners.plugins) plugins.push_back(json_of(plugin));
  Json folders = Json::array();
  for (const PluginFolder& folder : planners.folders)
    folders.push_back({{"folder", folder.path}, {"exists", folder.exists}});
  return {{"planners", std::move(entries)},
          {"plugins", std::move(plugins)},
          {"plugin_folders", std::move(folders)}};
}

}  // namespace routebench
