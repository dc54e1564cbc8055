#include "planner_protocol.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "json_parts.hpp"
#include "process_planner.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/geometry/grid.hpp"
#include "routebench/geometry/vec.hpp"

namespace routebench {
namespace {

/// Beyond this a coordinate is no place; it is left as it is, for whoever checks routes.
constexpr double kFarthestMm = 1e6;
constexpr std::size_t kMostPlanners = 1000;

[[noreturn]] void refuse(const std::string& complaint) {
  throw Error(ErrorKind::kBadInput, complaint);
}

/// The beginning of a text, printable.
std::string excerpt(const std::string& text) {
  constexpr std::size_t kMostBytes = 60;
  std::string shown = text.substr(0, kMostBytes);
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return "'" + shown + (text.size() > kMostBytes ? "...'" : "'");
}

/// A line that must hold one object.
Json object_in(const std::string& line) {
  Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded()) refuse("it is not JSON: " + excerpt(line));
  if (!json.is_object()) refuse("it is JSON, but no object: " + excerpt(line));
  if (const auto error = json.find("error"); error != json.end()) {
    if (json.value("out_of_memory", Json(false)) == Json(true)) throw std::bad_alloc();
    throw PlannerComplaint(error->is_string() ? error->get<std::string>() : text_of(*error, true));
  }
  return json;
}

std::string text_at(const Json& json, const char* key, bool required) {
  const auto found = json.find(key);
  if (found == json.end()) {
    if (required) refuse(std::string("the key \"") + key + "\" is missing");
    return {};
  }
  if (!found->is_string()) refuse(std::string("\"") + key + "\" must be a text");
  return found->get<std::string>();
}

double number_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number())
    refuse(std::string("the number \"") + key + "\" is missing");
  return found->get<double>();
}

ParamValue default_of(const Json& json, ParamType type) {
  const auto found = json.find("default");
  if (found == json.end()) refuse("the key \"default\" is missing");
  switch (type) {
    case ParamType::kBool:
      if (found->is_boolean()) return found->get<bool>();
      refuse("\"default\" must be true or false");
    case ParamType::kInt:
      if (found->is_number_integer()) return found->get<std::int64_t>();
      refuse("\"default\" must be a whole number");
    case ParamType::kReal:
      if (found->is_number()) return found->get<double>();
      refuse("\"default\" must be a number");
    case ParamType::kChoice:
      break;
  }
  if (found->is_string()) return found->get<std::string>();
  refuse("\"default\" must be a text");
}

ParamType type_of(const std::string& word) {
  if (word == "bool") return ParamType::kBool;
  if (word == "int") return ParamType::kInt;
  if (word == "real") return ParamType::kReal;
  if (word == "choice") return ParamType::kChoice;
  refuse("\"type\" is " + excerpt(word) + "; it must be bool, int, real or choice");
}

ParamSchema schema_of(const Json& json) {
  if (!json.is_object()) refuse("a parameter must be an object");
  ParamSchema schema;
  schema.name = text_at(json, "name", true);
  try {
    schema.type = type_of(text_at(json, "type", true));
    schema.default_value = default_of(json, schema.type);
    if (schema.type == ParamType::kInt || schema.type == ParamType::kReal) {
      schema.lowest = number_at(json, "lowest");
      schema.highest = number_at(json, "highest");
    }
    if (schema.type == ParamType::kChoice) {
      for (const Json& choice : json.value("choices", Json::array())) {
        if (!choice.is_string()) refuse("\"choices\" must be texts");
        schema.choices.push_back(choice.get<std::string>());
      }
      const std::string& standard = std::get<std::string>(schema.default_value);
      if (std::find(schema.choices.begin(), schema.choices.end(), standard) == schema.choices.end())
        refuse("the default " + excerpt(standard) + " is none of its \"choices\"");
    }
    schema.unit = text_at(json, "unit", false);
    schema.help = text_at(json, "help", false);
  } catch (const Error& error) {
    refuse("parameter " + excerpt(schema.name) + ": " + error.what());
  }
  return schema;
}

