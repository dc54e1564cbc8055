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

/// A number, two of them, or text.
Json json_of_value(const std::string& text) {
  double number = 0;
  if (read_all(text, number)) return number_json(number);
  const std::size_t comma = text.find(',');
  if (comma == text.npos) return text;
  return {json_of_value(text.substr(0, comma)), json_of_value(text.substr(comma + 1))};
}

Json json_of_values(const std::vector<KeyValue>& table) {
  Json json = Json::object();
  for (const auto& [key, value] : table) json[key] = json_of_value(value);
  return json;
}

Json slot_json(const std::optional<SlotSpec>& slot, const ParamSet& params) {
  if (!slot) return nullptr;
  return {{"planner", slot->planner}, {"params", json_of(params)}};
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

Json json_of(const ParamValue& value) {
  return std::visit([](const auto& held) { return Json(held); }, value);
}

Json json_of(const ParamSet& params) {
  Json json = Json::object();
  for (const auto& [name, value] : params) json[name] = json_of(value);
  return json;
}

Json json_of(const Task& task) { return json_of_values(task_values(task)); }

Json json_of(const Printer& printer) { return json_of_values(printer_values(printer)); }

Json json_of(const Contender& contender) {
  const ContenderSpec& spec = contender.spec();
  return {{"name", spec.name},
          {"shell", slot_json(spec.shell, contender.shell_params())},
          {"fill", slot_json(spec.fill, contender.fill_params())},
          {"order", to_string(spec.order)}};
}

Json json_of(const SlicerSpec& slicer) {
  return slicer.command.empty() ? Json{{"name", slicer.name}} : Json{{"command", slicer.command}};
}

Json json_of(const Slicer& slicer) {
  Json json = json_of(slicer.spec());
  json["version"] = slicer.version().empty() ? Json(nullptr) : Json(slicer.version());
  return json;
}

Json json_of(const MeshReport& report) {
  Json simplification;
  if (report.simplification)
    simplification = {{"triangles_before", report.simplification->triangles_before},
                      {"triangles_after", report.simplification->triangles_after},
                      {"deviation_mm", report.simplification->deviation_mm}};
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
          {"volume_mm3", report.volume_mm3},
          {"simplification", simplification}};
}

Json json_of(const SliceReport& report) {
  return {{"cracks_closed", report.cracks_closed},
          {"widest_crack_mm", report.widest_crack_mm},
          {"gaps_repaired", report.gaps_repaired},
          {"widest_gap_mm", report.widest_gap_mm},
          {"repaired_layers", report.repaired_layers}};
}

Json json_of(const Scores& scores) {
  Json json = Json::object();
  const auto table = metric_table();
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool known = i < scores.size() && scores[i].has_value() && std::isfinite(*scores[i]);
    json[std::string(table[i].name)] = known ? number_json(*scores[i]) : Json(nullptr);
  }
  return json;
}

Json json_of(const PlannedLayer& planned) {
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

Json json_of(const std::vector<ParamSchema>& params) {
  Json json = Json::array();
  for (const ParamSchema& param : params) {
    Json one = {{"name", param.name},
                {"type", type_name(param.type)},
                {"default", json_of(param.default_value)},
                {"lowest", param.lowest ? number_json(*param.lowest) : Json(nullptr)},
                {"highest", param.highest ? number_json(*param.highest) : Json(nullptr)},
                {"choices", param.choices},
                {"unit", param.unit},
                {"help", param.help}};
    json.push_back(std::move(one));
  }
  return json;
}

Json json_of(const Registry::Entry& entry) {
  return {{"name", entry.info.name},       {"role", to_string(entry.info.role)},
          {"summary", entry.info.summary}, {"source", entry.info.source},
          {"origin", entry.origin},        {"params", json_of(entry.params)}};
}

Json json_of(const PluginRecord& plugin) {
  return {{"file", plugin.file},
          {"by_name", plugin.by_name},
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
