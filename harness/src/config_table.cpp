#include "config_table.hpp"

#include <algorithm>
#include <sstream>
#include <tuple>

#include "routebench/geometry/error.hpp"

namespace routebench {
namespace {

std::string place_of(const std::string& file, const toml::source_region& region) {
  return file + ":" + std::to_string(region.begin.line);
}

std::string range_text(const std::string& kind, const ParamValue& lowest,
                       const ParamValue& highest) {
  return kind + " from " + to_string(lowest) + " to " + to_string(highest);
}

}  // namespace

std::string shown(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return '"' + node.as_string()->get() + '"';
    case toml::node_type::integer:
      return to_string(ParamValue(node.as_integer()->get()));
    case toml::node_type::floating_point:
      return to_string(ParamValue(node.as_floating_point()->get()));
    case toml::node_type::boolean:
      return to_string(ParamValue(node.as_boolean()->get()));
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  if (const std::optional<std::string> near = nearest_name(word, known))
    return "; did you mean `" + *near + "`?";
  std::string words;
  for (const std::string& name : known) words += (words.empty() ? "" : ", ") + name;
  return "; known are " + words;
}

void ConfigEntry::refuse(const std::string& complaint) const {
  throw Error(ErrorKind::kBadInput, place + ": key `" + key + "`: " + complaint);
}

void ConfigEntry::refuse_value(const std::string& wanted) const {
  refuse("must be " + wanted + ", not " + shown(*node));
}

std::string ConfigEntry::text() const {
  const toml::value<std::string>* value = node->as_string();
  if (value == nullptr) refuse_value("a text in quotes");
  return value->get();
}

std::int64_t ConfigEntry::whole_number(std::int64_t lowest, std::int64_t highest) const {
  const toml::value<std::int64_t>* value = node->as_integer();
  if (value == nullptr || value->get() < lowest || value->get() > highest)
    refuse_value(range_text("a whole number", lowest, highest));
  return value->get();
}

double ConfigEntry::number(double lowest, double highest) const {
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !(*value >= lowest && *value <= highest))
    refuse_value(range_text("a number", lowest, highest));
  return *value;
}

const toml::array& ConfigEntry::list(const std::string& of_what) const {
  const toml::array* array = node->as_array();
  if (array == nullptr) refuse_value("a list of " + of_what);
  return *array;
}

const toml::table& ConfigEntry::table(const std::string& example) const {
  const toml::table* found = node->as_table();
  if (found == nullptr) refuse_value("a table such as " + example);
  return *found;
}

ParamValue ConfigEntry::value() const {
  switch (node->type()) {
    case toml::node_type::boolean:
      return node->as_boolean()->get();
    case toml::node_type::integer:
      return node->as_integer()->get();
    case toml::node_type::floating_point:
      return node->as_floating_point()->get();
    case toml::node_type::string:
      return node->as_string()->get();
    default:
      refuse_value("a number, a text or a truth value");
  }
}

std::vector<ConfigEntry> ConfigEntry::elements(const std::string& of_what) const {
  std::vector<ConfigEntry> result;
  const std::string file = place.substr(0, place.rfind(':'));
  for (const toml::node& element : list(of_what)) {
    const toml::source_region& region = element.source();
    result.push_back(
        {key, &element, place_of(file, region), region.begin.line, region.begin.column});
  }
  return result;
}

ConfigTable::ConfigTable(std::string file, std::string title, const toml::table& table)
    : file_(std::move(file)),
      title_(std::move(title)),
      place_(place_of(file_, table.source())),
      table_(&table) {}

ConfigEntry ConfigTable::entry(const toml::key& key, const toml::node& node) const {
  const toml::source_region& region = key.source();
  return {std::string(key.str()), &node, place_of(file_, region), region.begin.line,
          region.begin.column};
}

std::vector<ConfigEntry> ConfigTable::entries() const {
  std::vector<ConfigEntry> result;
  for (const auto& [key, node] : *table_) result.push_back(entry(key, node));
  std::sort(result.begin(), result.end(), [](const ConfigEntry& a, const ConfigEntry& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
  return result;
}

void ConfigTable::require_known(const std::vector<std::string>& known) const {
  for (const ConfigEntry& found : entries())
    if (std::find(known.begin(), known.end(), found.key) == known.end())
      found.refuse("unknown key of " + title_ + suggestion(found.key, known));
}

std::optional<ConfigEntry> ConfigTable::find(std::string_view key) const {
  const auto found = table_->find(key);
  if (found == table_->end()) return std::nullopt;
  return entry(found->first, found->second);
}

ConfigEntry ConfigTable::at(std::string_view key) const {
  if (std::optional<ConfigEntry> found = find(key)) return *std::move(found);
  throw Error(ErrorKind::kBadInput,
              place_ + ": key `" + std::string(key) + "`: missing from " + title_);
}

}  // namespace routebench
