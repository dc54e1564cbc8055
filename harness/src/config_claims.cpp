#include "config_claims.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "routebench/harness/metrics.hpp"

namespace routebench {
namespace {

constexpr std::array<std::string_view, 5> kSizes{"triangles", "layers", "outline_vertices",
                                                 "side_mm", "extrude_mm"};

void each_table(const ConfigTable& top, const std::string& key, const std::string& file,
                const std::function<void(const ConfigTable&)>& read) {
  const auto list = top.find(key);
  if (!list) return;
  const std::string title = "[[" + key + "]]";
  if (!list->node->is_array_of_tables())
    list->refuse_value("one or more tables, each headed " + title);
  for (const toml::node& node : *list->node->as_array())
    read(ConfigTable(file, title, *node.as_table()));
}

/// A text that is among the known ones.
std::string one_of(const ConfigEntry& entry, const std::vector<std::string>& known) {
  const std::string word = entry.text();
  if (std::find(known.begin(), known.end(), word) == known.end())
    entry.refuse("there is no `" + word + "`" + suggestion(word, known));
  return word;
}

std::string text_or_none(const ConfigTable& table, std::string_view key) {
  const auto found = table.find(key);
  return found ? found->text() : std::string();
}

}  // namespace

std::span<const std::string_view> claim_sizes() { return kSizes; }

void read_claims(const ConfigTable& top, const std::string& file, ExperimentConfig& config) {
  std::vector<std::string> contenders, models, metrics;
  for (const ConfiguredContender& contender : config.contenders)
    contenders.push_back(contender.base_name);
  for (const ConfiguredModel& model : config.models) models.push_back(model.spec);
  for (const MetricInfo& metric : metric_table()) metrics.emplace_back(metric.name);

  each_table(top, "claim", file, [&](const ConfigTable& table) {
    table.require_known({"contender", "size", "exponent", "source"});
    Claim claim;
    claim.contender = one_of(table.at("contender"), contenders);
    claim.size = one_of(table.at("size"), {kSizes.begin(), kSizes.end()});
    claim.exponent = table.at("exponent").number(0, 10);
    claim.source = text_or_none(table, "source");
    config.claims.push_back(std::move(claim));
  });
  each_table(top, "published", file, [&](const ConfigTable& table) {
    table.require_known({"model", "program", "metric", "value", "note", "source"});
    PublishedFigure figure;
    figure.model = one_of(table.at("model"), models);
    figure.program = table.at("program").text();
    figure.metric = one_of(table.at("metric"), metrics);
    figure.value = table.at("value").number(0, 1e18);
    figure.note = text_or_none(table, "note");
    figure.source = table.at("source").text();
    config.published.push_back(std::move(figure));
  });
}

}  // namespace routebench