PlannerRole role_of(const std::string& word) {
  if (word == "shell") return PlannerRole::kShell;
  if (word == "fill") return PlannerRole::kFill;
  refuse("\"role\" is " + excerpt(word) + "; it must be shell or fill");
}

PlannerDescription planner_of(const Json& json) {
  if (!json.is_object()) refuse("a planner must be an object");
  PlannerDescription planner;
  planner.info.name = text_at(json, "name", true);
  try {
    planner.info.role = role_of(text_at(json, "role", true));
    planner.info.summary = text_at(json, "summary", false);
    planner.info.source = text_at(json, "source", false);
    for (const Json& setting : json.value("may_leave", Json::array()))
      planner.info.may_leave.push_back(
          {text_at(setting, "param", true), text_at(setting, "value", true)});
    for (const Json& param : json.value("params", Json::array()))
      planner.params.push_back(schema_of(param));
    static_cast<void>(resolved_params("planner " + planner.info.name, planner.params, {}));
  } catch (const Error& error) {
    refuse("planner " + excerpt(planner.info.name) + ": " + error.what());
  }
  return planner;
}

/// Lists of points make by far the most of what is sent, so they are written without a document.
void write_points(std::string& out, const Ring& ring, Point2 origin) {
  out += '[';
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point2 p = ring[i] - origin;
    if (i > 0) out += ',';
    out += '[' + to_string(ParamValue(p.x)) + ',' + to_string(ParamValue(p.y)) + ']';
  }
  out += ']';
}

void write_polygons(std::string& out, const Polygons& polygons, Point2 origin) {
  out += '[';
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    out += i > 0 ? ",{\"outer\":" : "{\"outer\":";
    write_points(out, polygons[i].outer, origin);
    out += ",\"holes\":[";
    for (std::size_t k = 0; k < polygons[i].holes.size(); ++k) {
      if (k > 0) out += ',';
      write_points(out, polygons[i].holes[k], origin);
    }
    out += "]}";
  }
  out += ']';
}

/// A coordinate as the printer sees it.
double placed(double mm, double origin_mm) {
  return std::abs(mm) <= kFarthestMm ? snap(mm) + origin_mm : mm;
}

Point2 point_of(const Json& json, Point2 origin) {
  if (!json.is_array() || json.size() != 2 || !json[0].is_number() || !json[1].is_number())
    refuse("is no pair of numbers, [x, y]");
  return {placed(json[0].get<double>(), origin.x), placed(json[1].get<double>(), origin.y)};
}

/// Points that differ but come to lie on one another on the grid are one.
void append_points(const Json& points, Point2 origin, Stroke& stroke) {
  if (!points.is_array()) refuse("\"points\" must be a list of [x, y]");
  stroke.points.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    try {
      const Point2 p = point_of(points[i], origin);
      if (i > 0 && p == stroke.points.back() && points[i] != points[i - 1]) continue;
      stroke.points.push_back(p);
    } catch (const Error& error) {
      refuse("point " + std::to_string(i) + " " + error.what());
    }
  }
}

Stroke stroke_of(const Json& json, const PlanContext& context) {
  if (!json.is_object()) refuse("must be an object with \"points\"");
  Stroke stroke;
  const auto width = json.find("width_mm");
  if (width != json.end() && !width->is_number()) refuse("\"width_mm\" must be a number");
  stroke.width_mm = width == json.end() ? context.line_width_mm : width->get<double>();
  const auto points = json.find("points");
  if (points == json.end()) refuse("the key \"points\" is missing");
  append_points(*points, context.origin, stroke);
  return stroke;
}

std::optional<PlanTime> times_of(const Json& json) {
  const auto wall = json.find("plan_wall_ns");
  const auto cpu = json.find("plan_cpu_ns");
  if (wall == json.end() || cpu == json.end()) return std::nullopt;
  if (!wall->is_number_unsigned() || !cpu->is_number_unsigned()) return std::nullopt;
  return PlanTime{wall->get<std::int64_t>(), cpu->get<std::int64_t>()};
}

}  // namespace

