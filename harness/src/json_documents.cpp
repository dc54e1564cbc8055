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
  Json layers = Json::array();
  for (const LayerScore& layer : result.cell.layers) layers.push_back(layer_document(layer));
  return {{"model", result.model.spec},
          {"contender", json_of(result.contender)},
          {"task", json_of(result.judge.task())},
          {"printer", json_of(result.judge.printer())},
          {"seed", result.seed},
          {"outcome", to_string(result.cell.verdict.outcome)},
          {"reason", result.cell.verdict.reason},
          {"layers", result.layers},
          {"totals", json_of(result.cell.totals)},
          {"per_layer", std::move(layers)},
          {"mesh", mesh_of(result.model)},
          {"warnings", result.model.warnings}};
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
  return {{"planners", std::move(entries)}, {"plugins", std::move(plugins)}};
}

}  // namespace routebench
