/// Configs against the planners that are there: checks, and what is recorded of them.

#include "json_parts.hpp"
#include "routebench/geometry/error.hpp"
#include "routebench/harness/config.hpp"

namespace routebench {
namespace {

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
  for (const auto& param : slot.params)
    checked(param.first, [&] { static_cast<void>(entry.resolve({param})); });
}

Json keep_json(const KeepLayers& keep) {
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
    if (contender.spec.slicer || contender.spec.slicing) continue;  // checked when it was read
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
  Json settings = Json::array();
  for (const Setting& setting : config.settings)
    settings.push_back({{"label", setting.label},
                        {"task", json_of(setting.task)},
                        {"printer", json_of(setting.printer)}});
  Json models = Json::array(), optional_models = Json::array();
  for (const ConfiguredModel& model : config.models)
    (model.optional ? optional_models : models).push_back(model.spec);
  Json contenders = Json::array();
  for (const ConfiguredContender& contender : config.contenders) {
    Json entry =
        contender.spec.slicing
            ? Json{{"name", contender.spec.name}, {"slicing", to_string(*contender.spec.slicing)}}
        : contender.spec.slicer
            ? Json{{"name", contender.spec.name}, {"slicer", json_of(*contender.spec.slicer)}}
            : json_of(Contender(contender.spec, registry));
    entry["base_name"] = contender.base_name;
    contenders.push_back(std::move(entry));
  }
  Json claims = Json::array(), published = Json::array();
  for (const Claim& claim : config.claims)
    claims.push_back({{"contender", claim.contender},
                      {"size", claim.size},
                      {"exponent", claim.exponent},
                      {"source", claim.source}});
  for (const PublishedFigure& figure : config.published)
    published.push_back({{"model", figure.model},
                         {"program", figure.program},
                         {"metric", figure.metric},
                         {"value", figure.value},
                         {"note", figure.note},
                         {"source", figure.source}});
  return text_of({{"name", config.name},
                  {"seeds", config.seeds},
                  {"models", std::move(models)},
                  {"optional_models", std::move(optional_models)},
                  {"plugins", config.plugins},
                  {"settings", std::move(settings)},
                  {"run",
                   {{"repetitions", config.run.repetitions},
                    {"timeout_s", config.run.timeout_s},
                    {"memory_mb", config.run.memory_mb},
                    {"jobs", config.run.jobs},
                    {"keep_layers", keep_json(config.run.keep_layers)}}},
                  {"contenders", std::move(contenders)},
                  {"claims", std::move(claims)},
                  {"published", std::move(published)}});
}

}  // namespace routebench