std::string describe_request() {
  return text_of({{"routebench", kPlannerProtocol}, {"request", "describe"}}, true);
}

ProgramDescription read_description(const std::string& line) {
  const Json json = object_in(line);
  const auto version = json.find("routebench");
  if (version == json.end() || *version != kPlannerProtocol)
    refuse("it speaks protocol " + (version == json.end() ? "(none)" : text_of(*version, true)) +
           "; this program speaks " + std::to_string(kPlannerProtocol) +
           ", which the description says with \"routebench\": " + std::to_string(kPlannerProtocol));
  const auto planners = json.find("planners");
  if (planners == json.end() || !planners->is_array() || planners->empty() ||
      planners->size() > kMostPlanners)
    refuse("\"planners\" must be a list of one planner or more");
  ProgramDescription description;
  description.made_with = text_at(json, "made_with", false);
  for (const Json& planner : *planners) description.planners.push_back(planner_of(planner));
  return description;
}

std::string plan_request(const std::string& planner, const ParamSet& params, const Layer& layer,
                         const PlanContext& context) {
  const Point2 start = context.start - context.origin;
  const Json head = {
      {"routebench", kPlannerProtocol},
      {"request", "plan"},
      {"planner", planner},
      {"params", json_of(params)},
      {"context",
       {{"start", {start.x, start.y}},
        {"line_width_mm", context.line_width_mm},
        {"spacing_mm", context.spacing_mm},
        {"line_distance_mm", context.line_distance_mm()},
        {"density", context.density},
        {"perimeters", context.perimeters},
        {"seed", context.seed}}},
      {"layer", {{"index", layer.index}, {"z_mm", layer.z_mm}, {"height_mm", layer.height_mm}}}};
  std::string line = text_of(head, true);
  line.erase(line.size() - 2);  // the layer goes on
  line += ",\"polygons\":";
  write_polygons(line, layer.polygons, context.origin);
  return line + "}}";
}

PlanAnswer read_route(const std::string& line, const PlanContext& context) {
  const Json json = object_in(line);
  const auto strokes = json.find("strokes");
  if (strokes == json.end() || !strokes->is_array())
    refuse("the list \"strokes\" is missing: " + excerpt(line));
  PlanAnswer answer;
  answer.route.strokes.reserve(strokes->size());
  for (const Json& stroke : *strokes) {
    try {
      answer.route.strokes.push_back(stroke_of(stroke, context));
    } catch (const Error& error) {
      refuse("stroke " + std::to_string(answer.route.strokes.size()) + ": " + error.what());
    }
  }
  answer.times = times_of(json);
  return answer;
}

ParamSet resolved_params(const std::string& owner, const std::vector<ParamSchema>& schema,
                         const ParamSet& values) {
  ParamBinder bind(owner, values);
  for (const ParamSchema& param : schema) {
    const char* const name = param.name.c_str();
    const Range range{param.lowest.value_or(0), param.highest.value_or(0)};
    switch (param.type) {
      case ParamType::kBool: {
        bool yes = std::get<bool>(param.default_value);
        bind(name, yes, param.help.c_str());
        break;
      }
      case ParamType::kInt: {
        const std::int64_t standard = std::get<std::int64_t>(param.default_value);
        if (!std::in_range<int>(standard)) refuse("default of " + param.name + " is too large");
        int whole = static_cast<int>(standard);
        bind(name, whole, range, param.unit.c_str(), param.help.c_str());
        break;
      }
      case ParamType::kReal: {
        double real = std::get<double>(param.default_value);
        bind(name, real, range, param.unit.c_str(), param.help.c_str());
        break;
      }
      case ParamType::kChoice: {
        const auto standard = std::find(param.choices.begin(), param.choices.end(),
                                        std::get<std::string>(param.default_value));
        static_cast<void>(bind.bind_choice(
            name, param.choices, static_cast<std::size_t>(standard - param.choices.begin()),
            param.help.c_str()));
        break;
      }
    }
  }
  bind.finish();
  return bind.resolved();
}

}  // namespace routebench
