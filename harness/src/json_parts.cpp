#include "json_parts.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

namespace routebench {
namespace {

/// Below this every whole number is exact.
constexpr double kExactBelow = 9007199254740992.0;  // 2^53

Json number_json(double value) {
  if (std::abs(value) < kExactBelow && value == std::trunc(value))
    return static_cast<std::int64_t>(value);
  return value;
}

template <typename Number>
bool read_all(const std::string& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

Json key_values_json(const std::vector<KeyValue>& table) {
  Json json = Json::object();
  for (const auto& [key, value] : table) {
    double number = 0;
    if (read_all(value, number)) {
      json[key] = number_json(number);
    } else {
      json[key] = value;
    }
  }
  return json;
}

Json slot_json(const std::optional<SlotSpec>& slot, const ParamSet& params) {
  if (!slot) return nullptr;
  return {{"planner", slot->planner}, {"params", params_json(params)}};
}

Json point_json(Point3 p) { return {p.x, p.y, p.z}; }

std::string_view type_name(ParamType type) {
  switch (type) {
    case ParamType::kBool:
      return "bool";
    case ParamType::kInt:
      return "int";
    case ParamType::kReal:
      return "real";
    case ParamType::kChoice:
      return "choice";
  }
  return "";
}

}  // namespace

Json param_json(const ParamValue& value) {
  return std::visit([](const auto& held) { return Json(held); }, value);
}

Json params_json(const ParamSet& params) {
  Json json = Json::object();
  for (const auto& [name, value] : params) json[name] = param_json(value);
  return json;
}

Json task_json(const Task& task) { return key_values_json(task_values(task)); }

Json printer_json(const Printer& printer) { return key_values_json(printer_values(printer)); }

Json contender_json(const Contender& contender) {
  const ContenderSpec& spec = contender.spec();
  return {{"name", spec.name},
          {"shell", slot_json(spec.shell, contender.shell_params())},
          {"fill", slot_json(spec.fill, contender.fill_params())},
          {"order", to_string(spec.order)}};
}

Json mesh_json(const MeshReport& report) {
  return {{"triangles", report.triangles},
          {"vertices", report.vertices},
          {"lower_mm", point_json(report.lower_mm)},
          {"upper_mm", point_json(report.upper_mm)},
          {"components", report.components},
          {"open_edges", report.open_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"flipped_triangles", report.flipped_triangles},
          {"degenerate_triangles", report.degenerate_triangles},
          {"duplicate_triangles", report.duplicate_triangles},
          {"volume_mm3", report.volume_mm3}};
}

Json slice_report_json(const SliceReport& report) {
  return {{"cracks_closed", report.cracks_closed},
          {"widest_crack_mm", report.widest_crack_mm},
          {"gaps_repaired", report.gaps_repaired},
          {"widest_gap_mm", report.widest_gap_mm},
          {"repaired_layers", report.repaired_layers}};
}

Json scores_json(const Scores& scores) {
  Json json = Json::object();
  const auto table = metric_table();
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool known = i < scores.size() && scores[i].has_value() && std::isfinite(*scores[i]);
    json[std::string(table[i].name)] = known ? number_json(*scores[i]) : Json(nullptr);
  }
  return json;
}

Json strokes_json(const PlannedLayer& planned) {
  Json json = Json::array();
  for (std::size_t i = 0; i < planned.route.strokes.size(); ++i) {
    const Stroke& stroke = planned.route.strokes[i];
    Json points = Json::array();
    for (const Point2 p : stroke.points) points.push_back({p.x, p.y});
    json.push_back({{"kind", to_string(planned.kinds[i])},
                    {"width_mm", stroke.width_mm},
                    {"points", std::move(points)}});
  }
  return json;
}

Json schema_json(const std::vector<ParamSchema>& params) {
  Json json = Json::array();
  for (const ParamSchema& param : params) {
    Json one = {{"name", param.name},
                {"type", type_name(param.type)},
                {"default", param_json(param.default_value)},
                {"lowest", param.lowest ? number_json(*param.lowest) : Json(nullptr)},
                {"highest", param.highest ? number_json(*param.highest) : Json(nullptr)},
                {"choices", param.choices},
                {"unit", param.unit},
                {"help", param.help}};
    json.push_back(std::move(one));
  }
  return json;
}

Json planner_json(const Registry::Entry& entry) {
  return {{"name", entry.info.name},
          {"role", entry.info.role == PlannerRole::kShell ? "shell" : "fill"},
          {"summary", entry.info.summary},
          {"source", entry.info.source},
          {"origin", entry.origin},
          {"params", schema_json(entry.params)}};
}

Json plugin_json(const PluginRecord& plugin) {
  return {{"file", plugin.file},
          {"loaded", plugin.loaded},
          {"refused_because", plugin.loaded ? Json(nullptr) : Json(plugin.refused_because)},
          {"build_id", plugin.build_id},
          {"sha256", plugin.sha256},
          {"planners", plugin.planners}};
}

std::string text_of(const Json& document, bool compact) {
  return document.dump(compact ? -1 : 2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace routebench
