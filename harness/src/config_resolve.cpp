/// Configs against the planners that are there: checks, and what is recorded of them.

#include <charconv>
#include <nlohmann/json.hpp>

#include "routebench/geometry/error.hpp"
#include "routebench/harness/config.hpp"

namespace routebench {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& place, const std::string& key,
                         const std::string& complaint) {
  throw Error(ErrorKind::kBadInput, place + ": key `" + key + "`: " + complaint);
}

/// Checks every parameter by itself, so that a message can name the line of the one that is wrong.
void check_slot(const ConfiguredContender& contender, const std::string& slot_name,
                const SlotSpec& slot, const Registry& registry) {
  const auto checked = [&](const std::string& key, const auto& check) {
    const std::string full = slot_name + "." + key;
    try {
      check();
    } catch (const Error& error) {
      refuse(contender.key_places.at(full), full, error.what());
    }
  };
  checked("planner", [&] { static_cast<void>(registry.at(slot.planner)); });
  const Registry::Entry& entry = registry.at(slot.planner);
  for (const auto& [key, value] : slot.params)
    checked(key, [&] { static_cast<void>(entry.resolve({{key, value}})); });
}

json json_of(const ParamSet& params) {
  json object = json::object();
  for (const auto& [key, value] : params)
    std::visit([&object, &name = key](const auto& held) { object[name] = held; }, value);
  return object;
}

json json_of(const std::optional<SlotSpec>& slot, const Registry& registry) {
  if (!slot) return nullptr;
  return {{"planner", slot->planner},
          {"params", json_of(registry.at(slot->planner).resolve(slot->params))}};
}

json variant_of(const ContenderSpec& contender, const Registry& registry) {
  return {{"shell", json_of(contender.shell, registry)},
          {"fill", json_of(contender.fill, registry)},
          {"order", contender.order == LayerOrder::kIsland ? "island" : "stage"}};
}

/// A text as the value that it stands for: number, pair of numbers, or itself.
json json_of_text(const std::string& text) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  std::int64_t whole = 0;
  if (const auto [at, error] = std::from_chars(begin, end, whole);
      error == std::errc{} && at == end)
    return whole;
  double real = 0;
  if (const auto [at, error] = std::from_chars(begin, end, real); error == std::errc{} && at == end)
    return real;
  if (const std::size_t comma = text.find(','); comma != std::string::npos)
    return {json_of_text(text.substr(0, comma)), json_of_text(text.substr(comma + 1))};
  return text;
}

json json_of(const std::vector<KeyValue>& values) {
  json object = json::object();
  for (const KeyValue& pair : values) object[pair.key] = json_of_text(pair.value);
  return object;
}

json json_of(const KeepLayers& keep) {
  switch (keep.rule) {
    case KeepLayers::Rule::kNone:
      return "none";
    case KeepLayers::Rule::kMiddle:
      return "middle";
    case KeepLayers::Rule::kAll:
      return "all";
    case KeepLayers::Rule::kListed:
      break;
  }
  return keep.listed;
}

}  // namespace

void check_contenders(const ExperimentConfig& config, const Registry& registry) {
  for (const ConfiguredContender& contender : config.contenders) {
    if (contender.spec.shell) check_slot(contender, "shell", *contender.spec.shell, registry);
    if (contender.spec.fill) check_slot(contender, "fill", *contender.spec.fill, registry);
    try {
      static_cast<void>(Contender(contender.spec, registry));
    } catch (const Error& error) {
      throw Error(ErrorKind::kBadInput, contender.place + ": " + error.what());
    }
  }
}

std::string resolved_json(const ExperimentConfig& config, const Registry& registry) {
  json object;
  object["name"] = config.name;
  object["seeds"] = config.seeds;
  object["plugins"] = config.plugins;
  object["models"] = json::array();
  for (const ConfiguredModel& model : config.models) object["models"].push_back(model.spec);
  object["settings"] = json::array();
  for (const Setting& setting : config.settings)
    object["settings"].push_back({{"label", setting.label},
                                  {"task", json_of(task_values(setting.task))},
                                  {"printer", json_of(printer_values(setting.printer))}});
  object["run"] = {{"repetitions", config.run.repetitions},
                   {"timeout_s", config.run.timeout_s},
                   {"memory_mb", config.run.memory_mb},
                   {"jobs", config.run.jobs},
                   {"keep_layers", json_of(config.run.keep_layers)}};
  object["contenders"] = json::array();
  for (const ConfiguredContender& contender : config.contenders) {
    json entry = variant_of(contender.spec, registry);
    entry["name"] = contender.spec.name;
    entry["base_name"] = contender.base_name;
    object["contenders"].push_back(std::move(entry));
  }
  return object.dump(2);
}

}  // namespace routebench
